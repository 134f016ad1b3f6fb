"""Scenes from code, and scenes that are changed."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import rtc

CORNERS = np.array([[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]], np.float32)
FACES = np.array([[0, 1, 2], [0, 2, 3]])
UVS = np.array([[0, 1], [1, 1], [1, 0], [0, 0]])


def test_a_scene_from_code_is_that_of_its_text(ball):
    builder = rtc.SceneBuilder(rtc.Camera(eye=(0, 0, 9), up=(0, 1, 0), size=(32, 24), fov=30))
    builder.add(rtc.sphere((0, 0, 0), np.float32(1)), rtc.Phong(color=(1, 0.2, 0.1), ka=0.2, kd=0.8, ks=0, n=1), name="ball")
    builder.light(rtc.plain((5, 5, 9), 1))
    scene = builder.build()
    assert rtc.diff(scene.render(), rtc.load(ball).render()).max == 0
    [object] = scene.objects
    assert (object.name, object.kind, object.bounds.tolist()) == ("ball", "sphere", [[-1, -1, -1], [1, 1, 1]])
    with pytest.raises(ValueError, match="was built"):
        builder.light(rtc.plain((5, 5, 9), 1))


def test_meshes_are_placed_and_have_textures():
    pixels = np.zeros((2, 2, 3), np.uint8)
    pixels[0, 0] = [255, 0, 0]
    builder = rtc.SceneBuilder(rtc.Camera(eye=(0, 0, 4), size=(40, 40)))
    mesh = builder.mesh(CORNERS, FACES, uvs=UVS)
    picture = builder.texture(pixels)
    material = builder.material(rtc.Standard(base_color=(1, 1, 1), metallic=0, roughness=1, base_color_map=picture))
    builder.add(mesh, material)
    moved = np.eye(4)
    moved[:3, 3] = [0, 0, -3]
    builder.add(mesh, material, transform=moved)
    builder.environment(np.ones((4, 8, 3)))
    scene = builder.build()
    assert len(scene.objects) == 2 and scene.objects[1].bounds[0, 2] == -3
    albedo = scene.render(spp=4, aovs=["albedo"]).aovs["albedo"]
    # The first row of the picture is at the top of the mesh.
    assert albedo[13, 13, 0] > 0.9 and albedo[26, 26, 0] < 0.1 and albedo[26, 13, 0] < 0.1
    alone = rtc.mesh(CORNERS, FACES, uvs=UVS, material=rtc.Standard(base_color=(0, 0, 1), roughness=0.5))
    uv = alone.render(size=16, spp=1, aovs=["uv", "albedo"]).aovs
    assert uv["uv"][uv["albedo"][..., 2] > 0.5].max() > 0.8


def test_what_is_not_valid_raises_all_that_is_wrong():
    builder = rtc.SceneBuilder(rtc.Camera(eye=(0, 0, 4)))
    builder.add(rtc.sphere((0, 0, 0), -1), rtc.Standard(ior=-1.5))
    with pytest.raises(rtc.SceneError, match="objects") as raised:
        builder.build()
    paths = [finding.path for finding in raised.value.findings if finding.severity == "error"]
    assert paths == ["objects[0].radius", "objects[0].material.ior"] or set(paths) == {
        "objects[0].radius",
        "objects[0].material.ior",
    }
    with pytest.raises(AttributeError, match="no `colour`; it has .*base_color"):
        rtc.Standard(colour=(1, 0, 0))
    with pytest.raises(ValueError, match="three numbers"):
        rtc.sun((0, 1), 1)
    with pytest.raises(ValueError, match="4 × 4"):
        rtc.SceneBuilder(rtc.Camera(eye=(0, 0, 4))).add(0, rtc.Standard(), transform=np.eye(2))


def test_cameras_lights_and_materials_are_read_and_set(ball):
    scene = rtc.load(ball)
    before = scene.copy()
    assert scene.camera.eye == (0, 0, 9) and abs(scene.camera.fov - 30) < 1e-9 and scene.camera.size == (32, 24)
    scene.camera = replace(scene.camera, eye=(0, 9, 0.1))
    assert scene.camera.eye == (0, 9, 0.1)
    [light] = scene.lights
    assert (light.kind, light.position, light.intensity) == ("plain", (5, 5, 9), (1, 1, 1))
    scene.lights = [replace(light, intensity=(2, 2, 2)), rtc.plain((0, 9, 0), 0.1)]
    assert [light.intensity[0] for light in scene.lights] == [2, 0.1]
    [material] = scene.materials
    assert (material.kind, material.color, material.kd) == ("phong", [1, 0.2, 0.1], 0.8)
    material.color = np.array([0, 1, 0])
    assert scene.materials[0].color == [0, 1, 0]
    assert scene.render(size=8).array[4, 4, 1] > 0.5
    # The copy has none of it.
    assert before.lights == (light,) and rtc.diff(before.render(), rtc.load(ball).render()).max == 0


def test_what_would_not_be_valid_changes_nothing(ball):
    scene = rtc.load(ball)
    picture = scene.render()
    with pytest.raises(rtc.SceneError):
        scene.materials[0].ka = -1
    with pytest.raises(rtc.SceneError):
        scene.camera = replace(scene.camera, center=scene.camera.eye)
    with pytest.raises(ValueError, match="1 materials, not 0"):
        scene.materials = []
    assert rtc.diff(picture, scene.render()).max == 0


def test_a_spot_keeps_what_python_does_not_see():
    builder = rtc.SceneBuilder(rtc.Camera(eye=(0, 0, 4), size=(16, 16)))
    builder.add(rtc.plane((0, 0, 0), (0, 0, 1)), rtc.Standard())
    builder.light(rtc.spot((0, 0, 3), (0, 0, -1), (9, 9, 9), angles=(0.1, 0.2)))
    scene = builder.build()
    before = scene.render(spp=1)
    scene.lights = [*scene.lights]
    assert rtc.diff(before, scene.render(spp=1)).max == 0
    with pytest.raises(ValueError, match="angles"):
        scene.lights = [replace(scene.lights[0], position=(0, 1, 3))]


def test_a_sun_lights_the_side_that_its_direction_points_from():
    builder = rtc.SceneBuilder(rtc.Camera(eye=(0, 0, 6), size=(24, 24)))
    builder.add(rtc.sphere((0, 0, 0), 1), rtc.Standard(base_color=(1, 1, 1), metallic=0))
    builder.light(rtc.sun((0, 1, 0), (3, 3, 3)))
    rows = builder.build().render(spp=4).array.sum(axis=(1, 2))
    assert rows[:12].sum() > 20 * rows[12:].sum()


def test_the_scene_of_the_readme_is_lit_from_above():
    readme = Path(__file__).parent.parent / "README.md"
    block = next(block for block in readme.read_text().split("```python\n") if "rtc.sun(" in block)
    names = {
        "rtc": rtc,
        "vertices": np.array([[-3, -1, -3], [3, -1, -3], [3, -1, 3], [-3, -1, 3]], np.float32),
        "faces": np.array([[0, 2, 1], [0, 3, 2]]),
        "uvs": UVS,
        "pixels": np.full((2, 2, 3), 255, np.uint8),
        "matrix": np.eye(4),
        "radiance": (0.1, 0.1, 0.1),
    }
    exec(block.split("```")[0], names)
    image = names["image"]
    assert image.findings == [] and image.array.mean() > 0.1
    # The ball is brighter above its middle than below it.
    column = image.array[:, image.array.shape[1] // 2, 0]
    middle = len(column) // 2
    assert column[middle - 60 : middle].mean() > 1.2 * column[middle : middle + 60].mean()


def test_light_that_reaches_nothing_in_view_is_a_finding():
    builder = rtc.SceneBuilder(rtc.Camera(eye=(0, 0, 6), size=(24, 24)))
    builder.add(rtc.sphere((0, 0, 0), 1), rtc.Standard(base_color=(1, 1, 1), metallic=0))
    builder.light(rtc.sun((0, -1, -9), (3, 3, 3)))
    assert "RD018" in [found.code for found in builder.build().render(spp=1).findings]
