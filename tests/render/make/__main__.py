#!/usr/bin/env python3
"""Writes the glTF cases of tests/render, and the textures, meshes and skies that its scenes name.

python3 tests/render/make    rewrites all of them, with the same bytes; it needs Python 3 alone. The pictures beside
the cases are written by `RTC_UPDATE=1 cargo test --test files render/`; look at them then.
"""
import sys
from pathlib import Path

sys.dont_write_bytecode = True

import layers  # noqa: E402, F401: its cases register themselves
import looks  # noqa: E402, F401
import scenes  # noqa: E402, F401
from asset import CASES, ball_file, glb, text  # noqa: E402
from files import FILES  # noqa: E402

HERE = Path(__file__).parent.parent


def write(path, data):
    path = HERE / path
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_bytes(data)


def main():
    for name, (made, nouns) in FILES.items():
        for noun in nouns:
            write(f"{noun}/files/{name}", made())
    write("layer/files/ball.bin", ball_file())
    for name, made in CASES.items():
        write(f"{name}.gltf", text(made()))
    # One asset twice: as a case of its own in binary form, and as one that a scene text places.
    asset = CASES["asset/hierarchy"]()
    write("asset/binary.glb", glb(asset))
    write("asset/files/cards.glb", glb(CASES["texture/vertex-colors"]()))


main()
