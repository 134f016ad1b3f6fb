"""Meshes of numpy and trimesh as scenes."""

import numpy as np
import pytest
import trimesh

import rtc

CORNERS = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]
FACES = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]]


def test_a_mesh_is_a_scene():
    image = rtc.mesh(CORNERS, FACES).render(size=32, spp=2, aovs=["instance"])
    assert image.stats["hits"] > 0
    assert image.aovs["instance"].max() >= 1


def test_colours_of_vertices_are_seen():
    red = rtc.mesh(CORNERS, FACES, colors=[[255, 0, 0]] * 4)
    same = rtc.mesh(CORNERS, FACES, colors=[[1.0, 0.0, 0.0]] * 4)
    picture = red.render(size=32, spp=4, aovs=["albedo"])
    albedo = picture.aovs["albedo"]
    assert (albedo[..., 0] > 0.9).any() and not (albedo[..., 1] > albedo[..., 0] + 0.01).any()
    assert (same.render(size=32, spp=4).array == picture.array).all()


def test_what_is_no_mesh_is_told():
    for vertices, faces, words in [
        ([[0, 0]], FACES, "n × 3"),
        (CORNERS, [[0, 1, 4]], "from 0 to 3"),
        (CORNERS, [[0.5, 1, 2]], "whole numbers"),
    ]:
        with pytest.raises(ValueError, match=words):
            rtc.mesh(vertices, faces)
    with pytest.raises(ValueError, match="one for each of the 4 vertices"):
        rtc.mesh(CORNERS, FACES, normals=np.zeros((3, 3)))


def test_trimesh_gives_meshes_and_scenes():
    ball = trimesh.creation.icosphere(subdivisions=2)
    assert rtc.from_trimesh(ball).render(size=16, spp=1).stats["hits"] > 0
    assert rtc.from_trimesh(trimesh.Scene(ball)).render(size=16, spp=1).stats["hits"] > 0
