"""Pictures by rtc and by the renderers that it writes for: `twins.py FOLDER`, with the program in
RTC. Prints a row a scene; fails where the pictures are farther apart than they should be."""

import os
import subprocess
import sys

import mitsuba
import numpy as np
from PIL import Image

FOLDER, HERE = sys.argv[1], os.path.dirname(os.path.relpath(__file__))
SAMPLES = 256
ROOT = ["--asset-root", "."]  # The mesh is one of scenes/.
# How far pictures of paths may be apart beyond their noise (root of the relative mean square), and
# those of the course (mean of grey levels: both round to whole ones).
APART_PATHS, APART_COURSE = 0.01, 1.0


def rtc(*arguments):
    subprocess.run([os.environ["RTC"], *arguments, "-q"], check=True)


def paths(scene):
    """The product of the differences of two pictures from one of 16 times their samples has, in the
    mean, no noise but its own: what is left is how far they are apart."""
    name = os.path.basename(scene).removesuffix(".yaml")
    mitsuba.set_variant("scalar_rgb")
    rtc("compile", scene, *ROOT, "-o", f"{FOLDER}/{name}.xml")
    made = mitsuba.load_file(f"{FOLDER}/{name}.xml")
    theirs = [
        np.array(mitsuba.render(made, spp=SAMPLES, seed=seed), float)[:, :, :3] for seed in (1, 2)
    ]
    rtc("render", scene, *ROOT, "--spp", str(16 * SAMPLES), "-o", f"{FOLDER}/{name}.exr")
    ours = np.array(mitsuba.Bitmap(f"{FOLDER}/{name}.exr"), float)[:, :, :3]
    weight = 1 / (ours**2 + 0.01)
    noise = np.sqrt(((theirs[0] - ours) ** 2 * weight).mean())
    apart = np.sqrt(max(((theirs[0] - ours) * (theirs[1] - ours) * weight).mean(), 0))
    print(
        f"| {name} | Mitsuba | {noise:.4f} | {apart:.4f} | "
        f"{100 * (np.mean(theirs) / ours.mean() - 1):+.3f} % |"
    )
    return apart <= APART_PATHS


def course(scene):
    """The course's pictures have no noise: what is left is how each rounds, and where edges fall.
    """
    name = os.path.basename(scene).removesuffix(".yaml")
    pictures = [f"{FOLDER}/{name}.{by}.png" for by in ("rtc", "povray")]
    rtc("compile", scene, "-o", f"{FOLDER}/{name}.pov")
    with open(f"{FOLDER}/{name}.pov") as file:
        options = file.readline().split()[2:]
    command = [
        "povray",
        f"+I{FOLDER}/{name}.pov",
        f"+O{pictures[1]}",
        *options,
        "+WT1",
        "-D",
        "-V",
        "-GA",
    ]
    subprocess.run(command, check=True, stderr=subprocess.DEVNULL)
    rtc("render", scene, "-o", pictures[0])
    ours, theirs = (np.asarray(Image.open(path).convert("RGB"), float) for path in pictures)
    apart, mean = np.abs(ours - theirs).mean(), theirs.mean() / ours.mean()
    print(f"| {name} | POV-Ray | | {apart:.3f} grey levels | {100 * (mean - 1):+.3f} % |")
    return apart <= APART_COURSE


def main():
    print(
        "| scene | by | noise and difference | difference | mean |\n| --- | --- | --: | --: | --: |"
    )
    found = [paths(f"{HERE}/lambert.yaml")]
    found += [
        course(f"scenes/{name}.yaml")
        for name in ("camera", "mirror-box", "off-axis-eye", "one-light-shadows")
    ]
    if not all(found):
        sys.exit("pictures are farther apart than they should be")


if __name__ == "__main__":
    main()
