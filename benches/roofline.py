"""The tables of `roofline.sh`: `roofline.py FOLDER`, where it left what `memory` and `rays` said and the profiles of callgrind."""
import json
import pathlib
import re
import sys

LINE = 64
RAYS = 65536
WORKS = ("coherent closest", "coherent any", "incoherent closest", "incoherent any")
# What a core of today can finish in a cycle, counted in instructions.
WIDTH = 4


def profile(path):
    """Of all calls that ended with this dump: each kind of event and how often it came."""
    text = path.read_text()
    names = re.search(r"^events: (.*)", text, re.M)[1].split()
    counts = re.search(r"^(?:summary|totals): (.*)", text, re.M)[1].split()
    return {name: int(count) for name, count in zip(names, counts + ["0"] * len(names))}


def per_ray(folder):
    """Events a ray of each work; its batches were dumped one after the other."""
    dumps = sorted(folder.glob("profile.*"), key=lambda path: int(path.suffix[1:]))
    found = [profile(path) for path in dumps][: len(dumps) // len(WORKS) * len(WORKS)]
    each = len(found) // len(WORKS)
    sums = lambda part: {name: sum(dump[name] for dump in part) / RAYS for name in part[0]}
    return {work: sums(found[k * each : (k + 1) * each]) for k, work in enumerate(WORKS)}


def misses(events, level):
    return events[f"{level}mr"] + events[f"{level}mw"]


def main(folder):
    folder = pathlib.Path(folder)
    memory = [json.loads(line) for line in (folder / "memory").read_text().splitlines()]
    told = [json.loads(line) for line in (folder / "rays").read_text().splitlines()]
    seconds = {row["work"]: row["cpu_s"] / row["rays"] for row in told if "rays" in row}
    cycle = memory[0]["cycle_ns"]
    print(f"One core, {1 / cycle:.1f} GHz by a chain of multiplications; the triad's three streams count.\n")
    print("| bytes | triad, GB/s | latency of a load, ns |\n| --: | --: | --: |")
    for row in memory:
        print(f"| {row['bytes'] / 1024:.0f} KB | {row['triad_gb_per_s']:.0f} | {row['latency_ns']:.1f} |")
    print("\nA ray of the globe: instructions and lines missed in caches as simulated; bounds that follow: all instructions at")
    print(f"{WIDTH} a cycle; all lines that miss L2 and L3 as fast as the triad streams from the next level; the same lines one after")
    print("the other, each waited for. `of limit` is the greatest of the first two bounds over the time measured.\n")
    print("| work | ns a ray | instructions | misses of D1 | L2 | L3 | ns, instructions | ns, bandwidth | ns, latency | of limit |")
    print("| --- |" + " --: |" * 9)
    second, third = per_ray(folder / "0"), per_ray(folder / "1")
    near, far = memory[-2], memory[-1]
    for work in WORKS:
        first_level, l2, l3 = (misses(events, level) for events, level in ((second[work], "D1"), (second[work], "DL"), (third[work], "DL")))
        instructions = second[work]["Ir"] / WIDTH * cycle
        bandwidth = LINE * ((l2 - l3) / near["triad_gb_per_s"] + l3 / far["triad_gb_per_s"])
        latency = (l2 - l3) * near["latency_ns"] + l3 * far["latency_ns"]
        time = 1e9 * seconds[work]
        row = [f"{time:.0f}", f"{second[work]['Ir']:.0f}", f"{first_level:.1f}", f"{l2:.1f}", f"{l3:.1f}"]
        row += [f"{bound:.0f}" for bound in (instructions, bandwidth, latency)]
        print(f"| {work} | " + " | ".join(row) + f" | {100 * max(instructions, bandwidth) / time:.0f} % |")


if __name__ == "__main__":
    main(*sys.argv[1:])
