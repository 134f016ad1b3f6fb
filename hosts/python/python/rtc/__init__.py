"""Scenes checked and rendered on the CPU, the same bytes every time.

>>> import rtc
>>> scene = rtc.load("scene.yaml")
>>> for finding in scene.check():
...     print(finding)
>>> image = scene.render(size=(320, 240))
>>> image.array.shape
(240, 320, 3)
>>> image.save("scene.png")
"""

from __future__ import annotations

import sys

from . import _rtc
from ._builder import (
    Camera, Light, Material, Object, Phong, SceneBuilder, Shape, Standard, cone, cylinder, disc, ellipsoid, plain, plane,
    point, quad, sphere, spot, sun, torus, triangle,
)
from ._meshes import from_trimesh, mesh
from ._pictures import Difference, Image, diff
from ._scenes import Finding, Rows, Scene, SceneError, load

__version__ = _rtc.__version__
__all__ = [
    "Camera", "Difference", "Finding", "Image", "Light", "Material", "Object", "Phong", "Rows", "Scene", "SceneBuilder",
    "SceneError", "Shape", "Standard", "cone", "cylinder", "diff", "disc", "ellipsoid", "from_trimesh", "load", "main",
    "mesh", "plain", "plane", "point", "quad", "sphere", "spot", "sun", "torus", "triangle",
]


def main() -> None:
    """The command line `rtc`: its exit code ends the program."""
    sys.exit(_rtc.command(["rtc", *sys.argv[1:]]))
