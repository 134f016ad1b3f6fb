"""Measures rtc and its peers by turns: `turns.py FOLDER RUNS KIND…`, with the programs in RTC, RAYS
and PATHS, and the size of the picture of rings in RINGS. Each turn is one run of each, in the order
of the last turn turned round. The file RESULTS keeps what was measured, kind by kind; `tables.py`
shows it."""

import glob
import json
import os
import subprocess
import sys
import tempfile
import time

import numpy as np
from scenes import globe, write_glb

FOLDER, RUNS = sys.argv[1], int(sys.argv[2])
HERE = os.path.dirname(os.path.relpath(__file__))
ASSETS = ["FlightHelmet", "MetalRoughGrid", "TransmissionRoughnessTest", "CornellLambert"]
MODELS = [
    "own_MetalRoughGrid.glb",
    "FlightHelmet/FlightHelmet.gltf",
    "ClearCoatTest.glb",
    "SheenCloth.glb",
]
GROWTH_RAYS = 1 << 18
SAMPLES = {
    "Courtyard": 64,
    "FlightHelmet": 32,
    "MetalRoughGrid": 32,
    "TransmissionRoughnessTest": 32,
    "CornellLambert": 16,
}


def run(*command):
    """Seconds of the clock, CPU-seconds, peak of memory in MB and output of a program."""
    with tempfile.TemporaryFile("w+") as complaints:
        start = time.perf_counter()
        process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=complaints, text=True)
        told = process.stdout.read()
        _, status, usage = os.wait4(process.pid, 0)
        clock = time.perf_counter() - start
        if status != 0:
            complaints.seek(0)
            sys.exit(f"{' '.join(command)}: {complaints.read()}")
    cpu = usage.ru_utime + usage.ru_stime
    return {"wall_s": clock, "cpu_s": cpu, "peak_mb": usage.ru_maxrss / 1024, "told": told}


def rows(*command):
    """The rows of JSON that a program prints, by what they are of."""
    found = [json.loads(line) for line in run(*command)["told"].splitlines()]
    return {row.pop("work"): row for row in found}


def seconds(*command):
    return {work: row["cpu_s"] for work, row in rows(*command).items()}


def emit(scene, path):
    """The scene as a file of another renderer, by the ending of the path."""
    subprocess.run([os.environ["RTC"], "compile", scene, "-q", "-o", path], check=True)


def by_turns(contestants, runs=RUNS):
    """What each contestant returns for each turn, by name."""
    results = {name: [] for name in contestants}
    order = list(contestants)
    for turn in range(runs):
        for name in order:
            results[name].append(contestants[name](turn))
            print(f"  turn {turn + 1} of {runs}: {name}", file=sys.stderr)
        order.reverse()
    return results


def rays():
    sets = [f"{FOLDER}/{name}.f32" for name in ("coherent", "incoherent")]

    rtc = lambda _: rows(os.environ["RAYS"], f"{FOLDER}/globe.glb", *sets)
    embree = lambda _: rows(sys.executable, f"{HERE}/rays_embree.py", FOLDER, *sets)
    turns = by_turns({"rtc": rtc, "Embree": embree})
    for work, ours in turns["rtc"][0].items():
        theirs = turns["Embree"][0][work]
        # Embree is not watertight: a few rays in a million may slip through an edge.
        if work != "build" and abs(ours["hits"] - theirs["hits"]) > 1e-5 * ours["rays"]:
            sys.exit(f"{work}: {ours['hits']} hits by rtc, {theirs['hits']} by Embree")
    return turns


def course():
    """The camera scene of the course, and the rings; how far the pictures are apart, in levels of 8
    bits."""
    from PIL import Image

    found = {}
    for name, scene, side, factor, runs in (
        ("camera", "scenes/camera.yaml", "400x400", 4, RUNS),
        ("rings", f"{HERE}/rings.yaml", os.environ["RINGS"], 2, min(RUNS, 3)),
    ):
        width, height = side.split("x")
        pov = f"{FOLDER}/{name}.pov"
        emit(scene, pov)
        pictures = [f"{FOLDER}/{name}.{by}.png" for by in ("rtc", "povray")]
        rtc = [
            os.environ["RTC"],
            "render",
            scene,
            "--size",
            side,
            "--threads",
            "1",
            "-q",
            "-o",
            pictures[0],
        ]
        povray = [
            "povray",
            f"+I{pov}",
            f"+O{pictures[1]}",
            f"+W{width}",
            f"+H{height}",
            "+FN",
            "File_Gamma=1.0",
        ]
        povray += ["+A0.0", "+AM1", f"+R{factor}", "-J", "+WT1", "-D", "-V", "-GA"]
        turns = by_turns({"rtc": lambda _: run(*rtc), "POV-Ray": lambda _: run(*povray)}, runs)
        a, b = (np.asarray(Image.open(path).convert("RGB"), float) for path in pictures)
        found[name] = {
            "size": side,
            "samples": factor**2,
            "apart": float(np.abs(a - b).mean()),
            **turns,
        }
    return found


def noise(pictures):
    """The relative mean square error of each picture, against the mean of all others of its kind;
    and the means of the kinds."""
    kinds = {
        name: np.array([np.fromfile(path, np.float32) for path in paths], float)
        for name, paths in pictures.items()
    }
    truth = np.mean([stack.mean(0) for stack in kinds.values()], 0)
    error = lambda stack: (
        (stack - stack.mean(0)) ** 2 * (RUNS / max(RUNS - 1, 1)) / (truth**2 + 0.01)
    )
    return {
        name: {"rel_mse": error(stack).mean(1).tolist(), "mean": float(stack.mean())}
        for name, stack in kinds.items()
    }


def picture(set_up, name, turn):
    return f"{FOLDER}/{set_up}.{name}.{turn}.f32"


def measured(set_up, contestants):
    turns = by_turns(contestants)
    noises = noise(
        {name: [picture(set_up, name, turn) for turn in range(RUNS)] for name in contestants}
    )
    set_up_file = json.load(open(f"{FOLDER}/{set_up}.json"))
    told = {
        "samples": SAMPLES[set_up],
        "pixels": set_up_file["width"] * set_up_file["height"],
        "turns": turns,
        "noise": noises,
    }
    return told


def by_rtc(set_up):
    def one(turn):
        out = picture(set_up, "rtc", turn)
        ran = run(
            os.environ["PATHS"], f"{FOLDER}/{set_up}.json", str(SAMPLES[set_up]), str(turn + 1), out
        )
        return {**ran, **json.loads(ran.pop("told"))}

    return one


def courtyard():
    def by_mitsuba(name, sampler, variant):
        def one(turn):
            out = picture("Courtyard", name, turn)
            arguments = [
                f"{FOLDER}/Courtyard.xml",
                str(SAMPLES["Courtyard"]),
                str(turn + 1),
                out,
                sampler,
                variant,
            ]
            ran = run(sys.executable, f"{HERE}/paths_mitsuba.py", *arguments)
            return {**ran, **json.loads(ran.pop("told"))}

        return one

    emit(f"{FOLDER}/Courtyard.yaml", f"{FOLDER}/Courtyard.xml")
    os.environ["DRJIT_LIBLLVM_PATH"] = glob.glob("/usr/lib/*/libLLVM.so.19.1")[0]
    pairs = [
        ("scalar_rgb", "independent"),
        ("scalar_rgb", "multijitter"),
        ("llvm_ad_rgb", "independent"),
    ]
    contestants = {}
    for variant, sampler in pairs:
        name = f"Mitsuba {variant.split('_')[0]}, {sampler}"
        contestants[name] = by_mitsuba(name, sampler, variant)
    return measured("Courtyard", {"rtc": by_rtc("Courtyard"), **contestants})


def assets():
    found = {}
    for asset in ASSETS:
        path = f"{FOLDER}/{asset}.json"
        if not os.path.exists(path):
            print(f"  no {path}: {asset} is left out", file=sys.stderr)
            continue
        command = [sys.executable, f"{HERE}/paths_cycles.py", path, str(SAMPLES[asset])]
        with subprocess.Popen(
            command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True
        ) as cycles:
            cycles.stdout.readline()

            def by_cycles(turn):
                print(turn + 1, picture(asset, "Cycles", turn), file=cycles.stdin, flush=True)
                return json.loads(cycles.stdout.readline())

            found[asset] = measured(asset, {"rtc": by_rtc(asset), "Cycles": by_cycles})
            cycles.stdin.close()
    return found


def models():
    """From a model to its first picture, of 400 x 400 pixels: f3d by software GL, rtc by its quick
    and by its default quality."""
    found = {}
    for asset in MODELS:
        path = f"../shared/gltf/assets/{asset}"
        if not os.path.exists(path):
            print(f"  no {path}: it is left out", file=sys.stderr)
            continue
        out = f"{FOLDER}/model.png"
        f3d = ["xvfb-run", "-a", "f3d", path, f"--output={out}", "--resolution=400,400"]
        rtc = [
            os.environ["RTC"],
            "render",
            path,
            "--size",
            "400x400",
            "--threads",
            "1",
            "-q",
            "-o",
            out,
        ]
        draft = [*rtc, "--quality", "draft"]
        found[asset] = by_turns(
            {"f3d": lambda _: run(*f3d), "draft": lambda _: run(*draft), "rtc": lambda _: run(*rtc)}
        )
    return found


def growth():
    """Globes of ten times as many triangles each: from the mesh in memory to the hierarchy, and
    rays to anywhere."""
    found = {}
    for exponent in range(3, int(os.environ.get("MOST", "7")) + 1):
        folder = f"{FOLDER}/growth{exponent}"
        os.makedirs(folder, exist_ok=True)
        points, corners = globe(np.random.default_rng(15), round((10**exponent / 2) ** 0.5) + 1)
        points.tofile(f"{folder}/globe.vertices.f32")
        corners.tofile(f"{folder}/globe.corners.u32")
        write_glb(f"{folder}/globe.glb", [(None, points, corners)])
        rays = np.fromfile(f"{FOLDER}/incoherent.f32", np.float32)[: 6 * GROWTH_RAYS]
        rays.tofile(f"{folder}/incoherent.f32")

        ours = [os.environ["RAYS"], f"{folder}/globe.glb", f"{folder}/incoherent.f32"]
        theirs = [sys.executable, f"{HERE}/rays_embree.py", folder, f"{folder}/incoherent.f32"]
        turns = by_turns(
            {"rtc": lambda _: seconds(*ours), "Embree": lambda _: seconds(*theirs)}, min(RUNS, 3)
        )
        found[exponent] = {"triangles": len(corners), "rays": GROWTH_RAYS, **turns}
    return found


def cores():
    """Seconds of the clock on one thread and on two."""
    found = {}
    scenes = {
        "camera": ["scenes/camera.yaml", "--supersampling", "8"],
        "vases": ["scenes/vases.yaml", "--spp", "32"],
    }
    scenes["globe"] = [f"{FOLDER}/globe.glb", "--size", "256x256", "--spp", "16"]
    for name, scene in scenes.items():
        command = [
            os.environ["RTC"],
            "render",
            *scene,
            "-q",
            "-o",
            f"{FOLDER}/cores.png",
            "--threads",
        ]
        found[name] = by_turns(
            {threads: lambda _, threads=threads: run(*command, threads) for threads in ("1", "2")}
        )
    return found


def main(kinds):
    path = os.environ["RESULTS"]
    results = json.load(open(path)) if os.path.exists(path) else {}
    kinds_by_name = {
        measure.__name__: measure
        for measure in (rays, course, courtyard, assets, models, growth, cores)
    }
    for kind in kinds:
        print(f"{kind}:", file=sys.stderr)
        results[kind] = kinds_by_name[kind]()
        with open(path, "w") as file:
            json.dump(results, file, indent=1)


if __name__ == "__main__":
    main(sys.argv[3:])
