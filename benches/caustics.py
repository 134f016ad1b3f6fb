"""Measures caustics with and without manifold sampling; see caustics.sh."""

import array
import json
import math
import os
import subprocess
import sys

paths, folder = sys.argv[1:]
HERE = os.path.join(os.path.dirname(__file__), "caustics")
REFERENCE = int(os.environ.get("REFERENCE", "4096"))
SIDE = int(os.environ.get("SIDE", "128"))
BRIGHT = 10


def wave(x, z):
    """The height of the water and its two slopes."""
    waves = [
        (0.03, 3.1, 1.2, 0.3),
        (0.02, -2.2, 4.4, 1.1),
        (0.012, 5.2, -3.9, 2.0),
        (0.01, 1.3, 6.8, 0.7),
    ]
    height, dx, dz = 0, 0, 0
    for size, a, b, phase in waves:
        turn = a * x + b * z + phase
        height += size * math.sin(turn)
        dx += size * a * math.cos(turn)
        dz += size * b * math.cos(turn)
    return height, dx, dz


def water(path, side=96, extent=6.0):
    """A square of water with normals."""
    places, normals, faces = [], [], []
    for i in range(side + 1):
        for k in range(side + 1):
            x, z = (extent * (2 * j / side - 1) for j in (i, k))
            height, dx, dz = wave(x, z)
            places.append(f"v {x:.6f} {height:.6f} {z:.6f}\n")
            normals.append(f"vn {-dx:.6f} 1 {-dz:.6f}\n")
    for i in range(side):
        for k in range(side):
            a = i * (side + 1) + k + 1
            b, c, d = a + 1, a + side + 2, a + side + 1
            faces += [f"f {p}//{p} {q}//{q} {r}//{r}\n" for p, q, r in ((a, b, c), (a, c, d))]
    with open(path, "w") as out:
        out.writelines(places + normals + faces)


def render(scene, samples, seed):
    """The pixels, and the CPU-seconds."""
    out = os.path.join(folder, "out.raw")
    row = subprocess.run(
        [paths, scene, str(samples), str(seed), out], check=True, capture_output=True, text=True
    )
    with open(out, "rb") as file:
        pixels = array.array("f", file.read())
    return pixels, json.loads(row.stdout.splitlines()[-1])["render_cpu_s"]


def rel_mse(pixels, reference):
    """The mean of (p − r)² / (r² + ε), ε a hundredth of the mean square."""
    epsilon = 0.01 * sum(r * r for r in reference) / len(reference)
    terms = ((p - r) ** 2 / (r * r + epsilon) for p, r in zip(pixels, reference))
    return sum(terms) / len(reference)


def fireflies(pixels, reference):
    """Values above BRIGHT times the reference and the mean, per million."""
    mean = sum(reference) / len(reference)
    count = sum(p > BRIGHT * max(r, mean) for p, r in zip(pixels, reference))
    return 1e6 * count / len(reference)


def main():
    os.makedirs(folder, exist_ok=True)
    water(os.path.join(folder, "water.obj"))
    print(
        "| scene | samples off, on | CPU s off, on | mean on/off | relMSE off | relMSE on | per "
        "CPU second | fireflies/Mpx off, on |"
    )
    print("| --- | --- | --- | --- | --- | --- | --- | --- |")
    for name in sorted(os.listdir(HERE)):
        with open(os.path.join(HERE, name)) as file:
            text = file.read().replace("[128, 128]", f"[{SIDE}, {SIDE}]")
        scenes = {}
        for on in (False, True):
            scenes[on] = os.path.join(folder, f"{'on' if on else 'off'}-{name}")
            with open(scenes[on], "w") as file:
                file.write(text.replace("caustics: true", f"caustics: {'true' if on else 'false'}"))
        # References of both, so that the means can be compared; the less noisy one is that of the
        # estimate.
        long_off, _ = render(scenes[False], 4 * REFERENCE, 7)
        reference, _ = render(scenes[True], REFERENCE, 8)
        samples = {True: 16}
        _, on_time = render(scenes[True], 16, 1)
        _, off_time = render(scenes[False], 16, 1)
        samples[False] = max(16, round(16 * on_time / off_time))
        rows = {}
        for on in (False, True):
            results = [render(scenes[on], samples[on], seed) for seed in (1, 2, 3)]
            errors = [rel_mse(pixels, reference) for pixels, _ in results]
            flies = [fireflies(pixels, reference) for pixels, _ in results]
            rows[on] = sum(errors) / 3, sum(time for _, time in results) / 3, sum(flies) / 3
        gain = rows[False][0] * rows[False][1] / (rows[True][0] * rows[True][1])
        ratio = sum(reference) / sum(long_off)
        print(
            f"| {name[:-5]} | {samples[False]}, {samples[True]} | {rows[False][1]:.2f}, "
            f"{rows[True][1]:.2f} | {ratio:.4f} "
            f"| {rows[False][0]:.4g} | {rows[True][0]:.4g} | {gain:.1f} × | {rows[False][2]:.0f}, "
            f"{rows[True][2]:.0f} |",
            flush=True,
        )


main()
