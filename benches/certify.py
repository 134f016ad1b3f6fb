"""What `rtc certify` proves, beside an evaluation by MPFR with 200 bits: a table to standard
output. Called by certify.sh."""

import json
import multiprocessing
import os
import random
import subprocess
import sys
import tempfile
import time

import certify_oracle as oracle
from PIL import Image

RTC = os.environ["RTC"]
PIXELS = int(os.environ.get("PIXELS", "500"))
ROUNDS = int(os.environ.get("ROUNDS", "3"))


def timed(*args, accept=(0,)):
    """The least CPU time of a command on one thread, in seconds, and its output."""
    best, text = float("inf"), ""
    for _ in range(ROUNDS):
        before = os.times()
        run = subprocess.run([RTC, *args], capture_output=True, text=True)
        after = os.times()
        if run.returncode not in accept:
            raise SystemExit(f"{args}: {run.stderr}")
        spent = (
            after.children_user
            - before.children_user
            + after.children_system
            - before.children_system
        )
        best, text = min(best, spent), run.stdout
    return best, text


def values_of(scene, pixels):
    """The levels of pixels by the oracle."""
    if scene.mode == "zbuffer":
        yield from scene.depths(pixels)
    else:
        for pixel in pixels:
            yield pixel, scene.pixel(pixel)


def checked(path, folder):
    """The row of a scene."""
    name = os.path.splitext(os.path.basename(path))[0]
    picture, flags, ir = (
        os.path.join(folder, f"{name}{end}") for end in (".png", "-flags.png", ".rtir.json")
    )
    render, _ = timed("render", path, "-o", picture, "--threads", "1", "--quiet")
    certify, text = timed(
        "certify",
        path,
        "-o",
        picture,
        "--flags",
        flags,
        "--threads",
        "1",
        "--format",
        "json",
        accept=(0, 1),
    )
    report = json.loads(text)
    row = {
        "scene": name,
        "report": report,
        "ratio": certify / render,
        "render": render,
        "checked": 0,
        "wrong": [],
    }
    subprocess.run([RTC, "compile", path, "-o", ir, "--quiet"], check=True)
    # Proven pixels are dark in the map, others have a full channel.
    shown, flagged = (
        Image.open(picture).convert("RGB").load(),
        Image.open(flags).convert("RGB").load(),
    )
    width, height = Image.open(picture).size
    rounded = {tuple(one["pixel"]): one["certain"] for one in report["rounded"]}
    chosen = random.Random(name)
    pixels = [(chosen.randrange(width), chosen.randrange(height)) for _ in range(PIXELS)]
    pixels = [p for p in pixels if max(flagged[p]) < 255] + list(rounded)[:PIXELS]
    try:
        with open(ir) as file:
            scene = oracle.Scene(json.load(file))
        for pixel, value in values_of(scene, pixels):
            levels = tuple(oracle.level(x) for x in value)
            row["checked"] += 1
            # What is rendered otherwise, within rounding, is not shown as it is proven.
            proven = rounded.get(pixel, shown[pixel])
            if any(a is not None and a != b for a, b in zip(proven, levels)):
                row["wrong"].append((pixel, proven, levels))
    except oracle.Unsupported as what:
        row["unsupported"] = str(what)
    return row


def printed(rows):
    print(
        "| scene | pixels | proven | time ÷ render | checked | wrong | rounded | why others are "
        "flagged |"
    )
    print("| --- | ---: | ---: | ---: | ---: | ---: | ---: | --- |")
    for row in rows:
        report = row["report"]
        share = 100 * report["certain"] / report["pixels"]
        # Never round up to all.
        share = (
            "100 %"
            if report["certain"] == report["pixels"]
            else f"{int(share * 1000) / 1000:.3f} %"
        )
        why = "; ".join(f"{name}: {count}" for name, count in report["reasons"].items())
        checked = f"none: {row['unsupported']}" if "unsupported" in row else row["checked"]
        name, pixels, wrong = (
            row["scene"],
            report["pixels"],
            len(row["wrong"]) + len(report["differing"]),
        )
        print(
            f"| {name} | {pixels} | {share} | {row['ratio']:.1f} | {checked} | {wrong} | "
            f"{len(report['rounded'])} | {why} |"
        )
    total = sum(row["checked"] for row in rows)
    wrong = sum(len(row["wrong"]) + len(row["report"]["differing"]) for row in rows)
    print(
        f"| all | {sum(row['report']['pixels'] for row in rows)} | | | {total} | {wrong} | "
        f"{sum(len(row['report']['rounded']) for row in rows)} | |"
    )


def main(paths):
    start = time.time()
    with (
        tempfile.TemporaryDirectory() as folder,
        multiprocessing.Pool(int(os.environ.get("JOBS", "1"))) as pool,
    ):
        rows = pool.starmap(checked, [(path, folder) for path in paths], 1)
    printed(rows)
    for row in rows:
        for pixel, proven, value in row["wrong"]:
            print(f"{row['scene']} {pixel}: proven {proven}, by 200 bits {value}", file=sys.stderr)
    print(f"{time.time() - start:.0f} s", file=sys.stderr)
    return any(row["wrong"] or row["report"]["differing"] for row in rows)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
