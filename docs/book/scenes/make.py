#!/usr/bin/env python3
"""Writes the assets of the scenes beside it: two pictures, a height map, an environment, four
meshes and a glTF model. It needs nothing but Python."""

import json
import math
import os
import struct
import zlib

TAU = math.tau
os.chdir(os.path.dirname(os.path.abspath(__file__)))


def png(path, width, height, pixel, channels=3):
    """A PNG of 8 bits; pixel(x, y) gives its channels, each from 0 to 1."""
    kind = {1: 0, 3: 2}[channels]
    rows = bytearray()
    for y in range(height):
        rows.append(0)
        for x in range(width):
            rows += bytes(round(255 * min(max(c, 0), 1)) for c in pixel(x, y))

    def chunk(name, data):
        crc = zlib.crc32(name + data)
        return struct.pack(">I", len(data)) + name + data + struct.pack(">I", crc)

    head = struct.pack(">IIBBBBB", width, height, 8, kind, 0, 0, 0)
    with open(path, "wb") as file:
        file.write(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", head))
        file.write(chunk(b"IDAT", zlib.compress(bytes(rows), 9)) + chunk(b"IEND", b""))


def planet(x, y):
    """Cloud bands in eight colours, with waves, and one storm."""
    u, v = x / 512, y / 256
    wave = 0.012 * math.sin(TAU * (5 * u + 3 * v)) + 0.006 * math.sin(TAU * (11 * u - 2 * v))
    du, dv = (u - 0.62) * 2, v - 0.64
    if (du / 0.13) ** 2 + (dv / 0.07) ** 2 < 1:
        return (0.72, 0.32, 0.2)
    colours = [
        (0.55, 0.48, 0.42), (0.86, 0.78, 0.66), (0.68, 0.5, 0.36), (0.93, 0.87, 0.78),
        (0.78, 0.58, 0.4), (0.9, 0.82, 0.7), (0.6, 0.42, 0.32), (0.82, 0.72, 0.6),
    ]
    return colours[int((v + wave) * 13) % 8]


def wood(x, y):
    """Boards: rings cut along the trunk, in six browns."""
    board = y // 32
    u, v = x / 128 + 0.37 * board, (y % 32) / 32
    if y % 32 == 0:
        return (0.2, 0.12, 0.07)
    ring = v * 5 + 0.6 * math.sin(TAU * (u + 0.21 * board)) + 0.25 * math.sin(TAU * 3 * u)
    shade = [0.0, 0.03, 0.07, 0.1, 0.05, 0.02][int(ring * 3) % 6] + 0.03 * (board % 3)
    return (0.62 - shade, 0.42 - shade, 0.25 - 0.7 * shade)


def bricks(x, y):
    """Heights of bricks with rounded edges; the mortar is the lowest."""
    row = y // 16
    across, down = (x + 16 * (row % 2)) % 32, y % 16
    edge = min(across, 31 - across, down, 15 - down)
    return (min(edge / 3, 1) ** 0.5,)


def dusk(path, width=128, height=64):
    """All directions at dusk: a blue sky, an orange horizon, a low sun to the left, dark ground."""
    def radiance(x, y):
        elevation = math.pi * (0.5 - (y + 0.5) / height)
        azimuth = TAU * ((x + 0.5) / width - 0.5)
        if elevation < 0:
            return (0.06, 0.05, 0.05)
        up = math.sin(elevation)
        glow = math.exp(-5 * up)
        cos = math.cos(elevation) * math.cos(azimuth + 1.2) * math.cos(0.16)
        cos += math.sin(elevation) * math.sin(0.16)
        halo = math.exp(-(1 - cos) * 12) * 1.5 + (60 if cos > 0.996 else 0)
        return (
            0.14 + 0.75 * glow + halo,
            0.2 + 0.3 * glow + 0.55 * halo,
            0.42 + 0.05 * glow + 0.22 * halo,
        )

    with open(path, "wb") as file:
        file.write(f"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y {height} +X {width}\n".encode())
        for y in range(height):
            for x in range(width):
                colour = radiance(x, y)
                fraction, exponent = math.frexp(max(colour))
                scale = fraction * 256 / max(colour)
                file.write(bytes([*(int(c * scale) for c in colour), exponent + 128]))


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def unit(a):
    length = math.sqrt(sum(x * x for x in a))
    return tuple(x / length for x in a)


def ply(path, corners, faces):
    """A mesh of triangles as binary PLY; corners are positions, or positions with normals."""
    names = ("x", "y", "z", "nx", "ny", "nz")[: len(corners[0])]
    head = ["ply", "format binary_little_endian 1.0", f"element vertex {len(corners)}"]
    head += [f"property float {name}" for name in names]
    head += [f"element face {len(faces)}", "property list uchar ushort vertex_indices"]
    with open(path, "wb") as file:
        file.write("\n".join([*head, "end_header", ""]).encode())
        file.write(b"".join(struct.pack(f"<{len(names)}f", *corner) for corner in corners))
        file.write(b"".join(struct.pack("<B3H", 3, *face) for face in faces))


def knot(path, along=120, around=12, thickness=0.34):
    """A trefoil knot with normals, as binary PLY."""
    def centre(t):
        radius = 1 + 0.45 * math.cos(3 * t)
        return (radius * math.cos(2 * t), radius * math.sin(2 * t), 0.55 * math.sin(3 * t))

    corners, faces = [], []
    for i in range(along):
        t = TAU * i / along
        here, there = centre(t), centre(t + 1e-4)
        tangent = unit([b - a for a, b in zip(here, there)])
        side = unit(cross(tangent, here))
        other = cross(side, tangent)
        for j in range(around):
            c, s = math.cos(TAU * j / around), math.sin(TAU * j / around)
            normal = [c * a + s * b for a, b in zip(side, other)]
            corners.append([p + thickness * n for p, n in zip(here, normal)] + normal)
            a, b = i * around + j, i * around + (j + 1) % around
            c, d = [(k + around) % (along * around) for k in (a, b)]
            faces += [(a, d, b), (a, c, d)]
    ply(path, corners, faces)


def chessman(path, outline, around, battlements=0):
    """A chess piece: a smooth outline of (radius, height) turned about y, as binary PLY with
    normals. With battlements the rim of the crown has that many notches."""
    points = [outline[0], *outline, outline[-1]]
    rings = []
    for a, b, c, d in zip(points, points[1:], points[2:], points[3:]):
        for t in (0, 0.5):
            weights = (-t + 2 * t**2 - t**3, 2 - 5 * t**2 + 3 * t**3, t + 4 * t**2 - 3 * t**3)
            weights += (t**3 - t**2,)
            point = [sum(w * p[i] for w, p in zip(weights, (a, b, c, d))) / 2 for i in (0, 1)]
            rings.append((max(point[0], 0), point[1]))
    rings.append(outline[-1])

    def place(i, j):
        (radius, height), angle = rings[i], TAU * j / around
        if battlements:
            rim = max(0, 1 - abs(height - 1.82) / 0.16) * max(0, min(1, (radius - 0.2) / 0.08))
            height -= 0.09 * rim * (0.5 - 0.5 * math.cos(battlements * angle)) ** 2
        return (radius * math.cos(angle), height, radius * math.sin(angle))

    corners, faces = [], []
    for i in range(len(rings)):
        low, high = max(i - 1, 0), min(i + 1, len(rings) - 1)
        for j in range(around):
            up = [b - a for a, b in zip(place(low, j), place(high, j))]
            onward = [b - a for a, b in zip(place(i, j - 1), place(i, j + 1))]
            is_pole = rings[i][0] < 1e-6
            normal = (0, 1 if i else -1, 0) if is_pole else unit(cross(up, onward))
            corners.append((*place(i, j), *normal))
            if high > i:
                a, b = i * around + j, i * around + (j + 1) % around
                c, d = a + around, b + around
                faces += [] if is_pole else [(a, d, b)]
                faces += [] if high == len(rings) - 1 else [(a, c, d)]
    ply(path, corners, faces)


QUEEN = [
    (0, 0), (0.46, 0), (0.52, 0.03), (0.53, 0.09), (0.50, 0.15), (0.44, 0.18), (0.425, 0.21),
    (0.445, 0.25), (0.42, 0.31), (0.34, 0.37), (0.27, 0.46), (0.22, 0.60), (0.185, 0.80),
    (0.165, 1.00), (0.158, 1.16), (0.17, 1.25), (0.26, 1.275), (0.285, 1.305), (0.26, 1.335),
    (0.185, 1.355), (0.215, 1.385), (0.228, 1.41), (0.21, 1.435), (0.17, 1.46), (0.185, 1.54),
    (0.225, 1.65), (0.285, 1.77), (0.315, 1.82), (0.295, 1.838), (0.255, 1.815), (0.18, 1.83),
    (0.10, 1.86), (0.055, 1.885), (0.082, 1.915), (0.095, 1.955), (0.082, 1.998), (0.048, 2.028),
    (0, 2.04)]
PAWN = [
    (0, 0), (0.36, 0), (0.41, 0.03), (0.415, 0.08), (0.39, 0.13), (0.335, 0.155), (0.325, 0.18),
    (0.335, 0.21), (0.305, 0.26), (0.235, 0.33), (0.185, 0.43), (0.155, 0.55), (0.145, 0.65),
    (0.16, 0.70), (0.235, 0.72), (0.255, 0.745), (0.225, 0.775), (0.15, 0.80), (0.20, 0.84),
    (0.245, 0.92), (0.25, 0.99), (0.225, 1.07), (0.165, 1.135), (0.085, 1.175), (0, 1.185)]


def stone(path, around=16):
    """A cut stone with its tip on the ground: flat faces, as binary PLY."""
    rings = [(0.72, 0.55, 0), (0.72, 0.62, 0), (0.58, 0.76, 0.5), (0.36, 0.85, 0)]
    corners = [(0, 0, 0)]
    for radius, height, shift in rings:
        for j in range(around):
            angle = TAU * (j + shift) / around
            corners.append((radius * math.cos(angle), height, radius * math.sin(angle)))
    faces = []
    for j in range(around):
        k = (j + 1) % around
        faces.append((0, 1 + j, 1 + k))
        for i in range(len(rings) - 1):
            low, high = 1 + i * around, 1 + (i + 1) * around
            if rings[i + 1][2] > rings[i][2]:
                faces += [(low + j, high + j, low + k), (low + k, high + j, high + k)]
            else:
                faces += [(low + j, high + k, low + k), (low + j, high + j, high + k)]
    lid = 1 + (len(rings) - 1) * around
    faces += [(lid, lid + j + 1, lid + j) for j in range(1, around - 1)]
    ply(path, corners, faces)


def turned(profile, around=36):
    """A surface of revolution about y: positions, normals and indices."""
    positions, normals, indices = [], [], []
    for i, (radius, height) in enumerate(profile):
        (r0, h0), (r1, h1) = profile[max(i - 1, 0)], profile[min(i + 1, len(profile) - 1)]
        out, up = unit((h1 - h0, r0 - r1))
        for j in range(around):
            c, s = math.cos(TAU * j / around), math.sin(TAU * j / around)
            positions.append((radius * c, height, radius * s))
            normals.append((out * c, up, out * s))
            if i + 1 < len(profile):
                a, b = i * around + j, i * around + (j + 1) % around
                indices += [a, a + around, b, b, a + around, b + around]
    return positions, normals, indices


def top(path):
    """A spinning top: a body in three variants, a stem, two animations and two cameras."""
    body = [(0.001, 0), (0.03, 0.02), (0.05, 0.06), (0.12, 0.14), (0.3, 0.3), (0.46, 0.47)]
    body += [(0.53, 0.58), (0.55, 0.65), (0.52, 0.72), (0.42, 0.78), (0.25, 0.83), (0.1, 0.86)]
    stem = [(0.1, 0.85), (0.075, 0.88), (0.06, 0.95), (0.055, 1.15), (0.075, 1.22)]
    stem += [(0.085, 1.27), (0.07, 1.32), (0.03, 1.345), (0.001, 1.35)]
    data, views, accessors = bytearray(), [], []

    def accessor(values, kind, form, component, target=None):
        view = {"buffer": 0, "byteOffset": len(data)}
        flat = [x for value in values for x in (value if isinstance(value, tuple) else (value,))]
        data.extend(struct.pack(f"<{len(flat)}{form}", *flat))
        view["byteLength"] = len(data) - view["byteOffset"]
        data.extend(bytes(-len(data) % 4))
        if target:
            view["target"] = target
        views.append(view)
        entry = {"bufferView": len(views) - 1, "componentType": component}
        entry |= {"count": len(values), "type": kind}
        if kind == "VEC3" or kind == "SCALAR" and form == "f":
            rows = [v if isinstance(v, tuple) else (v,) for v in values]
            numbers = [struct.unpack(f"<{len(r)}f", struct.pack(f"<{len(r)}f", *r)) for r in rows]
            entry["min"] = [min(column) for column in zip(*numbers)]
            entry["max"] = [max(column) for column in zip(*numbers)]
        accessors.append(entry)
        return len(accessors) - 1

    def primitive(profile, material):
        positions, normals, indices = turned(profile)
        return {
            "attributes": {
                "POSITION": accessor(positions, "VEC3", "f", 5126, 34962),
                "NORMAL": accessor(normals, "VEC3", "f", 5126, 34962),
            },
            "indices": accessor(indices, "SCALAR", "H", 5123, 34963),
            "material": material,
        }

    def turn(axis, angle):
        s = math.sin(angle / 2)
        return (axis[0] * s, axis[1] * s, axis[2] * s, math.cos(angle / 2))

    def animation(name, times, turns):
        sampler = {"input": accessor(times, "SCALAR", "f", 5126)}
        sampler["output"] = accessor(turns, "VEC4", "f", 5126)
        channel = {"sampler": 0, "target": {"node": 0, "path": "rotation"}}
        return {"name": name, "samplers": [sampler], "channels": [channel]}

    def paint(name, colour):
        coat = {"KHR_materials_clearcoat": {"clearcoatFactor": 1, "clearcoatRoughnessFactor": 0.05}}
        rough = {"baseColorFactor": [*colour, 1], "metallicFactor": 0, "roughnessFactor": 0.5}
        return {"name": name, "pbrMetallicRoughness": rough, "extensions": coat}

    brass = {"baseColorFactor": [0.88, 0.68, 0.32, 1], "metallicFactor": 1, "roughnessFactor": 0.22}
    painted = primitive(body, 0)
    mappings = [{"material": m, "variants": [v]} for v, m in enumerate((0, 1, 2))]
    painted["extensions"] = {"KHR_materials_variants": {"mappings": mappings}}
    circle = [(math.cos(TAU * i / 8), 0, math.sin(TAU * i / 8)) for i in range(9)]
    views_of = [("front", [0, 0.72, 3.2], [0, 0, 0, 1])]
    views_of += [("above", [0, 3.4, 0.0], list(turn((1, 0, 0), -TAU / 4)))]
    gltf = {
        "asset": {"version": "2.0", "generator": "docs/book/scenes/make.py"},
        "extensionsUsed": ["KHR_materials_clearcoat", "KHR_materials_variants"],
        "extensions": {"KHR_materials_variants": {
            "variants": [{"name": name} for name in ("red", "blue", "brass")]}},
        "scene": 0,
        "scenes": [{"nodes": [0, 1, 2]}],
        "nodes": [{"name": "top", "mesh": 0}] + [
            {"name": name, "camera": i, "translation": place, "rotation": turned_by}
            for i, (name, place, turned_by) in enumerate(views_of)],
        "cameras": [
            {"name": name, "type": "perspective", "perspective": {"yfov": 0.6, "znear": 0.1}}
            for name, _, _ in views_of],
        "meshes": [{"name": "top", "primitives": [painted, primitive(stem, 2)]}],
        "materials": [
            paint("red paint", (0.7, 0.04, 0.03)), paint("blue paint", (0.03, 0.12, 0.5)),
            {"name": "brass", "pbrMetallicRoughness": brass}],
        "animations": [
            animation("wobble", [i / 8 for i in range(9)], [turn(axis, 0.35) for axis in circle]),
            animation("fall", [0.0, 1.0], [turn((0, 0, 1), 0), turn((0, 0, 1), -0.98)])],
    }
    gltf |= {"bufferViews": views, "accessors": accessors, "buffers": [{"byteLength": len(data)}]}
    text = json.dumps(gltf, separators=(",", ":")).encode()
    text += b" " * (-len(text) % 4)
    size = 12 + 8 + len(text) + 8 + len(data)
    with open(path, "wb") as file:
        file.write(struct.pack("<4sII", b"glTF", 2, size))
        file.write(struct.pack("<I4s", len(text), b"JSON") + text)
        file.write(struct.pack("<I4s", len(data), b"BIN\0") + data)


png("planet.png", 512, 256, planet)
png("wood.png", 128, 128, wood)
png("bricks.png", 128, 64, bricks, channels=1)
dusk("dusk.hdr")
knot("knot.ply")
stone("stone.ply")
chessman("queen.ply", QUEEN, 54, battlements=9)
chessman("pawn.ply", PAWN, 40)
top("top.glb")
