"""Compares emitters with Mitsuba's; see lights.sh. The mean is that of all pixels, ours over
Mitsuba's; its error and the unit of z come from the spread of four converged pictures of each.
relMSE is the mean of (x - r)^2 / (r^2 + e), e a hundredth of the mean square of r, against
converged pictures of the same program, so that a difference of means is not counted twice."""

import json
import math
import os
import subprocess
import sys

import numpy as np

HERE = os.path.dirname(os.path.abspath(__file__))
paths, WORK = sys.argv[1:]
RTC = os.environ["RTC"]
SIDE = int(os.environ.get("SIDE", 24))
SAMPLES = int(os.environ.get("SAMPLES", 16))
REFERENCE = int(os.environ.get("REFERENCE", 1024))
SEEDS = 8

HEAD = """Camera: {{eye: [0, 2, 7], center: [0, 0.3, 0], up: [0, 1, 0], fov: 26, viewSize: [{side}, {side}]}}
Environment: {{color: 0}}
PathParameters: {{samples: 16}}
MaxRecursionDepth: 8
Objects:
"""
FLOOR = "{type: quad, v0: [-6, 0, -6], v1: [-6, 0, 6], v2: [6, 0, 6], v3: [6, 0, -6], material: {type: standard, baseColor: [0.8, 0.8, 0.8, 1], metallic: 0, roughness: 1, specular: 0, doubleSided: true}}"
BALL = "{type: sphere, position: [-0.8, 0.7, 0.5], radius: 0.7, material: {type: standard, baseColor: [0.7, 0.4, 0.3, 1], metallic: 0, roughness: 1, specular: 0, doubleSided: true}}"
MASK = "{type: quad, v0: [-2, 1.6, -2], v1: [-2, 1.6, 2], v2: [2, 1.6, 2], v3: [2, 1.6, -2], material: {type: standard, baseColor: [0.5, 0.5, 0.5, 0.4], metallic: 0, roughness: 1, specular: 0, alpha: blend, doubleSided: true}}"
PANE = "{type: box, min: [-2, 1.5, -2], max: [2, 1.6, 2], material: {type: standard, transmission: 1, thickness: 1, roughness: 0, metallic: 0, ior: 1.5}}"

# Smooth, thin, and the light that it sends back between its faces counted.
WINDOW = "{type: quad, v0: [-2, 1.6, -2], v1: [-2, 1.6, 2], v2: [2, 1.6, 2], v3: [2, 1.6, -2], material: {type: standard, transmission: 1, roughness: 0, metallic: 0, thinDielectric: true, doubleSided: true}}"


def lamp(shape, radiance, more=""):
    emissive = json.dumps([radiance, radiance * 0.8, radiance * 0.5])
    return f"{{{shape}, material: {{type: standard, baseColor: [0, 0, 0, 1], metallic: 0, specular: 0, emissive: {emissive}{more}}}}}"


def sphere(radius, at=(0.6, 3, 0)):
    """A lamp of the same power for each radius."""
    return lamp(f"type: sphere, position: {list(at)}, radius: {radius}", 4 / radius**2)


QUAD = "type: quad, v0: [0, 2.5, -0.5], v1: [1, 2.5, -0.5], v2: [1, 2.5, 0.5], v3: [0, 2.5, 0.5]"
UPRIGHT = "type: quad, v0: [0.5, 0.5, -0.5], v1: [0.5, 1.5, -0.5], v2: [0.5, 1.5, 0.5], v3: [0.5, 0.5, 0.5]"
BOTH = ", doubleSided: true"
HOLLOW = "type: difference, a: {type: sphere, position: [0.5, 2.5, 0], radius: 0.3}, b: {type: sphere, position: [0.5, 2.65, 0], radius: 0.22}"
ROD = "position: [0, 2.5, 0], direction: [1, 0.1, 0.2], radius: 0.05"
PATCH = "type: quad, v0: [0, 2.3, -0.5], v1: [1, 2.7, -0.5], v2: [1, 2.3, 0.5], v3: [0, 2.7, 0.5]"
# Mitsuba's emitters have one side: it gets two of them, back to back. Its cylinders have ends.
TWINS = {
    "infinite cylinder": [
        lamp(
            "type: cylinder, position: [-200, -17.5, -40], direction: [1, 0.1, 0.2], height: "
            "409.9, radius: 0.05",
            12,
        )
    ],
    "two-sided quad": [
        lamp(UPRIGHT, 8),
        lamp(
            "type: quad, v0: [0.499, 0.5, 0.5], v1: [0.499, 1.5, 0.5], v2: [0.499, 1.5, -0.5], v3: "
            "[0.499, 0.5, -0.5]",
            8,
        ),
    ],
}
FAMILIES = {
    **{f"sphere of radius {radius}": [sphere(radius)] for radius in (1, 0.1, 0.01, 0.001, 0.0001)},
    "quad": [lamp(QUAD, 8, BOTH)],
    "disc": [lamp("type: disc, position: [0.5, 2.5, 0], normal: [0, -1, 0], radius: 0.5", 8, BOTH)],
    "triangle": [
        lamp(
            "type: triangle, v0: [0, 2.5, -0.5], v1: [1, 2.5, -0.5], v2: [0.5, 2.5, 0.5]", 16, BOTH
        )
    ],
    "cylinder": [
        lamp(
            "type: cylinder, position: [0.5, 1.5, 0], direction: [0, 1, 0], height: 1, radius: 0.1",
            12,
        )
    ],
    "cone": [
        lamp(
            "type: cone, position: [0.5, 2, 0], direction: [0, 1, 0], height: 0.6, radius: 0.4", 12
        )
    ],
    "box": [lamp("type: box, min: [0.2, 2, -0.2], max: [0.6, 2.4, 0.2]", 12)],
    "torus": [
        lamp(
            "type: torus, position: [0.5, 2, 0], normal: [0, 1, 0], majorRadius: 0.5, minorRadius: "
            "0.1",
            12,
        )
    ],
    "two-sided quad": [lamp(UPRIGHT, 8, BOTH)],
    "textured quad": [lamp(QUAD, 16, BOTH + ", emissiveMap: {pattern: checker, scale: 4}")],
    "inside a sphere": [lamp("type: sphere, position: [0, 0, 0], radius: 12", 0.3, BOTH)],
    "sphere behind glass": [PANE, sphere(0.5)],
    "quad behind a mask": [MASK, lamp(QUAD, 8, BOTH)],
    "hollow ball": [lamp(HOLLOW, 12)],
    "infinite cylinder": [lamp("type: infiniteCylinder, " + ROD, 12)],
    "curved quad": [lamp(PATCH, 8, BOTH)],
    "sphere behind a window": [WINDOW, sphere(0.1)],
    # Each of its triangles shines both ways, so Mitsuba gets one more at its back.
    "street of 1000": None,
    "street of 100000": None,
}


def run(*command):
    done = subprocess.run([str(word) for word in command], capture_output=True, text=True)
    if done.returncode:
        raise RuntimeError(done.stderr[-600:])
    return done


def ours(scene, samples, seed):
    out = os.path.join(WORK, "ours.raw")
    seconds = json.loads(run(paths, scene, samples, seed, out).stdout)["render_cpu_s"]
    return np.fromfile(out, "<f4").astype(float), seconds


def mitsubas(scene, samples, seed):
    out = os.path.join(WORK, "mitsuba.raw")
    script = os.path.join(HERE, "peers", "paths_mitsuba.py")
    row = run(sys.executable, script, scene, samples, seed, out, "multijitter").stdout
    row = json.loads(row[row.index('{"render_s') :])
    return np.nan_to_num(np.fromfile(out, "<f4").astype(float)), row["render_cpu_s"]


def street(name, stem, *more):
    """A street in so many pixels, with matt walls and black lamps, which both programs know
    exactly."""
    run(sys.executable, os.path.join(HERE, "street.py"), name.split()[-1], stem + ".gltf", *more)
    with open(stem + ".gltf") as file:
        asset = json.load(file)
    asset["materials"][0]["pbrMetallicRoughness"]["roughnessFactor"] = 1
    for material in asset["materials"]:
        material.setdefault("extensions", {})["KHR_materials_specular"] = {"specularFactor": 0}
    for lamp in asset["materials"][1:]:
        lamp["pbrMetallicRoughness"] = {"baseColorFactor": [0, 0, 0, 1], "metallicFactor": 0}
    asset["extensionsUsed"].append("KHR_materials_specular")
    with open(stem + ".gltf", "w") as file:
        json.dump(asset, file)
    text = json.loads(
        run(RTC, "compile", stem + ".gltf", "-o", "-", "--emit", "ir", "--allow", "warnings").stdout
    )
    camera = text["camera"]
    scale = max(camera["size"]) / (2 * SIDE)
    camera["right"], camera["up"] = (
        [number * scale for number in camera[axis]] for axis in ("right", "up")
    )
    camera["size"] = [max(1, round(side / scale)) for side in camera["size"]]
    with open(stem + ".json", "w") as file:
        json.dump(text, file)
    run(RTC, "compile", stem + ".json", "-o", stem + ".rtir", "--allow", "warnings")
    return stem + ".rtir"


def write(name, objects):
    """The scene for us and for Mitsuba, and whether that lost something."""
    stem = os.path.join(WORK, name.replace(" ", "-"))
    scene = stem + ".yaml"
    if objects is None:
        scene, twin = street(name, stem), street(name, stem + "-twin", "twins")
    else:
        for file, lamps in ((scene, objects), (stem + "-twin.yaml", TWINS.get(name, objects))):
            with open(file, "w") as out:
                out.write(
                    HEAD.format(side=SIDE)
                    + "".join(f"- {text}\n" for text in [FLOOR, BALL, *lamps])
                )
        twin = stem + "-twin.yaml"
    told = run(RTC, "compile", twin, "-o", stem + ".xml").stderr
    return scene, stem + ".xml", told.count("warning[")


def converged(render, scene):
    """The mean of four pictures, that of all pixels, and the standard error of that."""
    pictures = [render(scene, REFERENCE, 1000 + seed)[0] for seed in range(4)]
    means = [picture.mean() for picture in pictures]
    return np.mean(pictures, 0), np.mean(means), np.std(means, ddof=1) / 2


def relative(render, scene, truth):
    epsilon = 0.01 * (truth**2).mean()
    rows = [render(scene, SAMPLES, seed) for seed in range(1, SEEDS + 1)]
    return np.mean([((x - truth) ** 2 / (truth**2 + epsilon)).mean() for x, _ in rows])


def main():
    os.makedirs(WORK, exist_ok=True)
    print(
        "| family | mean | over Mitsuba's | z | relMSE | Mitsuba's | ratio | warnings of the "
        "export |"
    )
    print("| --- | --: | --: | --: | --: | --: | --: | --: |")
    wanted = os.environ.get("ONLY", "").split(";")
    for name, objects in FAMILIES.items():
        if wanted != [""] and name not in wanted:
            continue
        scene, twin, warnings = write(name, objects)
        (our_truth, our_mean, our_error) = converged(ours, scene)
        # Mitsuba 3.9.1 finds no number in the pixels of an emissive mesh with a texture, and says
        # so for each sample.
        (truth, mean, error) = (
            converged(mitsubas, twin) if name != "textured quad" else (None, 0, 0)
        )
        if mean == 0:
            own = relative(ours, scene, our_truth)
            print(
                f"| {name} | {our_mean:.5f} | its picture is black or no number | | {own:.5f} | | "
                f"| {warnings} |",
                flush=True,
            )
            continue
        ratio, spread = our_mean / mean, math.hypot(our_error / our_mean, error / mean)
        errors = relative(ours, scene, our_truth), relative(mitsubas, twin, truth)
        z = (ratio - 1) / spread if spread else 0
        print(
            f"| {name} | {our_mean:.5f} | {ratio:.4f} ± {spread:.4f} | {z:+.1f} | {errors[0]:.5f} "
            f"| {errors[1]:.5f} | {errors[0] / errors[1]:.2f} | {warnings} |",
            flush=True,
        )


main()
