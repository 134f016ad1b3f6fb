"""Renders with checkpoints, killed at random moments and started again, against renders that nobody
killed: the work of kills.sh.

python3 kills.py RTC SCENES SEED"""

import hashlib
import pathlib
import random
import subprocess
import sys
import tempfile
import time

KILLS = 5
# What is rendered, by name: the words of the command, and the name of its pictures.
SCENES = {
    "course, glass": (["glass.yaml", "--size", "96x72", "--supersampling", "3"], "a.png"),
    "soft light": (["soft-light.yaml", "--size", "120x75", "--supersampling", "3"], "a.png"),
    "paths": (["vases.yaml", "--size", "64x48", "--spp", "64"], "a.png"),
    "layers": (
        ["vases.yaml", "--size", "64x48", "--spp", "64", "--aov", "albedo,normal,depth"],
        "a.exr",
    ),
    "target error": (["soft-light.yaml", "--size", "96x60", "--target-error", "0.5"], "a.png"),
    "turntable": (["glass.yaml", "--size", "64x48", "--turntable", "4"], "a-%d.png"),
}


def start(rtc, scenes, words, output, folder):
    scene = str(scenes / words[0])
    command = [rtc, "render", scene, *words[1:], "--quiet", "-o", output]
    return subprocess.Popen(command, cwd=folder)


def hashes(folder, suffix):
    """The SHA-256 of each picture in a folder."""
    pictures = sorted(pathlib.Path(folder).glob("a*" + suffix))
    return [
        (picture.name, hashlib.sha256(picture.read_bytes()).hexdigest()) for picture in pictures
    ]


def main(rtc, scenes, seed):
    rng = random.Random(seed)
    scenes = pathlib.Path(scenes).resolve()
    print("| scene | seconds undisturbed | kills | of these with a checkpoint | the same bytes |")
    print("| --- | ---: | ---: | ---: | ---: |")
    faults = 0
    for name, (words, output) in SCENES.items():
        suffix = pathlib.Path(output).suffix
        with tempfile.TemporaryDirectory() as folder:
            begun = time.monotonic()
            assert start(rtc, scenes, words, output, folder).wait() == 0
            seconds = time.monotonic() - begun
            whole = hashes(folder, suffix)
        kills = saved = same = tries = 0
        while kills < KILLS and tries < 10 * KILLS:
            tries += 1
            with tempfile.TemporaryDirectory() as folder:
                every = f"{seconds / 20:.3f}"
                saving = [*words, "--checkpoint", "a.rtp", "--every", every]
                process = start(rtc, scenes, saving, output, folder)
                time.sleep(seconds * rng.uniform(0.05, 1.1))
                process.kill()
                if process.wait() == 0:
                    # It was done before.
                    continue
                kills += 1
                saved += (pathlib.Path(folder) / "a.rtp").exists()
                ended = start(rtc, scenes, saving, output, folder).wait()
                same += ended == 0 and hashes(folder, suffix) == whole
        faults += KILLS - same
        print(f"| {name} | {seconds:.1f} | {kills} | {saved} | {same} |", flush=True)
    return faults > 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1], sys.argv[2], int(sys.argv[3])))
