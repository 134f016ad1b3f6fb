"""What the tests share: a scene of one ball, and the folder of the project's scenes."""

from pathlib import Path

import pytest

BALL = """\
Camera: {eye: [0, 0, 9], center: [0, 0, 0], up: [0, 1, 0], viewSize: [32, 24], fov: 30}
Lights:
- {position: [5, 5, 9], color: [1, 1, 1]}
Objects:
- type: sphere
  position: [0, 0, 0]
  radius: 1
  material: {color: [1, 0.2, 0.1], ka: 0.2, kd: 0.8, ks: 0, n: 1}
"""


@pytest.fixture
def ball():
    return BALL


@pytest.fixture
def scenes():
    return Path(__file__).parents[3] / "scenes"
