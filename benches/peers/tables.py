"""Shows what `turns.py` measured, as Markdown: `tables.py RESULTS.json`. Each ratio is of the same
turn; shown are the median of all turns, the least and the greatest."""

import json
import os
import re
import statistics
import sys
import textwrap
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


def intro(heading, text):
    print(f"## {heading}\n\n{textwrap.fill(text, 100)}\n")


def rays(found):
    intro(
        "Rays through a mesh",
        "A mesh of 1 045 458 triangles, unsorted rays, one core. Embree gets the rays in batches "
        "of "
        "2^14, `rtc` one after another, as in its pictures. Million rays per CPU-second; the build "
        "in CPU-seconds. Two columns compare with Embree when all 2^20 rays are sorted before, "
        "which "
        "is not timed, and in its robust mode.",
    )
    rtc, embree = found["rtc"], found["Embree"]
    times = lambda turns, work: [turn[work]["cpu_s"] for turn in turns]
    head = [
        "work",
        "Embree",
        "rtc",
        "rtc ÷ Embree",
        "goal",
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
    intro(
        "Scenes of the course",
        "CPU-seconds of the whole process on one thread. *Apart* is the mean difference of the two "
        "pictures over all channels, in levels of 8 bits.",
    )
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
            "goal",
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
    triangles = found["turns"]["rtc"][0]["triangles"]
    intro(
        "A courtyard",
        f"Diffuse surfaces under sun and sky: {triangles} triangles, 256 × 256 pixels, "
        f"{found['samples']} samples, 32 bounces, one thread. CPU-seconds from the start of the "
        "process to the picture. The next section defines relMSE.",
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
        "goal",
        "relMSE, peer",
        "relMSE, rtc",
        "error × time, peer ÷ rtc",
    ]
    table([*head, "means apart", "MB, peer", "MB, rtc"], rows)


def assets(found):
    intro(
        "Path-traced assets",
        "256 × 256 pixels, 8 bounces, one thread. Million camera samples per second of the clock. "
        "Only the sampling is timed, as Cycles uses a second thread besides. relMSE is the mean of "
        "(a − b)²/(c² + 0.01): a is a picture, b the mean of the pictures of the other turns with "
        "other seeds, and c the mean of all pictures by both.",
    )
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
        "goal",
        "relMSE, Cycles",
        "relMSE, rtc",
        "error × time, Cycles ÷ rtc",
    ]
    table([*head, "means apart", "MB, Cycles", "MB, rtc"], rows)


def models(found):
    intro(
        "The first picture of a model",
        "CPU-seconds of the whole process for 400 × 400 pixels: f3d with software GL, and `rtc` on "
        "one thread with `--quality draft` and with the default.",
    )
    rows = []
    for name, turns in found.items():
        times = {by: column(turns[by], "cpu_s") for by in ("f3d", "draft", "rtc")}
        medians = [f"{statistics.median(seconds):.2f}" for seconds in times.values()]
        rows.append([name.split("/")[-1], *medians, ratios(times["f3d"], times["draft"])])
    table(["model", "f3d", "rtc, draft", "rtc", "f3d ÷ rtc, draft"], rows)


def growth(found):
    intro(
        "Globes with more triangles",
        "CPU-seconds of the build, and µs per ray with a random direction, for the closest hit and "
        "for any hit.",
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
    intro(
        "Two threads",
        "Seconds of the clock for a picture on one thread and on two. The goal is a gain of 1.95.",
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
    machine = model[1] if model else "an unknown machine"
    print(f"`benches/peers/run.sh` on {os.cpu_count()} cores, {machine}, {runs} turns.")
    print("Ratios are the median, with the least and the greatest in brackets; above 1 is better.")
    print(f"{', '.join(peers)}, POV-Ray 3.7.\n")
    print(f"Vector instructions of `rtc`: {level or 'the best'}. The peers choose theirs.\n")


def main(path):
    results = json.load(open(path))
    heading(results)
    for show in (rays, course, courtyard, assets, models, growth, cores):
        if show.__name__ in results:
            show(results[show.__name__])


if __name__ == "__main__":
    main(*sys.argv[1:])
