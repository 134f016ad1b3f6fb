"""Textures, meshes and skies that the scenes of tests/render name."""
import math
import struct
import zlib


def png(width, height, pixel):
    """A PNG of pixels (r, g, b) or (r, g, b, a), row 0 on top."""
    rows = [[pixel(x, y) for x in range(width)] for y in range(height)]
    raw = b"".join(b"\0" + bytes(v for p in row for v in p) for row in rows)
    kind = 6 if len(rows[0][0]) == 4 else 2

    def chunk(name, body):
        return struct.pack(">I", len(body)) + name + body + struct.pack(">I", zlib.crc32(name + body))

    header = struct.pack(">IIBBBBB", width, height, 8, kind, 0, 0, 0)
    # Stored, not deflated: the bytes are those of every version of zlib.
    body = b"\x78\x01"
    for at in range(0, len(raw), 65535):
        part = raw[at:at + 65535]
        last = at + 65535 >= len(raw)
        body += struct.pack("<BHH", last, len(part), len(part) ^ 0xFFFF) + part
    body += struct.pack(">I", zlib.adler32(raw))
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", body) + chunk(b"IEND", b"")


F = ["#####", "#....", "####.", "#....", "#....", "#...."]


def letters(x, y):
    """An F of 16 x 16 texels on four colours: shows each way to turn or to mirror a picture."""
    ground = [(230, 90, 60), (240, 200, 70), (70, 160, 90), (70, 110, 210)][(x >= 8) + 2 * (y >= 8)]
    row, column = y - 5, x - 5
    inside = 0 <= row < 6 and 0 <= column < 5 and F[row][column] == "#"
    return (20, 20, 30) if inside else ground


def checker(x, y):
    return (240, 230, 210) if (x + y) % 2 else (40, 50, 90)


def dots(x, y):
    """A bright round dot in each square of 8 x 8 texels."""
    d = math.hypot(x % 8 - 3.5, y % 8 - 3.5)
    v = round(255 * min(max((4 - d) / 2.5, 0), 1))
    return (v, v, v)


def pyramids(x, y):
    """Normals of pyramids of 8 x 8 texels: right is red, up is green."""
    u, v = x % 8 - 3.5, 3.5 - y % 8
    n = (0.6 if u > 0 else -0.6, 0, 0.8) if abs(u) > abs(v) else (0, 0.6 if v > 0 else -0.6, 0.8)
    return tuple(round(127.5 * (c + 1)) for c in n)


def holes(x, y):
    """Opaque outside a disc, and half opaque in its middle."""
    d = math.hypot(x - 7.5, y - 7.5)
    alpha = 255 if d > 6 else 0 if d > 3 else 128
    return letters(x, y) + (alpha,)


def parts(x, y):
    """Roughness in green from left to right, metal in blue in the upper half."""
    return (0, 17 * x, 255 if y < 8 else 0)


def hdr(width, height, radiance):
    """A Radiance picture, not compressed."""
    def pixel(x, y):
        color = radiance((x + 0.5) / width, (y + 0.5) / height)
        mantissa, exponent = math.frexp(max(color))
        scale = mantissa * 256 / max(color)
        return bytes([int(c * scale) for c in color] + [exponent + 128])
    head = f"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y {height} +X {width}\n".encode()
    return head + b"".join(pixel(x, y) for y in range(height) for x in range(width))


def sky(u, v):
    """A sky over a ground, with a white window behind the eye, a red one to its right, a green one to its left."""
    if 0.25 < v < 0.45 and 0.06 < u < 0.2:
        return (9, 9, 8.5)
    if 0.35 < v < 0.6 and 0.7 < u < 0.8:
        return (4, 0.4, 0.3)
    if 0.35 < v < 0.6 and 0.2 < u < 0.3:
        return (0.3, 2.5, 0.4)
    if v > 0.5:
        return (0.25, 0.2, 0.15)
    return (0.3 + 0.4 * v, 0.4 + 0.5 * v, 0.9)


def ball(around, rings):
    """Positions, uvs and triangles of a sphere whose poles are above and below."""
    corners, uvs, triangles = [], [], []
    for r in range(rings + 1):
        for a in range(around + 1):
            polar, angle = math.pi * r / rings, 2 * math.pi * a / around
            ring = math.sin(polar)
            corners.append((ring * math.sin(angle), math.cos(polar), ring * math.cos(angle)))
            uvs.append((a / around, r / rings))
    for r in range(rings):
        for a in range(around):
            p, q = r * (around + 1) + a, (r + 1) * (around + 1) + a
            if r > 0:
                triangles.append((p, q, p + 1))
            if r < rings - 1:
                triangles.append((p + 1, q, q + 1))
    return corners, uvs, triangles


def obj():
    corners, uvs, triangles = ball(12, 6)
    lines = ["# A ball of 120 faces with the normals and texture coordinates of a sphere: tests/render/make"]
    for name, rows in (("v", corners), ("vn", corners), ("vt", [(u, 1 - v) for u, v in uvs])):
        lines += [name + "".join(f" {round(c, 5) + 0.0:.5f}" for c in row) for row in rows]
    lines += ["f" + "".join(f" {k + 1}/{k + 1}/{k + 1}" for k in face) for face in triangles]
    return "\n".join(lines).encode() + b"\n"


OFF = b"""OFF
# An octahedron: tests/render/make
6 8 0
1 0 0
-1 0 0
0 1 0
0 -1 0
0 0 1
0 0 -1
3 0 2 4
3 2 1 4
3 1 3 4
3 3 0 4
3 2 0 5
3 1 2 5
3 3 1 5
3 0 3 5
"""


def washer():
    """A lamp on a ceiling that lights a wall on the side of its horizontal angle 0, and a little of the floor."""
    vertical, horizontal = range(0, 91, 10), range(0, 181, 45)
    rows = []
    for around in horizontal:
        side = (1 + math.cos(math.radians(around))) / 2
        lobe = [max(0, math.cos(math.radians(3 * (angle - 50)))) for angle in vertical]
        rows.append([120 * side**2 * (l if abs(a - 50) < 30 else 0) + 12 * math.cos(math.radians(a))
                     for a, l in zip(vertical, lobe)])
    lines = ["IESNA:LM-63-2002", "[TEST] made up by tests/render/make", "[MANUFAC] none", "TILT=NONE",
             f"1 1000 1 {len(vertical)} {len(horizontal)} 1 2 0 0 0", "1 1 10",
             " ".join(map(str, vertical)), " ".join(map(str, horizontal))]
    lines += [" ".join(f"{round(value, 1) + 0.0:.1f}" for value in row) for row in rows]
    return "\r\n".join(lines).encode() + b"\r\n"


FILES = {
    "letters.png": (lambda: png(16, 16, letters), ["texture", "material", "aov"]),
    "checker.png": (lambda: png(32, 32, checker), ["camera"]),
    "dots.png": (lambda: png(64, 32, dots), ["texture"]),
    "pyramids.png": (lambda: png(64, 32, pyramids), ["texture", "mode"]),
    "sky.hdr": (lambda: hdr(32, 16, sky), ["light", "alpha", "layer"]),
    "ball.obj": (obj, ["shape", "texture"]),
    "washer.ies": (washer, ["light"]),
    "octahedron.off": (lambda: OFF, ["shape"]),
}
