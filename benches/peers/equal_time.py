"""Error after equal CPU time, by rtc and its peers: `equal_time.py FOLDER TURNS`, with the programs
in RTC and PATHS, and the CPU-seconds of a picture in SECONDS. Writes the tables. A peer that is not
there is left out, and so is a scene that only rtc would render.

Two pictures of few samples tell what a sample costs and what is spent beside samples; then each
renderer takes as many samples as the seconds buy. The truth of each is its own picture of 16 times
as many samples by another seed, whose noise is taken off."""

import json
import math
import os
import shutil
import statistics
import subprocess
import sys

import numpy as np
from PIL import Image
from turns import FOLDER, HERE, RUNS, by_turns, emit, run

SECONDS = float(os.environ.get("SECONDS_EACH", "1"))
TRUTH = 16  # The samples of a truth, of those of a picture.
TRUTH_SEED = 1000
# Small emitters, and a caustic.
LAMPS = ["small-lamp", "many-lamps", "glass-ball"]


def has(module):
    return (
        subprocess.run([sys.executable, "-c", f"import {module}"], capture_output=True).returncode
        == 0
    )


def source(scene):
    """The file of a scene: beside this one, or made by scenes.py."""
    own = f"{HERE}/{scene}.yaml"
    return own if os.path.exists(own) else f"{FOLDER}/{scene}.json"


def by_rtc(scene, samples, seed, out):
    told = run(os.environ["PATHS"], source(scene), str(samples), str(seed), out)["told"]
    return json.loads(told)["render_cpu_s"]


def by_mitsuba(scene, samples, seed, out):
    told = run(
        sys.executable,
        f"{HERE}/paths_mitsuba.py",
        f"{FOLDER}/{scene}.xml",
        str(samples),
        str(seed),
        out,
        "multijitter",
    )["told"]
    return json.loads(told)["render_cpu_s"]


def by_cycles(scene, samples, seed, out):
    command = [sys.executable, f"{HERE}/paths_cycles.py", f"{FOLDER}/{scene}.json", str(samples)]
    ran = subprocess.run(
        command,
        input=f"{seed} {out}\n",
        stdout=subprocess.PIPE,
        stderr=subprocess.DEVNULL,
        text=True,
        check=True,
    )
    return json.loads(ran.stdout.splitlines()[-1])["whole_cpu_s"]


def whole_root(samples):
    """The nearest square number: Mitsuba's multijitter takes no other."""
    return max(1, round(math.sqrt(samples))) ** 2


def relative(picture, truth):
    """The relative mean square error of a picture, the noise of the truth taken off."""
    a, b = (np.fromfile(path, np.float32).astype(float) for path in (picture, truth))
    return float(((a - b) ** 2 / (b**2 + 0.01)).mean()) / (1 + 1 / TRUTH)


def paths(scene, renderers):
    """Rows of a scene of traced paths."""
    plans = {}
    for name, render in renderers.items():
        out = f"{FOLDER}/equal.{name}.truth.f32"
        few, many = render(scene, 4, 1, out), render(scene, 16, 1, out)
        cost = max((many - few) / 12, 1e-9)
        samples = whole_root(SECONDS / cost)
        render(scene, TRUTH * samples, TRUTH_SEED, out)
        plans[name] = (samples, max(few - 4 * cost, 0))

    def turn_of(name):
        samples, beside = plans[name]

        def one(turn):
            out = f"{FOLDER}/equal.{name}.f32"
            seconds = renderers[name](scene, samples, turn + 1, out) - beside
            return seconds, relative(out, f"{FOLDER}/equal.{name}.truth.f32") * seconds / SECONDS

        return one

    turns = by_turns({name: turn_of(name) for name in renderers})
    return [row(scene, name, plans[name][0], turns[name]) for name in renderers]


def row(scene, name, samples, turns):
    seconds, errors = zip(*turns)
    return [
        scene,
        name,
        samples,
        statistics.median(seconds),
        statistics.median(errors),
        min(errors),
        max(errors),
    ]


def course(path):
    """Rows of a scene of the course: n × n samples in a grid, so that each renderer has one picture
    for a time."""
    scene, pov = os.path.basename(path).removesuffix(".yaml"), f"{FOLDER}/equal.pov"
    emit(path, pov)

    def rtc(side, out):
        return run(
            os.environ["RTC"],
            "render",
            path,
            "--supersampling",
            str(side),
            "--threads",
            "1",
            "-q",
            "-o",
            out,
        )["cpu_s"]

    def povray(side, out):
        size = ["+W400", "+H400", "+FN", "File_Gamma=1.0", "+WT1", "-D", "-V", "-GA", "-J"]
        return run("povray", f"+I{pov}", f"+O{out}", *size, "+A0.0", "+AM1", f"+R{side}")["cpu_s"]

    renderers, plans = {"rtc": rtc, "POV-Ray": povray}, {}
    for name, render in renderers.items():
        out = f"{FOLDER}/equal.{name}.truth.png"
        few, many = render(2, out), render(4, out)
        cost = max((many - few) / 12, 1e-9)
        side = max(1, int(math.sqrt(SECONDS / cost)))
        render(4 * side, out)
        plans[name] = (side, max(few - 4 * cost, 0))

    def turn_of(name):
        side, beside = plans[name]

        def one(_):
            pair = [f"{FOLDER}/equal.{name}.png", f"{FOLDER}/equal.{name}.truth.png"]
            seconds = renderers[name](side, pair[0]) - beside
            a, b = (np.asarray(Image.open(path).convert("RGB"), float) for path in pair)
            return seconds, float(np.sqrt(((a - b) ** 2).mean()))

        return one

    turns = by_turns({name: turn_of(name) for name in renderers})
    return [row(scene, name, plans[name][0] ** 2, turns[name]) for name in renderers]


def table(rows, error, digits):
    """Rows in Markdown; the last column says how many times rtc's error a peer has."""
    ours = {scene: errors for scene, name, _, _, errors, *_ in rows if name == "rtc"}
    print(
        f"| scene | renderer | samples a pixel | CPU-s | {error} | ÷ that of rtc |\n| --- | --- | "
        f"--: | --: | --: | --: |"
    )
    for scene, name, samples, seconds, middle, least, most in rows:
        spread = f"{middle:.{digits}f} ({least:.{digits}f} … {most:.{digits}f})"
        print(
            f"| {scene} | {name} | {samples} | {seconds:.2f} | {spread} | "
            f"**{middle / ours[scene]:.2f}** |"
        )


def main():
    peers = {}
    if has("bpy"):
        peers["Cycles"] = by_cycles
    lambert = {**peers, "Mitsuba": by_mitsuba} if has("mitsuba") else peers
    emit(f"{FOLDER}/Courtyard.yaml", f"{FOLDER}/Courtyard.xml")
    rows = paths("Courtyard", {"rtc": by_rtc, **lambert}) if lambert else []
    if has("mitsuba"):
        for scene in LAMPS:
            emit(f"{HERE}/{scene}.yaml", f"{FOLDER}/{scene}.xml")
            rows += paths(scene, {"rtc": by_rtc, "Mitsuba": by_mitsuba})
    if peers and os.path.exists(f"{FOLDER}/CornellLambert.json"):
        rows += paths("CornellLambert", {"rtc": by_rtc, **peers})
    load = os.getloadavg()[0]
    busy = (
        f"\n\n**The machine was busy** ({load:.1f} processes at the end). Use the ratios, not the "
        f"seconds."
        if load > 1.5
        else ""
    )
    print(
        f"{SECONDS:g} CPU-seconds per picture, one thread, {RUNS} turns. Values are the median, "
        f"with "
        f"the least and the\ngreatest in brackets.{busy}\n"
    )
    if rows:
        table(rows, "relMSE", 5)
    if shutil.which("povray"):
        print(
            "\nThe camera scene of the course has grids of samples. Its error is the root mean "
            "square in grey\nlevels.\n"
        )
        table(course("scenes/camera.yaml"), "RMSE", 2)


if __name__ == "__main__":
    main()
