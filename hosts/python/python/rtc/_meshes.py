"""Meshes of other programs as scenes."""

from __future__ import annotations

from typing import TYPE_CHECKING, List, Optional, Tuple, Union

import numpy as np
from numpy.typing import ArrayLike, NDArray

if TYPE_CHECKING:
    import trimesh

    from ._builder import Material
    from ._scenes import Scene


def mesh(
    vertices: ArrayLike,
    faces: ArrayLike,
    *,
    normals: Optional[ArrayLike] = None,
    uvs: Optional[ArrayLike] = None,
    colors: Optional[ArrayLike] = None,
    material: Optional[Material] = None,
) -> Scene:
    """A scene of one mesh; without lights of its own, it is rendered in the studio.

    `vertices` are n × 3 numbers, kept in double precision; `faces` m × 3 indices; `normals` n × 3; `uvs` n × 2;
    `colors` n × 3 or n × 4 in 8 bits, or from 0 to 1. `SceneBuilder` holds several meshes, lights and textures.
    """
    from ._scenes import load

    points = vertices_of(vertices)
    corners = faces_of(faces, len(points))
    columns: List[Tuple[str, str, np.ndarray]] = [(name, "<f8", points[:, k]) for k, name in enumerate("xyz")]
    if normals is not None:
        directions = per_vertex(normals, points, "normals", (3,))
        columns += [("n" + name, "<f8", directions[:, k]) for k, name in enumerate("xyz")]
    if uvs is not None:
        places = per_vertex(uvs, points, "uvs", (2,))
        columns += [(name, "<f8", places[:, k]) for k, name in enumerate("st")]
    if colors is not None:
        tints = _bytes(per_vertex(colors, points, "colors", (3, 4)))
        names = ["red", "green", "blue", "alpha"]
        columns += [(names[k], "u1", tints[:, k]) for k in range(tints.shape[1])]
    scene = load(_ply(columns, corners.astype("<u4")), name="mesh.ply")
    if material is not None:
        scene.materials = [material] * len(scene.materials)
    return scene


def from_trimesh(shape: Union[trimesh.Trimesh, trimesh.Scene], *, material: Optional[Material] = None) -> Scene:
    """A scene of a `trimesh.Trimesh`, with the colours of its vertices or its texture if it has one, or of a
    `trimesh.Scene`, with all its materials, as glTF. A `material` takes the place of all."""
    from ._scenes import load

    visual = getattr(shape, "visual", None)
    kind = getattr(visual, "kind", None)
    if hasattr(shape, "geometry") or kind == "texture":
        content = shape.export(file_type="glb")
        assert isinstance(content, bytes), "a .glb is bytes"
        scene = load(content, name="scene.glb")
        if material is not None:
            scene.materials = [material] * len(scene.materials)
        return scene
    colors = getattr(visual, "vertex_colors", None) if kind == "vertex" else None
    return mesh(shape.vertices, shape.faces, colors=colors, material=material)


def vertices_of(vertices: ArrayLike) -> NDArray[np.float64]:
    """n × 3 numbers."""
    points = np.asarray(vertices, np.float64)
    if points.ndim != 2 or points.shape[1] != 3:
        raise ValueError(f"vertices are n × 3 numbers, not {points.shape}")
    return points


def faces_of(faces: ArrayLike, count: int) -> NDArray[np.integer]:
    """m × 3 indices of so many vertices."""
    corners = np.asarray(faces)
    if corners.ndim != 2 or corners.shape[1] != 3 or not np.issubdtype(corners.dtype, np.integer):
        raise ValueError("faces are m × 3 whole numbers")
    if corners.size and (corners.min() < 0 or corners.max() >= count):
        raise ValueError(f"faces name vertices from 0 to {count - 1}")
    return corners


def per_vertex(values: ArrayLike, points: np.ndarray, name: str, widths: Tuple[int, ...]) -> np.ndarray:
    """One row of a width for each vertex."""
    rows = np.asarray(values)
    if rows.ndim != 2 or len(rows) != len(points) or rows.shape[1] not in widths:
        raise ValueError(f"{name} are one for each of the {len(points)} vertices, not {rows.shape}")
    return rows


def _bytes(colors: np.ndarray) -> NDArray[np.uint8]:
    is_whole = np.issubdtype(colors.dtype, np.integer)
    levels = np.clip(colors, 0, 255) if is_whole else np.rint(np.clip(colors, 0.0, 1.0) * 255)
    return np.asarray(levels, np.uint8)


def _ply(columns: List[Tuple[str, str, np.ndarray]], faces: np.ndarray) -> bytes:
    kinds = {"<f8": "double", "u1": "uchar"}
    count = len(columns[0][2])
    vertices = np.empty(count, [(name, kind) for name, kind, _ in columns])
    for name, _, values in columns:
        vertices[name] = values
    rows = np.empty(len(faces), [("count", "u1"), ("corners", "<u4", (3,))])
    rows["count"], rows["corners"] = 3, faces
    lines = ["ply", "format binary_little_endian 1.0", f"element vertex {count}"]
    lines += [f"property {kinds[kind]} {name}" for name, kind, _ in columns]
    lines += [f"element face {len(faces)}", "property list uchar uint vertex_indices", "end_header"]
    return "\n".join(lines).encode() + b"\n" + vertices.tobytes() + rows.tobytes()
