"""Writes a glTF of a street with 6 lamps or more: `street.py LIGHTS OUT.gltf [twins]`. As twins
each shining triangle has another one at its back, for renderers whose emitters shine to one side.

Half of the lights are points (KHR_lights_punctual), half are small shining triangles that face the
street, in three colours. The same number gives the same bytes."""

import base64
import json
import random
import struct
import sys

LENGTH = 100.0


def box(low, high):
    """The triangles of a box, as corners."""
    (a, b, c), (d, e, f) = low, high
    quads = [
        [(a, b, c), (a, b, f), (a, e, f), (a, e, c)],
        [(d, b, c), (d, e, c), (d, e, f), (d, b, f)],
        [(a, b, c), (d, b, c), (d, b, f), (a, b, f)],
        [(a, e, c), (a, e, f), (d, e, f), (d, e, c)],
        [(a, b, c), (a, e, c), (d, e, c), (d, b, c)],
        [(a, b, f), (d, b, f), (d, e, f), (a, e, f)],
    ]
    return [quad[k] for quad in quads for k in (0, 1, 2, 0, 2, 3)]


def shining(draw):
    """A triangle on a wall of the street, a hand above it."""
    side = draw.choice((-1.0, 1.0))
    x, y, z = side * 3.95, draw.uniform(0.3, 7.0), -draw.uniform(0.0, LENGTH)
    low, along, up = (x, y, z), (x, y, z + 0.1), (x, y + 0.1, z)
    return [low, along, up] if side > 0 else [low, up, along]


def backs(triangle):
    """A triangle, and one a millimetre behind it that faces the wall."""
    behind = 0.001 if triangle[0][0] > 0 else -0.001
    a, b, c = ((x + behind, y, z) for x, y, z in triangle)
    return triangle + [a, c, b]


def main(count, out, twins=False):
    """Writes the scene."""
    draw = random.Random(7)
    houses = [
        box((-10, -1, -LENGTH), (10, 0, 5)),
        box((-10, 0, -LENGTH), (-4, 9, 5)),
        box((4, 0, -LENGTH), (10, 9, 5)),
    ]
    houses += [
        box((x, 0, z), (x + 0.6, draw.uniform(0.5, 2.0), z + 0.6))
        for x, z in ((draw.uniform(-3, 2.4), -draw.uniform(2, LENGTH)) for _ in range(60))
    ]
    triangles = [shining(draw) for _ in range(count // 2)]
    shown = [backs(triangle) for triangle in triangles] if twins else triangles
    groups = [sum(houses, [])] + [sum(shown[k::3], []) for k in range(3)]
    glows = [(1.0, 0.6, 0.2), (0.3, 0.6, 1.0), (1.0, 0.9, 0.7)]
    materials = [
        {
            "pbrMetallicRoughness": {
                "baseColorFactor": [0.6, 0.6, 0.6, 1],
                "metallicFactor": 0,
                "roughnessFactor": 0.6,
            }
        }
    ]
    materials += [
        {
            "emissiveFactor": glow,
            "doubleSided": True,
            "extensions": {"KHR_materials_emissive_strength": {"emissiveStrength": 40}},
        }
        for glow in glows
    ]
    data = b"".join(struct.pack("<3f", *corner) for group in groups for corner in group)
    views, accessors, offset = [], [], 0
    for group in groups:
        views.append({"buffer": 0, "byteOffset": offset, "byteLength": 12 * len(group)})
        columns = list(
            zip(*(struct.unpack("<3f", struct.pack("<3f", *corner)) for corner in group))
        )
        accessors.append(
            {
                "bufferView": len(views) - 1,
                "componentType": 5126,
                "count": len(group),
                "type": "VEC3",
                "min": [min(column) for column in columns],
                "max": [max(column) for column in columns],
            }
        )
        offset += 12 * len(group)
    nodes = [{"mesh": 0}, {"camera": 0, "translation": [0, 1.7, 3]}]
    lights = []
    for lamp in range(count - len(triangles)):
        lights.append(
            {"type": "point", "intensity": draw.uniform(0.1, 0.6), "color": glows[lamp % 3]}
        )
        place = [draw.uniform(-3.8, 3.8), draw.uniform(0.3, 6), -draw.uniform(0, LENGTH)]
        nodes.append({"translation": place, "extensions": {"KHR_lights_punctual": {"light": lamp}}})
    scene = {
        "asset": {"version": "2.0"},
        "extensionsUsed": ["KHR_lights_punctual", "KHR_materials_emissive_strength"],
        "buffers": [
            {
                "byteLength": len(data),
                "uri": "data:application/octet-stream;base64," + base64.b64encode(data).decode(),
            }
        ],
        "bufferViews": views,
        "accessors": accessors,
        "materials": materials,
        "meshes": [
            {
                "primitives": [
                    {"attributes": {"POSITION": k}, "material": k}
                    for k in range(len(groups))
                    if groups[k]
                ]
            }
        ],
        "cameras": [
            {"type": "perspective", "perspective": {"yfov": 1.0, "aspectRatio": 1.5, "znear": 0.1}}
        ],
        "extensions": {"KHR_lights_punctual": {"lights": lights}},
        "nodes": nodes,
        "scenes": [{"nodes": list(range(len(nodes)))}],
        "scene": 0,
    }
    with open(out, "w", encoding="utf-8") as file:
        json.dump(scene, file)


if __name__ == "__main__":
    main(int(sys.argv[1]), sys.argv[2], "twins" in sys.argv[3:])
