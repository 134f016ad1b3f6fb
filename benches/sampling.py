"""Equal-time table of two programs `paths`: BEFORE AFTER ASSETS ENVIRONMENTS.

Each scene is compiled by RTC (environment variable) at SIDE x SIDE pixels. A reference of many
paths and another seed comes from AFTER, once. The error is relMSE: the mean of (x - r)^2 / (r^2 +
0.01) over pixels and channels. Time is CPU time of sampling alone, the median of turns by each in
turn; efficiency is 1 / (relMSE x time). `blurred` is the root of the same error after a Gaussian
filter of one pixel, AFTER over BEFORE: what is left where noise is spread evenly. The last column
is the mean of all pixels by AFTER over that by BEFORE, with its standard error over the turns.

STREETS are streets of so many lamps (street.py), measured beside the assets."""

import array
import json
import math
import os
import pathlib
import statistics
import subprocess
import sys

HERE = pathlib.Path(__file__).parent
SIDE = int(os.environ.get("SIDE", 96))
SAMPLES = int(os.environ.get("SAMPLES", 16))
REFERENCE = int(os.environ.get("REFERENCE", 2048))
TURNS = int(os.environ.get("TURNS", 5))
RTC = os.environ["RTC"]
STREETS = os.environ.get("STREETS", "64 1000").split()
WORK = pathlib.Path(os.environ.get("WORK", HERE.parent / "target" / "sampling"))


def scenes(assets, environments):
    """Name, file and options of each scene."""

    def at(name):
        return pathlib.Path(assets) / name

    sun = pathlib.Path(environments) / "royal_esplanade_256.hdr"
    rows = [
        ("FlightHelmet", at("FlightHelmet/FlightHelmet.gltf"), []),
        ("MetalRoughGrid", at("own_MetalRoughGrid.glb"), []),
        ("TransmissionRoughnessTest", at("TransmissionRoughnessTest.glb"), []),
        ("CornellLambert", at("own_CornellLambert.glb"), []),
        ("GlassSphere", at("own_GlassSphere.glb"), []),
        ("ClearCoatTest", at("ClearCoatTest.glb"), []),
        ("SheenCloth", at("SheenCloth.glb"), []),
        ("vases", HERE.parent / "scenes" / "vases.yaml", ["--integrator", "path"]),
        ("FlightHelmet, sky image", at("FlightHelmet/FlightHelmet.gltf"), ["--env", sun]),
        ("MetalRoughGrid, sky image", at("own_MetalRoughGrid.glb"), ["--env", sun]),
    ]
    for count in STREETS:
        street = WORK / f"street-{count}.gltf"
        subprocess.run([sys.executable, HERE / "street.py", count, street], check=True)
        rows.append((f"street of {count} lamps", street, []))
    wanted = os.environ.get("ONLY", "").split(";")
    return [row for row in rows if wanted == [""] or row[0] in wanted]


def compile_scene(name, file, options):
    """The scene as IR, at the size that is measured, and how many pixels it has across."""
    out = WORK / f"{name}-{SIDE}.rtir"
    made = [RTC, "compile", file, "-o", "-", "--emit", "ir", "--allow", "warnings", *options]
    scene = json.loads(subprocess.run(made, check=True, capture_output=True).stdout)
    camera = scene["camera"]
    scale = max(camera["size"]) / SIDE
    for axis in ("right", "up"):
        camera[axis] = [number * scale for number in camera[axis]]
    camera["size"] = [max(1, round(side / scale)) for side in camera["size"]]
    width = camera["size"][0]
    text = WORK / "scene.json"
    text.write_text(json.dumps(scene))
    subprocess.run([RTC, "compile", text, "-o", out, "--allow", "warnings"], check=True)
    return out, width


def trace(program, scene, samples, seed):
    """The pixels, and CPU-seconds."""
    out = WORK / "pixels"
    made = [program, scene, str(samples), str(seed), out]
    row = json.loads(subprocess.run(made, check=True, capture_output=True).stdout)
    pixels = array.array("f")
    pixels.frombytes(out.read_bytes())
    return pixels, row["render_cpu_s"]


def reference(program, scene):
    """A converged picture of a seed that no turn has."""
    kept = WORK / f"{scene.stem}-{REFERENCE}-{pathlib.Path(program).name}.f32"
    if not kept.exists():
        pixels, _ = trace(program, scene, REFERENCE, 1 << 20)
        kept.write_bytes(pixels.tobytes())
    pixels = array.array("f")
    pixels.frombytes(kept.read_bytes())
    return pixels


def error(pixels, truth):
    pairs = zip(pixels, truth, strict=True)
    return math.fsum((x - r) ** 2 / (r * r + 0.01) for x, r in pairs) / len(truth)


def filtered(plane, step):
    """Numbers filtered by a Gaussian of one pixel, cut off at three; neighbours are `step` apart,
    and the ends are left off."""
    weights = [(at * step, math.exp(-at * at / 2)) for at in range(-3, 4)]
    return [
        sum(weight * plane[k + by] for by, weight in weights)
        for k in range(3 * step, len(plane) - 3 * step)
    ]


def blurred(pixels, truth, width):
    """The relMSE of a picture of so many pixels across after a blur, but for a factor; its rows are
    filtered as one line."""
    plane = [(x - r) / math.sqrt(r * r + 0.01) for x, r in zip(pixels, truth, strict=True)]
    plane = filtered(filtered(plane, 3), 3 * width)
    return math.fsum(x * x for x in plane) / len(plane)


def measure(name, scene, width, programs):
    """Prints the row of a scene; the efficiency of AFTER over that of BEFORE."""
    truth = reference(programs[1], scene)
    found = [([], [], [], []) for _ in programs]
    for turn in range(TURNS):
        for program, (errors, times, means, blurs) in zip(programs, found):
            pixels, time = trace(program, scene, SAMPLES, 1 + turn)
            errors.append(error(pixels, truth))
            times.append(time)
            means.append(statistics.fmean(pixels))
            blurs.append(blurred(pixels, truth, width))
    (before, after) = [(statistics.mean(e), statistics.median(t)) for e, t, *_ in found]
    gain = before[0] * before[1] / (after[0] * after[1])
    ratios = [after / before for before, after in zip(found[0][2], found[1][2])]
    spread = statistics.stdev(ratios) / math.sqrt(TURNS) if TURNS > 1 else math.nan
    mean = f"{statistics.mean(ratios):.4f} ± {spread:.4f}"
    soft = math.sqrt(statistics.mean(found[1][3]) / statistics.mean(found[0][3]))
    row = [
        name,
        f"{before[0]:.5f}",
        f"{after[0]:.5f}",
        f"{after[1] / before[1]:.2f}",
        f"{gain:.2f}",
        f"{soft:.2f}",
        mean,
    ]
    print(f"| {' | '.join(row)} |", flush=True)
    return gain


def main():
    before, after, assets, environments = sys.argv[1:]
    WORK.mkdir(parents=True, exist_ok=True)
    print(
        "| scene | relMSE before | after | time, × before | efficiency, × before | blurred, × "
        "before | mean, × before |"
    )
    print("| --- | --: | --: | --: | --: | --: | --: |")
    gains = [
        measure(row[0], *compile_scene(*row), [before, after])
        for row in scenes(assets, environments)
    ]
    mean = math.exp(statistics.mean(map(math.log, gains)))
    print(
        f"\nEfficiency: geometric mean {mean:.2f}, arithmetic {statistics.mean(gains):.2f}, least "
        f"{min(gains):.2f}."
    )


main()
