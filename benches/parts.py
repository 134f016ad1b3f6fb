"""Pictures in parts against those of one process: the work of parts.sh.

python3 parts.py RTC SCENES
"""

import os
import pathlib
import random
import resource
import subprocess
import sys
import tempfile

COUNTS = 1, 2, 7, 64
# What is rendered: the words of the command, and whether paths are traced.
SCENES = [
    (["bokeh.yaml", "--size", "150x100"], False),
    (["camera.yaml", "--size", "150x150"], False),
    (["glass.yaml", "--size", "160x120"], False),
    (["globe.yaml", "--size", "150x150"], False),
    (["glossy.yaml", "--size", "160x120"], False),
    (["mirror-box.yaml", "--size", "150x100"], False),
    (["soft-light.yaml", "--size", "160x100"], False),
    (["zbuffer.yaml", "--size", "200x200"], False),
    (["vases.yaml", "--size", "96x72", "--spp", "64"], True),
    (["vase.glb", "--size", "96x96", "--spp", "48"], True),
]


def run(*command):
    """Runs a command and gives its CPU-seconds."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    subprocess.run(command, check=True, capture_output=True)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def merged(rtc, folder, scene, count, by):
    """The bytes of a picture merged of parts in any order, and the CPU-seconds of them all."""
    render = [rtc, "render", *scene, "--quiet", "--picture", "a.exr"]
    order = [f"{part}/{count}" for part in range(1, count + 1)]
    random.Random(count).shuffle(order)
    files = [folder / f"{by}-{name.replace('/', '-')}.rtp" for name in order]
    parts = zip(order, files)
    seconds = sum(run(*render, "--parts-by", by, "--part", name, "-o", path) for name, path in parts)
    picture = folder / f"{by}-{count}.exr"
    seconds += run(rtc, "merge", *files, "--quiet", "-o", picture)
    return picture.read_bytes(), seconds


def main(rtc, scenes):
    print("| scene | by | CPU-seconds of one process |" + "".join(f" {count} |" for count in COUNTS))
    print("| --- | --- | ---: |" + " --- |" * len(COUNTS))
    faults = 0
    for (name, *words), is_path in SCENES:
        with tempfile.TemporaryDirectory() as folder:
            folder = pathlib.Path(folder)
            # Compiled once, as a farm does.
            scene = folder / "scene.rtir"
            subprocess.run([rtc, "compile", os.path.join(scenes, name), "--quiet", "-o", scene], check=True)
            whole = folder / "a.exr"
            seconds = run(rtc, "render", scene, *words, "--quiet", "-o", whole)
            for by in ["tiles", "samples"] if is_path else ["tiles"]:
                cells = []
                for count in COUNTS:
                    picture, spent = merged(rtc, folder, [str(scene), *words], count, by)
                    same = picture == whole.read_bytes()
                    faults += not same
                    cells.append(f" {'equal' if same else 'DIFFERENT'}, {spent:.2f} s |")
                print(f"| {name} | {by} | {seconds:.2f} |" + "".join(cells), flush=True)
    return faults > 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1], sys.argv[2]))
