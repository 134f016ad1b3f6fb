"""Meshes of other programs as scenes: they become a PLY in memory."""

from __future__ import annotations

from typing import Any

import numpy as np

from ._scenes import Scene, load


def mesh(vertices: Any, faces: Any, *, normals: Any = None, colors: Any = None, **reading: Any) -> Scene:
    """A scene of one mesh, shown as `rtc render mesh.ply` shows it.

    `vertices` are n × 3 numbers, kept in double precision; `faces` m × 3 indices; `normals` n × 3; `colors`
    n × 3 or n × 4 in 8 bits, or from 0 to 1. `reading` is that of `load`.
    """
    vertices = np.asarray(vertices, np.float64)
    faces = np.asarray(faces)
    if vertices.ndim != 2 or vertices.shape[1] != 3:
        raise ValueError(f"vertices are n × 3 numbers, not {vertices.shape}")
    if faces.ndim != 2 or faces.shape[1] != 3 or not np.issubdtype(faces.dtype, np.integer):
        raise ValueError("faces are m × 3 whole numbers")
    if faces.size and (faces.min() < 0 or faces.max() >= len(vertices)):
        raise ValueError(f"faces name vertices from 0 to {len(vertices) - 1}")
    columns = [(name, "<f8", vertices[:, k]) for k, name in enumerate("xyz")]
    if normals is not None:
        normals = _per_vertex(normals, vertices, "normals")
        columns += [("n" + name, "<f8", normals[:, k]) for k, name in enumerate("xyz")]
    if colors is not None:
        colors = _bytes(_per_vertex(colors, vertices, "colors"))
        names = ["red", "green", "blue", "alpha"]
        columns += [(names[k], "u1", colors[:, k]) for k in range(colors.shape[1])]
    content = _ply(columns, faces.astype("<u4"))
    return load(content, name="mesh.ply", **reading)


def from_trimesh(shape: Any, **reading: Any) -> Scene:
    """A scene of a `trimesh.Trimesh`, with the colours of its vertices if it has some, or of a
    `trimesh.Scene`, with all its materials, as glTF."""
    if hasattr(shape, "geometry"):
        return load(shape.export(file_type="glb"), name="scene.glb", **reading)
    visual = getattr(shape, "visual", None)
    colors = visual.vertex_colors if getattr(visual, "kind", None) == "vertex" else None
    return mesh(shape.vertices, shape.faces, colors=colors, **reading)


def _per_vertex(values: Any, vertices: np.ndarray, name: str) -> np.ndarray:
    values = np.asarray(values)
    widths = (3, 4) if name == "colors" else (3,)
    if values.ndim != 2 or len(values) != len(vertices) or values.shape[1] not in widths:
        raise ValueError(f"{name} are one for each of the {len(vertices)} vertices, not {values.shape}")
    return values


def _bytes(colors: np.ndarray) -> np.ndarray:
    if np.issubdtype(colors.dtype, np.integer):
        return np.clip(colors, 0, 255).astype(np.uint8)
    return np.rint(np.clip(colors, 0.0, 1.0) * 255).astype(np.uint8)


def _ply(columns: list[tuple[str, str, np.ndarray]], faces: np.ndarray) -> bytes:
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
