"""What a camera ray of a picture asks of the machine, with all that follows it: instructions, and
lines missed in the caches that valgrind simulates. `ray_counts.py`, with a program in RTC, vector
instructions by RTC_SIMD, and the scenes and results of `peers/run.sh` in target/peers. The
difference of two pictures of 64 × 64 pixels, so that nothing counts but rays; it is the same on a
busy machine."""

import json
import os
import re
import subprocess
import tempfile
from statistics import median

SIDE, FEW, MANY = 64, 4, 20
GHZ, WIDTH = (
    3.7,
    4,
)  # The clock of the core, measured, and the instructions that it ends in a cycle.
L2 = "1048576,8,64"
FOLDER = "target/peers"
ASSETS = ["FlightHelmet", "MetalRoughGrid", "TransmissionRoughnessTest", "CornellLambert"]


def goals(results):
    """For each scene its goal, and the nanoseconds a sample that it leaves, by what `peers/run.sh`
    measured."""
    turns = results["courtyard"]["turns"]["Mitsuba scalar, independent"]
    samples = results["courtyard"]["pixels"] * results["courtyard"]["samples"]
    yield (
        "Courtyard",
        "Mitsuba scalar × 1.5",
        median(turn["cpu_s"] for turn in turns) / samples / 1.5,
    )
    for name in ASSETS:
        scene = results["assets"][name]
        seconds = median(turn["render_s"] for turn in scene["turns"]["Cycles"])
        yield name, "Cycles × 2", seconds / (scene["pixels"] * scene["samples"]) / 2


def counts(scene, samples):
    """Instructions, and lines missed in D1 and in L2, of one picture."""
    with tempfile.TemporaryDirectory() as folder:
        valgrind = [
            "valgrind",
            "--tool=cachegrind",
            "--cachegrind-out-file=/dev/null",
            f"--LL={L2}",
        ]
        picture = [
            os.environ["RTC"],
            "render",
            scene,
            "--size",
            f"{SIDE}x{SIDE}",
            "--spp",
            str(samples),
            "--asset-root",
            "../shared",
        ]
        command = [*valgrind, *picture, "--threads", "1", "-q", "-o", f"{folder}/picture.png"]
        said = subprocess.run(command, capture_output=True, text=True, check=True).stderr
    names = ("I   refs", "D1  misses", "LLd misses")
    return [int(re.search(f"{name}: *([0-9,]+)", said)[1].replace(",", "")) for name in names]


def main():
    simd = os.environ.get("RTC_SIMD", "best")
    print(
        f"A camera ray and all rays that follow it, `RTC_SIMD={simd}`. The time of the instructions"
    )
    print(f"is that of {WIDTH} per cycle at {GHZ} GHz. The last column is the time that a goal of")
    print("peers.md allows.\n")
    print("| scene | instructions | misses of D1 | of L2 | ns, instructions | goal | ns, goal |")
    print("| --- | --: | --: | --: | --: | --- | --: |")
    results = json.load(open(f"{FOLDER}/results-{os.environ.get('RTC_SIMD', 'best')}.json"))
    for name, goal, seconds in goals(results):
        scene = f"{FOLDER}/{name}.yaml"
        few, many = counts(scene, FEW), counts(scene, MANY)
        each = [max(b - a, 0) / (SIDE * SIDE * (MANY - FEW)) for a, b in zip(few, many)]
        least = each[0] / WIDTH / GHZ
        print(
            f"| {name} | {each[0]:.0f} | {each[1]:.1f} | {each[2]:.1f} | {least:.0f} | {goal} | "
            f"{1e9 * seconds:.0f} |"
        )


if __name__ == "__main__":
    main()
