#!/usr/bin/env python3
"""Makes the binary seeds: pictures of 6 by 5 pixels in many forms, and folders that hold some of them.

Needs Pillow, numpy and OpenEXR; `ktx2.mjs` makes those in KTX2. The seeds are in the repository, so only who wants others runs it.
"""

import io
import struct
import tempfile
import zlib
from pathlib import Path

import numpy
import OpenEXR
from PIL import Image, ImageCms, PngImagePlugin

CORPUS = Path(__file__).parent / "corpus"
WIDTH, HEIGHT = 6, 5
LIGHT = numpy.array([[[x / 4, y / 2, 1.5] for x in range(WIDTH)] for y in range(HEIGHT)], dtype=numpy.float32)
BYTES = (numpy.clip(LIGHT, 0, 1) * 255).astype(numpy.uint8)
COLOR = Image.fromarray(BYTES, "RGB")


def pixels():
    """Each form of texture, as Pillow writes it."""
    alpha = COLOR.copy()
    alpha.putalpha(Image.fromarray(BYTES[:, :, 0]))
    grey, bilevel = COLOR.convert("L"), COLOR.convert("1")
    profile = ImageCms.ImageCmsProfile(ImageCms.createProfile("sRGB")).tobytes()
    deep = Image.fromarray((LIGHT[:, :, 0] * 30000).astype(numpy.uint16))
    text = PngImagePlugin.PngInfo()
    text.add_text("Comment", "a seed", zip=True)
    text.add_itxt("Title", "ǌ é \" '")
    yield "color.png", COLOR, {"pnginfo": text}
    yield "alpha.png", alpha, {}
    yield "grey.png", grey, {"transparency": 7}
    yield "deep.png", deep, {}
    yield "palette.png", COLOR.convert("P", palette=Image.Palette.ADAPTIVE, colors=5), {"transparency": 2}
    yield "bilevel.png", bilevel, {}
    yield "profile.png", COLOR, {"icc_profile": profile[:132]}
    yield "moving.png", COLOR, {"save_all": True, "append_images": [COLOR.rotate(180)]}
    yield "color.jpg", COLOR, {"quality": 80}
    yield "progressive.jpg", COLOR, {"progressive": True, "quality": 60, "subsampling": 2}
    yield "grey.jpg", grey, {"restart_marker_rows": 1, "comment": "a seed"}
    yield "cmyk.jpg", COLOR.convert("CMYK"), {}
    yield "lossy.webp", COLOR, {"quality": 50}
    yield "lossless.webp", COLOR, {"lossless": True}
    yield "alpha.webp", alpha, {"quality": 50, "alpha_quality": 30}
    yield "moving.webp", alpha, {"save_all": True, "append_images": [alpha.rotate(180)], "lossless": True}


def interlaced():
    """A PNG in the seven passes of Adam7, which Pillow does not write."""
    rows = b""
    for x, y, across, down in [(0, 0, 8, 8), (4, 0, 8, 8), (0, 4, 4, 8), (2, 0, 4, 4), (0, 2, 2, 4), (1, 0, 2, 2), (0, 1, 1, 2)]:
        part = BYTES[y::down, x::across]
        rows += b"".join(b"\0" + row.tobytes() for row in part if part.shape[1])
    chunks = [(b"IHDR", struct.pack(">2I5B", WIDTH, HEIGHT, 8, 2, 0, 0, 1)), (b"IDAT", zlib.compress(rows)), (b"IEND", b"")]
    coded = (struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data)) for kind, data in chunks)
    return b"\x89PNG\r\n\x1a\n" + b"".join(coded)


def rgbe(color):
    """Four bytes of a Radiance HDR."""
    fraction, exponent = numpy.frexp(max(color))
    return bytes([int(channel * fraction * 256 / max(color)) for channel in color] + [int(exponent) + 128])


def hdr(runs, wide):
    """A Radiance HDR, flat or in runs; only rows of 8 pixels or more can be in runs."""
    rows = numpy.concatenate([LIGHT, LIGHT], axis=1) if wide else LIGHT
    head = f"#?RADIANCE\nEXPOSURE=1.0\nFORMAT=32-bit_rle_rgbe\n\n-Y {rows.shape[0]} +X {rows.shape[1]}\n".encode()
    body = b""
    for row in rows:
        row = [rgbe([float(channel) + 1e-3 for channel in color]) for color in row]
        if runs:
            body += struct.pack(">2BH", 2, 2, len(row))
            body += b"".join(bytes([len(row)]) + bytes(pixel[k] for pixel in row) for k in range(3))
            body += bytes([128 + len(row), row[0][3]])
        else:
            body += b"".join(row)
    return head + body


def exr(compression, kind, tiles):
    """An OpenEXR; its library writes no memory, so by way of a file."""
    header = {"compression": compression, "type": OpenEXR.tiledimage if tiles else OpenEXR.scanlineimage}
    if tiles:
        header["tiles"] = OpenEXR.TileDescription()
        header["tiles"].xSize = header["tiles"].ySize = 4
    with tempfile.NamedTemporaryFile(suffix=".exr") as file:
        OpenEXR.File(header, {"RGB": LIGHT.astype(kind)}).write(file.name)
        return file.read()


def write(target, name, data):
    folder = CORPUS / target
    folder.mkdir(parents=True, exist_ok=True)
    (folder / name).write_bytes(data)


def folder(name, *files):
    """A folder as `fuzz/src/lib.rs` cuts it."""
    parts = [data if index == 0 and path is None else b"== " + path.encode() + b"\n" + data for index, (path, data) in enumerate(files)]
    write("folder", name, b"\n".join(parts))


def main():
    made = {"interlaced.png": interlaced()}
    for name, picture, options in pixels():
        data = io.BytesIO()
        picture.save(data, Path(name).suffix[1:].replace("jpg", "jpeg"), **options)
        made[name] = data.getvalue()
    for name, runs, wide in [("flat.hdr", False, False), ("runs.hdr", True, True)]:
        made[name] = hdr(runs, wide)
    half, single = numpy.float16, numpy.float32
    for name, compression, kind, tiles in [
        ("plain.exr", OpenEXR.NO_COMPRESSION, single, False),
        ("runs.exr", OpenEXR.RLE_COMPRESSION, half, False),
        ("zip.exr", OpenEXR.ZIP_COMPRESSION, half, False),
        ("zips-tiles.exr", OpenEXR.ZIPS_COMPRESSION, single, True),
        ("piz.exr", OpenEXR.PIZ_COMPRESSION, half, False),
        ("pxr24.exr", OpenEXR.PXR24_COMPRESSION, single, False),
        ("b44.exr", OpenEXR.B44_COMPRESSION, half, False),
    ]:
        made[name] = exr(compression, kind, tiles)
    for name, data in made.items():
        write("image", name, data)
    folders(made)


def folders(made):
    camera = b"Camera: {eye: [0, 1, 4], center: [0, 0, 0], up: [0, 1, 0], fov: 50, viewSize: [8, 6]}\n"
    matt = b"ka: 0.1, kd: 0.7, ks: 0.2, n: 8"
    mesh = b"v -1 -1 0\nv 1 -1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt .5 1\nvn 0 0 1\nf 1/1/1 2/2/1 3/3/1\n"
    off = b"OFF\n4 2 0\n-1 -1 0\n1 -1 0\n1 1 0\n-1 1 0\n3 0 1 2\n3 0 2 3\n"
    sphere = b"- {type: sphere, position: [0, 0, 0], radius: 1, material: {texture: "
    folder(
        "textures-and-meshes",
        (None, camera + b"Shadows: true\nLights:\n- {position: [5, 5, 5], color: [1, 1, 1]}\nObjects:\n" + sphere + b"a.png, bump: h.webp, "
         + matt + b"}}\n- {type: mesh, file: t.obj, material: {texture: c.jpg, " + matt + b"}}\n- {type: mesh, file: q, scale: 2}\n"),
        ("a.png", made["alpha.png"]),
        ("h.webp", made["lossless.webp"]),
        ("c.jpg", made["grey.jpg"]),
        ("t.obj", mesh),
        ("q.off", off),
    )
    folder(
        "paths-sun-environment",
        (None, camera + b"RenderMode: path\nMaxRecursionDepth: 3\nLights:\n- {type: sun, direction: [0, 1, 1], irradiance: 3}\nEnvironment:\n"
         b"  color: [1, 0.5, 2]\n  file: sky/e.hdr\n  rotation: [0, 1.5, 0]\nObjects:\n" + sphere + b"'\xc3\xa9 \xc7\x8c.png', " + matt + b"}}\n"),
        ("sky/e.hdr", made["runs.hdr"]),
        ("é ǌ.png", made["palette.png"]),
    )
    folder(
        "another-environment-from-above",
        ("../own/s.yaml", camera + b"Environment: {file: e.exr}\nObjects:\n" + sphere + b"\"T.PNG\", " + matt + b"}}\n"),
        ("../e.exr", made["zip.exr"]),
        ("../own/t.png", made["bilevel.png"]),
    )
    folder(
        "block-scalars",
        (None, camera + b"Objects:\n- type: mesh\n  file: >-\n    t.obj\n- type: mesh\n  file: |\n    \xc3\xa9.obj\n  material: {texture: \"\\u00e9.png\", "
         + matt + b"}\n- type: sphere\n  position: [0, 0, 0]\n  radius: 1\n  material:\n    texture: |2-\n      a.png\n    ka: 1\n    kd: 0\n    ks: 0\n    n: 1"),
        ("t.obj", mesh.replace(b"3/3/1", b"9/3/1")),
        ("é.obj", b"# \xc7\x8c\n" + mesh.replace(b"vn 0 0 1", b"vn 0 0 \xc3\xa9")),
        ("a.png", made["color.png"][:60]),
    )
    gltf = (
        b'{"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0,"name":"\xc3\xa9"}],"buffers":[{"uri":"b.bin",'
        b'"byteLength":72}],"bufferViews":[{"buffer":0,"byteLength":72}],"accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":'
        b'"VEC3","min":[-1,-1,0],"max":[1,1,0]},{"bufferView":0,"byteOffset":36,"componentType":5126,"count":3,"type":"VEC3"}],"images":['
        b'{"uri":"p%20q.png"}],"textures":[{"source":0}],"materials":[{"pbrMetallicRoughness":{"baseColorTexture":{"index":0}}}],"meshes":'
        b'[{"primitives":[{"attributes":{"POSITION":0,"NORMAL":1,"TEXCOORD_0":1},"material":0}]}]}'
    )
    floats = struct.pack("<18f", -1, -1, 0, 1, -1, 0, 0, 1, 0, *[0, 0, 1] * 3)
    asset = [("b.bin", floats), ("p q.png", made["color.png"])]
    folder("gltf", ("a.gltf", gltf), *asset)
    placed = camera + b"Lights:\n- {type: sun, direction: [0, 0, 1], irradiance: [1, 2, 3]}\nObjects:\n- {type: gltf, file: g/a.gltf, scale: 2}\n"
    folder("gltf-in-a-scene", (None, placed + b"- &a {type: gltf, file: ./g/a.gltf, rotation: [1, 0, 0]}\n- *a\n"), ("g/a.gltf", gltf),
           *[("g/" + name, data) for name, data in asset])
    folder("missing", (None, camera + b"Objects:\n- {type: mesh, file: C:\\\\x\\\\T.obj}\n- {type: mesh, file: /etc/t}\n- {type: mesh, file: ../../t.obj}\n"
           b"- {type: gltf, file: no.glb}\n" + sphere + b"' t.png ', " + matt + b"}}\n"), ("t.obj", mesh), ("../t.png", made["grey.png"]))


main()
