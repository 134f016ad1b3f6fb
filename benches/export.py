"""Pictures by rtc and by the renderers that it writes for: `export.py SCENE...`, with the program
in RTC. Prints a row a scene and target; fails where the means are more than 2 % apart without a
warning. Pictures stay in the folder KEEP, if it is set."""

import os
import re
import shutil
import subprocess
import sys
import tempfile

import mitsuba
import numpy as np

SIDE, SAMPLES = int(os.environ.get("SIDE", "64")), int(os.environ.get("SPP", "64"))
APART = 0.02


def rtc(*arguments):
    """What it says; raises its first error where it fails."""
    done = subprocess.run([os.environ["RTC"], *arguments], capture_output=True, text=True)
    if done.returncode:
        errors = [line for line in done.stderr.splitlines() if "error" in line]
        raise RuntimeError(errors[0] if errors else done.stderr)
    return done.stderr


def mean(path):
    return np.nan_to_num(np.array(mitsuba.Bitmap(path), float)[:, :, :3]).mean()


def small(width, height):
    """The size of the pictures that are compared."""
    scale = min(1, SIDE / max(width, height))
    return [max(1, round(side * scale)) for side in (width, height)]


def by_mitsuba(twin, out):
    """Makes the picture; returns its size."""
    with open(twin) as file:
        text = file.read()
    size = small(
        *(int(re.search(rf'"{side}" value="(\d+)"', text)[1]) for side in ("width", "height"))
    )
    for side, pixels in zip(("width", "height"), size):
        text = re.sub(rf'"{side}" value="\d+"', f'"{side}" value="{pixels}"', text)
    with open(twin, "w") as file:
        file.write(text)
    mitsuba.Bitmap(mitsuba.render(mitsuba.load_file(twin), spp=SAMPLES, seed=1)).write(out)
    return size


def by_povray(twin, out):
    """The same by POV-Ray, with the options that the file names."""
    with open(twin) as file:
        width, height, *options = file.readline().split()[2:]
    size = small(int(width[2:]), int(height[2:]))
    options = [option for option in options if not option.startswith(("+FN", "File"))]
    command = [
        "povray",
        f"+I{os.path.basename(twin)}",
        f"+O{out}",
        "+FE",
        f"+W{size[0]}",
        f"+H{size[1]}",
        *options,
        "+WT2",
        "-D",
        "-GA",
    ]
    done = subprocess.run(
        command, capture_output=True, text=True, cwd=os.path.dirname(twin), timeout=300
    )
    if done.returncode:
        raise RuntimeError(" ".join(done.stderr.split())[-200:])
    return size


def row(scene, kind, render, folder):
    """Prints the row of a scene; returns whether it is as it should be."""
    name = os.path.splitext(os.path.basename(scene))[0]
    twin, theirs, plain, mine = (
        f"{folder}/{name}.{end}" for end in (kind, f"{kind}.exr", "rtir", f"{kind}.ours.exr")
    )
    try:
        said = rtc(
            "compile", scene, "-o", twin, "--message-format", "short", "--max-errors", "1000"
        )
        rtc("compile", scene, "-o", plain, "-q")
        width, height = render(twin, theirs)
        how = ["--spp", str(SAMPLES)] if kind == "xml" else []
        rtc(
            "render",
            plain,
            "--size",
            f"{width}x{height}",
            *how,
            "--background",
            "env",
            "-q",
            "-o",
            mine,
        )
    except (RuntimeError, subprocess.TimeoutExpired) as fault:
        print(f"| {name} | {kind} | | {fault} |", flush=True)
        return False
    told = [re.sub(r".*?EX001\]:? ", "", line) for line in said.splitlines() if "EX001" in line]
    away = mean(theirs) / max(mean(mine), 1e-9) - 1
    print(
        f"| {name} | {kind} | {100 * away:+.2f} % | {'; '.join(dict.fromkeys(told))} |", flush=True
    )
    if keep := os.environ.get("KEEP"):
        for path in (theirs, mine):
            mitsuba.util.write_bitmap(f"{keep}/{os.path.basename(path)}.png", mitsuba.Bitmap(path))
    return abs(away) <= APART or bool(told)


def main():
    mitsuba.set_variant("scalar_rgb")
    mitsuba.set_log_level(mitsuba.LogLevel.Error)
    targets = [("xml", by_mitsuba)]
    if shutil.which("povray"):
        targets.append(("pov", by_povray))
    wanted = os.environ.get("TARGETS", "xml pov").split()
    print("| scene | as | mean against ours | told |\n| --- | --- | --: | --- |")
    with tempfile.TemporaryDirectory() as folder:
        found = [
            row(scene, kind, render, folder)
            for scene in sys.argv[1:]
            for kind, render in targets
            if kind in wanted
        ]
    print(f"{sum(found)} of {len(found)} are within {APART:.0%}, or it is told why not")
    sys.exit(not all(found))


if __name__ == "__main__":
    main()
