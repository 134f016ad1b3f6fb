"""What the peers and rtc are measured with, made into a folder: `scenes.py FOLDER`.

globe.glb, globe.vertices.f32, globe.corners.u32: a bumpy globe of 1 045 458 triangles.
coherent.f32, incoherent.f32: 2^20 rays each, six numbers a ray: origin, direction. courtyard.glb: a
courtyard. NAME.json: set-ups of assets, in metres and radiance: camera, surroundings, suns,
bounces, pixels; NAME.yaml: the same as a scene of rtc."""

import json
import os
import struct
import sys

import numpy as np

# --- The globe and its rays.

SIDE = 724  # Vertices around and from pole to pole; (SIDE - 1)^2 squares.
RAYS = 1 << 20


def globe(random, side=SIDE):
    """Waves of three sizes and a little roughness on a ball of radius 1, cut off before the poles.
    """
    around, down = np.meshgrid(
        np.linspace(0, 2 * np.pi, side), np.linspace(0.03, np.pi - 0.03, side)
    )
    waves = 0.06 * np.sin(7 * around) * np.sin(9 * down) + 0.02 * np.cos(
        31 * around + 3 * down
    ) * np.sin(37 * down)
    radius = 1 + waves + 0.004 * random.uniform(-1, 1, around.shape)
    ring = radius * np.sin(down)
    points = np.stack(
        [ring * np.cos(around), radius * np.cos(down), ring * np.sin(around)], -1
    ).reshape(-1, 3)
    first = (np.arange(side - 1)[:, None] * side + np.arange(side - 1)).ravel()
    squares = [first, first + 1, first + side, first + 1, first + side + 1, first + side]
    return points.astype(np.float32), np.stack(squares, -1).reshape(-1, 3).astype(np.uint32)


def unit(vectors):
    return vectors / np.linalg.norm(vectors, axis=-1, keepdims=True)


def coherent():
    """Camera rays of 1024 x 1024 pixels, row by row; the globe fills most of them."""
    side = int(RAYS**0.5)
    x, y = np.meshgrid(np.linspace(-0.55, 0.55, side), np.linspace(0.55, -0.55, side))
    directions = unit(np.stack([x, y, -np.ones_like(x)], -1).reshape(-1, 3))
    return np.concatenate([np.tile([0.0, 0.0, 2.3], (RAYS, 1)), directions], 1).astype(np.float32)


def incoherent(random):
    """From anywhere on a sphere around the globe to anywhere in a cube about as large as the globe.
    """
    origins = 2 * unit(random.standard_normal((RAYS, 3)))
    directions = unit(random.uniform(-0.9, 0.9, (RAYS, 3)) - origins)
    return np.concatenate([origins, directions], 1).astype(np.float32)


# --- The courtyard: quads of four corners each, by material.

STONE, PLASTER, WATER = (0.55, 0.5, 0.42), (0.75, 0.72, 0.65), (0.25, 0.4, 0.45)


def grid(corner, along, across, columns, rows):
    """A rectangle in so many quads, facing along x across."""
    corner, along, across = (np.array(vector, float) for vector in (corner, along, across))
    u, v = np.meshgrid(np.arange(columns), np.arange(rows))
    at = lambda i, j: (
        corner + (u + i)[..., None] / columns * along + (v + j)[..., None] / rows * across
    )
    return np.stack([at(0, 0), at(1, 0), at(1, 1), at(0, 1)], 2).reshape(-1, 4, 3)


def turned(profile, center, sides):
    """A profile of (radius, height) turned about an upright axis, facing out where it goes up."""
    profile, angles = np.array(profile, float), np.arange(sides + 1) / sides * 2 * np.pi
    ring = lambda r, y: np.stack(
        [center[0] + r * np.sin(angles), np.full(sides + 1, y), center[1] + r * np.cos(angles)], -1
    )
    quads = []
    for (r0, y0), (r1, y1) in zip(profile, profile[1:]):
        low, high = ring(r0, y0), ring(r1, y1)
        quads.append(np.stack([low[:-1], low[1:], high[1:], high[:-1]], 1))
    return np.concatenate(quads)


def box(low, high):
    (x0, y0, z0), (x1, y1, z1) = low, high
    x, y, z = (x1 - x0, 0, 0), (0, y1 - y0, 0), (0, 0, z1 - z0)
    faces = [
        ((x0, y0, z1), x, y),
        ((x1, y0, z0), (x0 - x1, 0, 0), y),
        ((x1, y0, z1), (0, 0, z0 - z1), y),
        ((x0, y0, z0), z, y),
    ]
    faces += [((x0, y1, z1), x, (0, 0, z0 - z1)), ((x0, y0, z0), x, z)]
    return np.concatenate([grid(corner, along, across, 1, 1) for corner, along, across in faces])


def courtyard():
    """A paved court of 16 m between four walls, an arcade of columns, a fountain in the middle."""
    stone = [grid((-8, 0, 8), (16, 0, 0), (0, 0, -16), 24, 24)]
    plaster = []
    for x, z in (
        (1, 0),
        (0, 1),
        (-1, 0),
        (0, -1),
    ):  # Inward normals of the walls, and of the roofs along them.
        beside = (z, 0, -x)
        corner = tuple(-8 * n - 8 * b for n, b in zip((x, 0, z), beside))
        plaster.append(grid(corner, tuple(16 * b for b in beside), (0, 6, 0), 16, 6))
        low, high = zip(
            *(sorted((-8 * n - 8 * b, -6 * n + 8 * b)) for n, b in zip((x, 0, z), beside))
        )
        plaster.append(box((low[0], 3.6, low[2]), (high[0], 4.0, high[2])))
    column = [
        (0.34, 0),
        (0.34, 0.25),
        (0.22, 0.35),
        (0.24, 1.5),
        (0.19, 3.2),
        (0.34, 3.4),
        (0.34, 3.6),
    ]
    for k in range(5):
        for x, z in ((1, 0), (0, 1), (-1, 0), (0, -1)):
            along = -6 + 2.4 * k
            stone.append(turned(column, (-6 * x + along * z, -6 * z - along * x), 14))
    basin = [(2.2, 0), (2.2, 0.7), (2.0, 0.8), (1.8, 0.7), (1.8, 0.3)]
    bowl = [
        (0.3, 0.5),
        (0.2, 1.0),
        (0.25, 1.3),
        (1.0, 1.6),
        (1.05, 1.7),
        (0.9, 1.65),
        (0.15, 1.55),
        (0.1, 2.1),
        (0.0, 2.2),
    ]
    stone += [turned(basin, (0, 0), 40), turned(bowl, (0, 0), 40)]
    water = [turned([(1.8, 0.5), (0.9, 0.5), (0.0, 0.5)], (0, 0), 40)]
    return [
        (STONE, np.concatenate(stone)),
        (PLASTER, np.concatenate(plaster)),
        (WATER, np.concatenate(water)),
    ]


def triangles_of(quads):
    """Two triangles a quad, one where it has two equal corners."""
    halves = np.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]])
    area = np.linalg.norm(
        np.cross(halves[:, 1] - halves[:, 0], halves[:, 2] - halves[:, 0]), axis=-1
    )
    return halves[area > 1e-12].astype(np.float32)


# --- Files.


def write_glb(path, parts):
    """A mesh for each part (color or None, points, corners), of materials that reflect as Lambert's
    law says."""
    binary, views, accessors, materials, meshes = b"", [], [], [], []

    def accessor(array, kind, **more):
        nonlocal binary
        views.append({"buffer": 0, "byteOffset": len(binary), "byteLength": array.nbytes})
        number = {"f": 5126, "u": 5125}[array.dtype.kind]
        count = len(array) if array.ndim > 1 else array.size
        accessors.append(
            {
                "bufferView": len(views) - 1,
                "componentType": number,
                "type": kind,
                "count": count,
                **more,
            }
        )
        binary += array.tobytes()
        return len(accessors) - 1

    for color, points, corners in parts:
        bounds = {"min": points.min(0).tolist(), "max": points.max(0).tolist()}
        primitive = {
            "attributes": {"POSITION": accessor(points, "VEC3", **bounds)},
            "indices": accessor(corners.ravel(), "SCALAR"),
        }
        if color:
            primitive["material"] = len(materials)
            lambert = {"metallicFactor": 0, "baseColorFactor": [*color, 1]}
            no_gloss = {"KHR_materials_specular": {"specularFactor": 0}}
            materials.append(
                {"pbrMetallicRoughness": lambert, "extensions": no_gloss, "doubleSided": True}
            )
        meshes.append({"primitives": [primitive]})
    count = len(meshes)
    asset = {"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": list(range(count))}]}
    asset |= {
        "nodes": [{"mesh": mesh} for mesh in range(count)],
        "meshes": meshes,
        "accessors": accessors,
    }
    asset |= {"bufferViews": views, "buffers": [{"byteLength": len(binary)}]}
    if materials:
        asset |= {"materials": materials, "extensionsUsed": ["KHR_materials_specular"]}
    text = json.dumps(asset).encode()
    text += b" " * (-len(text) % 4)
    with open(path, "wb") as file:
        file.write(struct.pack("<4sII", b"glTF", 2, 28 + len(text) + len(binary)))
        file.write(struct.pack("<I4s", len(text), b"JSON") + text)
        file.write(struct.pack("<I4s", len(binary), b"BIN\0") + binary)


def write_set_up(folder, name, asset, side, bounces, camera, radiance, suns):
    position, look_at, angle = camera
    view = {"position": position, "look_at": look_at, "up": [0, 1, 0], "yfov_deg": angle}
    lights = {
        "env_radiance": radiance,
        "suns": [{"direction_to_light": to, "irradiance": e} for to, e in suns],
    }
    set_up = {
        "asset": asset,
        "width": side,
        "height": side,
        "max_bounces": bounces,
        "camera": view,
        "lights": lights,
    }
    json.dump(set_up, open(f"{folder}/{name}.json", "w"), indent=1)
    view = {
        "eye": position,
        "center": look_at,
        "up": [0, 1, 0],
        "fov": angle,
        "viewSize": [side, side],
    }
    lights = [{"type": "sun", "direction": to, "irradiance": e} for to, e in suns]
    scene = {
        "RenderMode": "path",
        "MaxRecursionDepth": bounces,
        "Camera": view,
        "Environment": {"color": radiance},
    }
    json.dump(
        {**scene, "Lights": lights, "Objects": [{"type": "gltf", "file": asset}]},
        open(f"{folder}/{name}.yaml", "w"),
        indent=1,
    )


def write_others(folder):
    """Set-ups of the assets in ../shared, where that is: seen as in their references, or as said
    here."""
    gltf = os.path.relpath("../shared/gltf", folder)
    for name in ("FlightHelmet", "MetalRoughGrid", "CornellLambert"):
        if os.path.exists(f"../shared/gltf/refs/{name}.json"):
            known = json.load(open(f"../shared/gltf/refs/{name}.json"))
            camera, lights = known["camera"], known["lights"]
            view = (camera["position"], camera["look_at"], camera["yfov_deg"])
            suns = [(sun["direction_to_light"], sun["irradiance"]) for sun in lights["suns"]]
            write_set_up(
                folder,
                name,
                f"{gltf}/refs/{known['asset']}",
                256,
                8,
                view,
                lights["env_radiance"],
                suns,
            )
    sun = (unit(np.array([0.5, 0.6, 0.6])).tolist(), [2.0, 1.9, 1.7])
    asset, view = f"{gltf}/assets/TransmissionRoughnessTest.glb", ([0.9, 0.5, 2.0], [0, 0, 0], 32)
    write_set_up(folder, "TransmissionRoughnessTest", asset, 256, 8, view, [0.6] * 3, [sun])


def main(folder):
    random = np.random.default_rng(15)
    os.makedirs(folder, exist_ok=True)
    points, corners = globe(random)
    points.tofile(f"{folder}/globe.vertices.f32")
    corners.tofile(f"{folder}/globe.corners.u32")
    write_glb(f"{folder}/globe.glb", [(None, points, corners)])
    coherent().tofile(f"{folder}/coherent.f32")
    incoherent(random).tofile(f"{folder}/incoherent.f32")
    parts = [(color, triangles_of(quads)) for color, quads in courtyard()]
    one_by_one = [
        (color, part.reshape(-1, 3), np.arange(part.size // 3, dtype=np.uint32))
        for color, part in parts
    ]
    write_glb(f"{folder}/courtyard.glb", one_by_one)
    sun = (unit(np.array([0.45, 0.8, 0.3])).tolist(), [3, 2.8, 2.4])
    view = ([4.6, 2.4, 5.2], [-1.4, 1.5, -2.2], 58)
    write_set_up(folder, "Courtyard", "courtyard.glb", 256, 32, view, [0.3, 0.4, 0.55], [sun])
    print(f"globe: {len(corners)} triangles; courtyard: {sum(len(part) for _, part in parts)}")
    write_others(folder)


if __name__ == "__main__":
    main(*sys.argv[1:])
