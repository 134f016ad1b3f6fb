"""Compares estimated caustics of a glass ellipsoid with photons that are traced here, from the
lamp: an estimator that has nothing in common with manifold sampling. Needs numpy. Usage:
caustics_photons.py PATHS FOLDER, where PATHS is the program `paths`.

Photons pass at most SURFACES smooth surfaces, as the paths of the picture do. What is no caustic is
subtracted from the picture: it is that of a point of the same intensity without the estimate, whose
caustics no path finds. Prints the mean of bright and of dim pixels by both."""

import json
import os
import subprocess
import sys

import numpy as np

SIDE, BATCH, BATCHES, SAMPLES, SEEDS = 48, 1_000_000, 24, 64, 16
# Chains of more surfaces would let light go from one caustic by the glass to the next.
SURFACES = 2
LAMP, RADIANCE, ALBEDO, IOR, FOV = 0.02, 30000.0, 0.8, 1.5, 35.0
SCENES = {
    "glass-ball": {"center": [0, 1, 0], "radii": [1, 1, 1], "lamp": [2.5, 5, 0], "eye": [0, 3, 7]},
    "lens": {"center": [0, 2, 0], "radii": [1, 0.3, 1], "lamp": [0.8, 6, 0], "eye": [0, 4, 7]},
}
TEXT = """Camera: {{eye: {eye}, center: [0, 0.6, 0], up: [0, 1, 0], fov: 35, viewSize: [48, 48]}}
Environment: {{color: 0}}
PathParameters: {{samples: 16, caustics: true}}
MaxRecursionDepth: {depth}
Objects:
- {{type: quad, v0: [-6, 0, -6], v1: [-6, 0, 6], v2: [6, 0, 6], v3: [6, 0, -6], material: {{type: standard, baseColor: [0.8, 0.8, 0.8, 1], metallic: 0, roughness: 1, specular: 0, doubleSided: true}}}}
- {{type: ellipsoid, position: {center}, radius: {radii}, material: {{type: standard, transmission: 1, thickness: 1, roughness: 0, metallic: 0, ior: 1.5}}}}
"""
LAMPS = {
    True: "- {{type: sphere, position: {lamp}, radius: 0.02, material: {{type: standard, baseColor: [0, 0, 0, 1], metallic: 0, specular: 0, emissive: [30000, 30000, 30000]}}}}\n",
    False: "Lights: [{{position: {lamp}, intensity: 37.69911184}}]\n",
}


def unit(v):
    return v / np.linalg.norm(v, axis=-1, keepdims=True)


def hit(origin, direction, center, radii):
    """The distance to an ellipsoid, infinite without a hit, beyond the rounding error."""
    o, d = (origin - center) / radii, direction / radii
    a, b, c = (d * d).sum(1), (o * d).sum(1), (o * o).sum(1) - 1
    square = b * b - a * c
    root = np.sqrt(np.maximum(square, 0))
    near, far = (-b - root) / a, (-b + root) / a
    t = np.where(near > 1e-7, near, np.where(far > 1e-7, far, np.inf))
    return np.where(square > 0, t, np.inf)


def photons(scene, rng):
    """Points on the floor with their flux, after one smooth surface or more."""
    center, radii, lamp = (np.array(scene[key], float) for key in ("center", "radii", "lamp"))
    axis = center - lamp
    distance = np.linalg.norm(axis)
    cosine = np.sqrt(1 - ((radii.max() + 2 * LAMP) / distance) ** 2)
    normal = unit(rng.normal(size=(BATCH, 3)))
    z = 1 - (1 - cosine) * rng.random(BATCH)
    turn, across = 2 * np.pi * rng.random(BATCH), np.sqrt(1 - z * z)
    w = axis / distance
    u = unit(np.cross(w, [0.0, 0.0, 1.0]))
    v = np.cross(w, u)
    d = (across * np.cos(turn))[:, None] * u + (across * np.sin(turn))[:, None] * v + z[:, None] * w
    facing = np.maximum((normal * d).sum(1), 0)
    flux = RADIANCE * facing * 4 * np.pi * LAMP**2 * 2 * np.pi * (1 - cosine) / BATCH
    o, places, powers = lamp + LAMP * normal, [], []
    for bounce in range(SURFACES + 1):
        t = hit(o, d, center, radii)
        lands = np.isinf(t) & (d[:, 1] < 0) & (bounce > 0)
        places.append((o - d * (o[:, 1] / d[:, 1])[:, None])[lands])
        powers.append(flux[lands])
        inside = np.isfinite(t) & (flux > 0)
        o, d, flux, t = o[inside], d[inside], flux[inside], t[inside]
        o = o + d * t[:, None]
        n = unit((o - center) / radii**2)
        back = (d * n).sum(1) > 0
        n = np.where(back[:, None], -n, n)
        eta = np.where(back, 1 / IOR, IOR)
        cosine_in = -(d * n).sum(1)
        square = 1 - (1 - cosine_in**2) / eta**2
        cosine_out = np.sqrt(np.maximum(square, 0))
        f0 = ((IOR - 1) / (IOR + 1)) ** 2
        fresnel = f0 + (1 - f0) * (1 - np.minimum(cosine_in, cosine_out)) ** 5
        reflected = rng.random(len(d)) < np.where(square > 0, fresnel, 1)
        mirror = d + 2 * cosine_in[:, None] * n
        through = d / eta[:, None] + (cosine_in / eta - cosine_out)[:, None] * n
        d = unit(np.where(reflected[:, None], mirror, through))
    return np.concatenate(places), np.concatenate(powers)


def camera(scene):
    """The eye, and its forward, right and upward vectors at the edge of the picture."""
    eye = np.array(scene["eye"], float)
    forward = unit(np.array([0, 0.6, 0]) - eye)
    right = unit(np.cross(forward, [0.0, 1.0, 0.0]))
    edge = np.tan(np.radians(FOV / 2))
    return eye, forward, right * edge, np.cross(right, forward) * edge


def floor_areas(scene):
    """The area of the floor in each pixel; 0 where a pixel is not all floor, or within the
    ellipsoid."""
    eye, forward, right, up = camera(scene)
    edges = 2 * np.arange(SIDE + 1) / SIDE - 1
    d = forward + edges[None, :, None] * right - edges[:, None, None] * up
    p = eye - d * (eye[1] / d[..., 1])[..., None]
    corners = p[:-1, :-1], p[:-1, 1:], p[1:, 1:], p[1:, :-1]
    ok = (d[..., 1] < 0) & (np.abs(p[..., 0]) < 5.9) & (np.abs(p[..., 2]) < 5.9)
    seen = hit(
        np.broadcast_to(eye, d.shape).reshape(-1, 3),
        d.reshape(-1, 3),
        np.array(scene["center"], float),
        np.array(scene["radii"], float),
    )
    ok &= np.isinf(seen).reshape(ok.shape)
    whole = ok[:-1, :-1] & ok[:-1, 1:] & ok[1:, 1:] & ok[1:, :-1]
    area = sum(
        a[..., 2] * b[..., 0] - a[..., 0] * b[..., 2]
        for a, b in zip(corners, corners[1:] + corners[:1])
    )
    return np.where(whole, np.abs(area) / 2, 0)


def radiance_of_photons(scene, areas, rng):
    eye, forward, right, up = camera(scene)
    places, powers = photons(scene, rng)
    d = places - eye
    depth = d @ forward
    x = (d @ right) / (right @ right) / depth
    y = -(d @ up) / (up @ up) / depth
    shape = [(-1, 1), (-1, 1)]
    flux, _, _ = np.histogram2d(y, x, SIDE, shape, weights=powers)
    return np.where(areas > 0, ALBEDO / np.pi * flux / np.maximum(areas, 1e-9), 0)


def render(paths, name, folder, seed, on):
    out, file = os.path.join(folder, "photons.raw"), os.path.join(folder, f"photons-{name}.yaml")
    with open(file, "w") as text:
        source = (TEXT + LAMPS[on]).format(
            depth=SURFACES + 1, **{key: json.dumps(value) for key, value in SCENES[name].items()}
        )
        text.write(source.replace("caustics: true", f"caustics: {json.dumps(on)}"))
    subprocess.run([paths, file, str(SAMPLES), str(seed), out], check=True, capture_output=True)
    return np.fromfile(out, "<f4").reshape(SIDE, SIDE, 3)[..., 1].astype(float)


def main():
    paths, folder = sys.argv[1:]
    os.makedirs(folder, exist_ok=True)
    print("| scene | part | pixels | photons | estimate | ratio | error of the ratio |")
    print("| --- | --- | --: | --: | --: | --: | --: |")
    for name, scene in SCENES.items():
        areas = floor_areas(scene)
        rng = np.random.default_rng(1)
        traced = np.array([radiance_of_photons(scene, areas, rng) for _ in range(BATCHES)])
        direct = np.mean([render(paths, name, folder, seed, False) for seed in range(4)], 0)
        shown = (
            np.array([render(paths, name, folder, seed, True) for seed in range(SEEDS)]) - direct
        )
        mean, bright = traced.mean(0), areas > 0
        parts = {"bright": bright & (mean > 0.1), "dim": bright & (mean <= 0.1) & (mean > 0)}
        for part, pixels in parts.items():
            a, b = (values[:, pixels].sum(1) / pixels.sum() for values in (traced, shown))
            error = np.hypot(
                a.std(ddof=1) / len(a) ** 0.5 / a.mean(), b.std(ddof=1) / len(b) ** 0.5 / b.mean()
            )
            ratio = b.mean() / a.mean()
            print(
                f"| {name} | {part} | {pixels.sum()} | {a.mean():.5f} | {b.mean():.5f} | "
                f"{ratio:.4f} | {ratio * error:.4f} |",
                flush=True,
            )


main()
