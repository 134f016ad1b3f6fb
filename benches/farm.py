"""Pictures in parts: what is moved and worked, on paper and by simulation, and what real runs say.

farm.py                        simulates: the tables of docs/book/src/reference/long-renders.md,
                               the same on every machine
farm.py RTC SCENE [WORD...]    measures: CPU of the start of a part, of 64 parts and of one process;
                               the words go to `rtc render`

A simulated part takes the sum of the costs of its tiles, which a hash has shared out. Tasks go in
their order to the worker that is free first; one that fails does so anywhere in its time, and is
queued again at the end."""

import heapq
import math
import os
import random
import resource
import subprocess
import sys
import tempfile

TILE = 256  # pixels
SUMS = 32  # bytes a pixel of a part
# Measured as told in docs/book/src/reference/long-renders.md, of a build with checks.
SPREAD = 1.4  # of the costs of the tiles: standard deviation over mean
MERGE = 0.93e-6  # CPU-seconds a pixel of merging and writing the picture
READ = 2e-3  # CPU-seconds a part of merging
# Assumed.
DISK = 200e6  # bytes a second that one merging process is given
FAILING = 0.01  # of the tasks


def simulated(seed, pixels, work, parts, workers, start, failing=FAILING):
    """Seconds until the last part is there, and CPU-seconds of all workers."""
    dice = random.Random(seed)
    shape = pixels / TILE / parts / (1 + SPREAD**2)
    free, queue, cpu = (
        [0.0] * workers,
        [(0.0, dice.gammavariate(shape, work / parts / shape)) for _ in range(parts)],
        0.0,
    )
    end = 0.0
    for ready, cost in queue:  # grows where tasks fail
        begin = max(heapq.heappop(free), ready)
        fails = dice.random() < failing
        spent = (start + cost) * (dice.random() if fails else 1)
        heapq.heappush(free, begin + spent)
        cpu, end = cpu + spent, max(end, begin + spent)
        if fails:
            queue.append((begin + spent, cost))
    return end, cpu


def merged(pixels, parts):
    """Seconds that one process takes to merge the parts: CPU, and bytes through a disk."""
    return pixels * MERGE + parts * READ + pixels * SUMS / DISK


def median(values):
    return sorted(values)[len(values) // 2]


def seconds(value):
    return f"{value:.1f}" if value < 99.95 else f"{value:.0f}"


def growth(pixels, scene, work):
    """Bytes and CPU over the number of parts."""
    print(
        "| parts | bytes down, if each task fetches the scene | bytes up | a part | start 0.06 s, "
        "of the CPU | start 10 s | merging |"
    )
    print("| --: | --: | --: | --: | --: | --: | --: |")
    for parts in (1, 64, 1024, 10_000, 65_536):
        up = pixels * SUMS
        shares = [f"{100 * parts * start / (work + parts * start):.2f} %" for start in (0.06, 10)]
        down, up, part = (f"{size / 1e9:.3g} GB" for size in (scene * parts, up, up / parts))
        print(
            f"| {parts} | {down} | {up} | {part} | {shares[0]} | {shares[1]} | "
            f"{seconds(merged(pixels, parts))} s |"
        )


def best(pixels, work, workers):
    """The best number of parts for each cost of a start."""
    counts = [
        workers // 10,
        workers // 4,
        workers // 2,
        workers,
        2 * workers,
        3 * workers,
        4 * workers,
        65_536,
    ]
    print("| start of a task | " + " | ".join(f"{count} parts" for count in counts) + " | best |")
    print("| --: |" + " --: |" * (len(counts) + 1))
    for start in (0.06, 1, 10, 60):
        times = [
            median([simulated(seed, pixels, work, count, workers, start)[0] for seed in range(3)])
            for count in counts
        ]
        fastest = counts[times.index(min(times))]
        print(
            f"| {start} s | "
            + " | ".join(f"{seconds(time)} s" for time in times)
            + f" | {fastest} |"
        )


def saturation(pixels, work):
    """From how many workers on merging takes longer than rendering."""
    print(
        "| workers | rendering, 3 parts a worker | merging by one process | merging in all |\n| "
        "--: | --: | --: | --: |"
    )
    for workers in (16, 128, 1024, 10_000):
        parts = min(3 * workers, 65_536)
        time, _ = simulated(1, pixels, work, parts, workers, 0.06)
        last = merged(pixels, parts)
        print(
            f"| {workers} | {seconds(time)} s | {seconds(last)} s | "
            f"{100 * last / (time + last):.0f} % |"
        )


def tables():
    pixels, scene, work = 8192 * 8192, 50e6, 1e6
    print(
        f"A picture of 8192 × 8192 pixels that takes {work:.0e} CPU-seconds, of a scene of "
        f"{scene / 1e6:.0f} MB.\n".replace(
            "e+0", "0^"
        )
    )
    growth(pixels, scene, work)
    print("\nRendering, 10⁴ workers, 1 % of the tasks failing:\n")
    best(pixels, work, 10_000)
    print("\nA picture of the same size that takes a hundredth:\n")
    best(pixels, work / 100, 10_000)
    print()
    saturation(pixels, work)


def cpu(*command):
    """CPU-seconds of a command."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    subprocess.run(command, check=True, stderr=subprocess.DEVNULL)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def measure(rtc, scene, *words):
    """Starts, parts, one process; by turns, so that a busy machine is busy for all."""
    with tempfile.TemporaryDirectory() as folder:
        name = lambda name: os.path.join(folder, name)
        compiled = name("scene.rtir")
        subprocess.run([rtc, "compile", scene, "-q", "-o", compiled], check=True)
        render = [rtc, "render", compiled, "-q", "--studio", "off", "--threads", "1", *words]
        part = lambda index, count, out: cpu(
            *render, "--part", f"{index}/{count}", "--picture", "a.exr", "-o", name(out)
        )
        # A share of so many has no tile, but of large pictures.
        empty = [part(index, 65_536, "empty.rtp") for index in range(1, 8)]
        start = median(empty)
        one, parts = [], []
        for index in range(1, 65):
            parts.append(part(index, 64, f"{index}.rtp"))
            if index % 32 == 0:
                one.append(cpu(*render, "-o", name("one.exr")))
        merge = cpu(
            rtc,
            "merge",
            "-q",
            *(name(f"{index}.rtp") for index in range(1, 65)),
            "-o",
            name("merged.exr"),
        )
        same = open(name("one.exr"), "rb").read() == open(name("merged.exr"), "rb").read()
        one = median(one)
        beyond = (sum(parts) - 64 * start) / (one - start) - 1
        mean = sum(parts) / 64 - start
        spread = math.sqrt(sum((it - start - mean) ** 2 for it in parts) / 64) / mean
        size = sum(os.path.getsize(name(f"{index}.rtp")) for index in range(1, 65))
        print(
            f"scene.rtir {os.path.getsize(compiled) / 1e6:.2f} MB, parts {size / 1e6:.2f} MB; "
            f"merged bytes {'equal' if same else 'DIFFER'}"
        )
        print(
            f"start of a part {1e3 * start:.0f} ms CPU ({1e3 * min(empty):.0f} to "
            f"{1e3 * max(empty):.0f})"
        )
        print(f"one process {one:.2f} CPU-s, 64 parts {sum(parts):.2f}, merging {merge:.2f}")
        print(
            f"beyond the starts {100 * beyond:+.1f} %, in all with merging "
            f"{100 * ((sum(parts) + merge) / one - 1):+.1f} %"
        )
        print(f"costs of parts: standard deviation {100 * spread:.0f} % of the mean")


if __name__ == "__main__":
    measure(*sys.argv[1:]) if sys.argv[1:] else tables()
