"""Shows what `turns.py` measured, as Markdown: `tables.py RESULTS.json`. Each ratio is of the same
turn; shown are the median of all turns, the least and the greatest."""

import json
import os
import re
import statistics
import sys
from importlib import metadata


def spread(numbers):
    return f"**{statistics.median(numbers):.2f}** ({min(numbers):.2f} … {max(numbers):.2f})"


def ratios(above, below):
    return spread([a / b for a, b in zip(above, below)])


def column(turns, key):
    return [turn[key] for turn in turns]


def table(head, rows):
    """The first column holds words, the others numbers."""
    lines = [head, ["---"] + ["--:"] * (len(head) - 1), *rows]
    print("\n".join("| " + " | ".join(map(str, line)) + " |" for line in lines), end="\n\n")


def rays(found):
    print(
        "Rays through a mesh of 1 045 458 triangles, unsorted, one core: Embree in batches of "
        "2^14, rtc one ray after another, as its"
    )
    print(
        "pictures do. M rays per CPU-s, of the build CPU-s. Beside: Embree given all 2^20 rays "
        "sorted, in time that does not count, and robust.\n"
    )
    rtc, embree = found["rtc"], found["Embree"]
    times = lambda turns, work: [turn[work]["cpu_s"] for turn in turns]
    head = [
        "work",
        "Embree",
        "rtc",
        "rtc ÷ Embree",
        "wanted",
        "÷ Embree, sorted",
        "÷ Embree, robust",
        "hits, rtc − Embree",
    ]
    rows = []
    for work, wanted in (
        ("coherent closest", "0.75"),
        ("incoherent closest", "0.75"),
        ("coherent any", "0.9"),
        ("incoherent any", "0.9"),
    ):
        ours, theirs = times(rtc, work), times(embree, work)
        count = rtc[0][work]["rays"]
        rate = lambda seconds: f"{count / statistics.median(seconds) / 1e6:.2f}"
        others = [ratios(times(embree, f"{work} {mode}"), ours) for mode in ("sorted", "robust")]
        differ = rtc[0][work]["hits"] - embree[0][work]["hits"]
        rows.append(
            [work + " hit", rate(theirs), rate(ours), ratios(theirs, ours), wanted, *others, differ]
        )
    ours, theirs = times(rtc, "build"), times(embree, "build")
    robust = ratios(times(embree, "build robust"), ours)
    medians = [f"{statistics.median(seconds):.2f}" for seconds in (theirs, ours)]
    rows.append(["build", *medians, ratios(theirs, ours), "1.33", "", robust, ""])
    table(head, rows)


def course(found):
    print(
        "Scenes of the course's kind, one thread, CPU-s of the whole process; the last column is "
        "how far the two pictures are apart, a"
    )
    print("mean over all channels in levels of 8 bits.\n")
    rows = []
    for name, scene in found.items():
        times = {by: column(scene[by], "cpu_s") for by in ("POV-Ray", "rtc")}
        medians = [f"{statistics.median(seconds):.2f}" for seconds in times.values()]
        gain = ratios(*times.values())
        rows.append(
            [
                name,
                scene["size"],
                scene["samples"],
                len(scene["rtc"]),
                *medians,
                gain,
                "8",
                f"{scene['apart']:.2f}",
            ]
        )
    table(
        [
            "scene",
            "pixels",
            "samples",
            "turns",
            "POV-Ray",
            "rtc",
            "POV-Ray ÷ rtc",
            "wanted",
            "apart",
        ],
        rows,
    )


def noises(scene, peer, key):
    """The columns of noise: of both, the gain in error times time, the means."""
    turns, noise = scene["turns"], scene["noise"]
    costs = {
        by: [
            error * seconds for error, seconds in zip(noise[by]["rel_mse"], column(turns[by], key))
        ]
        for by in (peer, "rtc")
    }
    apart = noise["rtc"]["mean"] / noise[peer]["mean"] - 1
    if len(turns["rtc"]) == 1:
        return ["–", "–", "–", f"{100 * apart:+.2f} %"]
    errors = [f"{statistics.median(noise[by]['rel_mse']):.5f}" for by in (peer, "rtc")]
    return [*errors, ratios(costs[peer], costs["rtc"]), f"{100 * apart:+.2f} %"]


def courtyard(found):
    print(
        f"A courtyard of Lambert's surfaces under sun and sky, "
        f"{found['turns']['rtc'][0]['triangles']} triangles, 256 × 256 pixels,"
    )
    print(
        f"{found['samples']} samples, 32 bounces, one thread: CPU-s from the start of the process "
        f"to the picture; error as below.\n"
    )
    rows = []
    for peer in [name for name in found["turns"] if name != "rtc"]:
        times = [column(found["turns"][by], "cpu_s") for by in (peer, "rtc")]
        medians = [f"{statistics.median(seconds):.2f}" for seconds in times]
        peaks = [f"{max(column(found['turns'][by], 'peak_mb')):.0f}" for by in (peer, "rtc")]
        wanted = "1.0" if "llvm" in peer else "1.5"
        rows.append([peer, *medians, ratios(*times), wanted, *noises(found, peer, "cpu_s"), *peaks])
    head = [
        "peer, sampler",
        "peer",
        "rtc",
        "peer ÷ rtc",
        "wanted",
        "relMSE, peer",
        "relMSE, rtc",
        "error × time, peer ÷ rtc",
    ]
    table([*head, "means apart", "MB, peer", "MB, rtc"], rows)


def assets(found):
    print(
        "Traced paths, 256 × 256 pixels, 8 bounces, one thread: M camera samples per second of the "
        "clock, of sampling alone, since Cycles"
    )
    print(
        "uses a second thread beside. The error of a picture is the mean of (a − b)²/(c² + 0.01): "
        "a is a picture, b the mean of those of"
    )
    print("the other turns by other seeds, c the mean of all by both.\n")
    rows = []
    for name, scene in found.items():
        turns = scene["turns"]
        rates = {
            by: [
                scene["samples"] * scene["pixels"] / seconds / 1e6
                for seconds in column(turns[by], "render_s")
            ]
            for by in turns
        }
        medians = [f"{statistics.median(rates[by]):.2f}" for by in ("Cycles", "rtc")]
        peaks = [f"{max(column(turns[by], 'peak_mb')):.0f}" for by in ("Cycles", "rtc")]
        gain = ratios(rates["rtc"], rates["Cycles"])
        rows.append(
            [
                name,
                scene["samples"],
                *medians,
                gain,
                "2.0",
                *noises(scene, "Cycles", "render_s"),
                *peaks,
            ]
        )
    head = [
        "scene",
        "samples",
        "Cycles",
        "rtc",
        "rtc ÷ Cycles",
        "wanted",
        "relMSE, Cycles",
        "relMSE, rtc",
        "error × time, Cycles ÷ rtc",
    ]
    table([*head, "means apart", "MB, Cycles", "MB, rtc"], rows)


def models(found):
    print(
        "From a model to its first picture of 400 × 400 pixels, CPU-s of the whole process: f3d by "
        "software GL, rtc on one thread by"
    )
    print("`--quality draft` and by default.\n")
    rows = []
    for name, turns in found.items():
        times = {by: column(turns[by], "cpu_s") for by in ("f3d", "draft", "rtc")}
        medians = [f"{statistics.median(seconds):.2f}" for seconds in times.values()]
        rows.append([name.split("/")[-1], *medians, ratios(times["f3d"], times["draft"])])
    table(["model", "f3d", "rtc, draft", "rtc", "f3d ÷ rtc, draft"], rows)


def growth(found):
    print(
        "Globes of more and more triangles: CPU-s of the build, and µs a ray to anywhere, of its "
        "nearest hit and of any.\n"
    )
    rows = []
    for exponent, turns in found.items():
        cells = []
        for work in ("build", "incoherent closest", "incoherent any"):
            rays = 1 if work == "build" else 1e-6 * turns["rays"]
            times = [column(turns[by], work) for by in ("Embree", "rtc")]
            cells += [f"{statistics.median(seconds) / rays:.3g}" for seconds in times] + [
                ratios(*times)
            ]
        rows.append([f"{turns['triangles']:,}".replace(",", " "), *cells])
    kinds = ("build", "closest", "any")
    table(
        [
            "triangles",
            *(f"{kind}{by}" for kind in kinds for by in (", Embree", ", rtc", ", ratio")),
        ],
        rows,
    )


def cores(found):
    print(
        "Seconds of the clock for a picture on one thread and on two; wanted is a gain of 1.95.\n"
    )
    rows = []
    for name, turns in found.items():
        times = [column(turns[threads], "wall_s") for threads in ("1", "2")]
        rows.append(
            [name, *(f"{statistics.median(seconds):.2f}" for seconds in times), ratios(*times)]
        )
    table(["picture", "one thread", "two", "gain"], rows)


def heading(results):
    model = re.search(r"model name\s*: (.*)", open("/proc/cpuinfo").read())
    level = results["rays"]["rtc"][0]["build"].get("simd", "") if "rays" in results else ""
    peers = [
        f"{name} {metadata.version(package)}"
        for name, package in (("Mitsuba", "mitsuba"), ("bpy", "bpy"), ("embreex", "embreex"))
    ]
    runs = len(results["rays"]["rtc"]) if "rays" in results else "some"
    print(
        f"`benches/peers/run.sh` on {os.cpu_count()} cores, "
        f"{model[1] if model else 'of a machine'}; {runs} turns: the median, the least and"
    )
    print(f"the greatest ratio; more than 1 is better. {', '.join(peers)}, POV-Ray 3.7.\n")
    print(
        f"The vector instructions of rtc: {level or 'the best of the machine'}; the peers choose "
        f"theirs.\n"
    )


def main(path):
    results = json.load(open(path))
    heading(results)
    for show in (rays, course, courtyard, assets, models, growth, cores):
        if show.__name__ in results:
            show(results[show.__name__])


if __name__ == "__main__":
    main(*sys.argv[1:])
