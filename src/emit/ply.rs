//! Writes meshes as PLY (Turk, "The PLY polygon file format", 1994), binary and little-endian: all
//! columns, without loss.
//!
//! Property names are those in common use. Where none is common, `s1 t1` are the second texture
//! coordinates, `tx ty tz tw` the tangent with its handedness, and `linear_red` to `linear_alpha`
//! the linear colour.

use rtc_ir::{Mesh, VertexColumn};
use std::fmt::Write as _;

/// The PLY file of a mesh.
pub(super) fn encode(mesh: &Mesh) -> Vec<u8> {
    let linear = ["linear_red", "linear_green", "linear_blue", "linear_alpha"];
    encode_with(mesh, &mesh.colors, linear)
}

/// The PLY file of a mesh, with other colours in place of its own, by their property names.
pub(super) fn encode_with<const N: usize>(
    mesh: &Mesh,
    colors: &VertexColumn<N>,
    color_names: [&str; N],
) -> Vec<u8> {
    let Mesh {
        name: _,
        part: _,
        positions,
        normals,
        uvs,
        second_uvs,
        tangents,
        colors: _,
        triangles,
    } = mesh;
    // Header.
    let count = positions.len();
    let mut head = format!("ply\nformat binary_little_endian 1.0\nelement vertex {count}\n");
    declare(positions, ["x", "y", "z"], &mut head);
    declare(normals, ["nx", "ny", "nz"], &mut head);
    declare(uvs, ["s", "t"], &mut head);
    declare(second_uvs, ["s1", "t1"], &mut head);
    declare(tangents, ["tx", "ty", "tz", "tw"], &mut head);
    declare(colors, color_names, &mut head);
    let faces = triangles.len();
    writeln!(
        head,
        "element face {faces}\nproperty list uchar uint vertex_indices\nend_header"
    )
    .expect("a string takes all that is written to it");
    let mut bytes = head.into_bytes();
    // Vertices.
    for vertex in 0..count {
        store(positions, vertex, &mut bytes);
        store(normals, vertex, &mut bytes);
        store(uvs, vertex, &mut bytes);
        store(second_uvs, vertex, &mut bytes);
        store(tangents, vertex, &mut bytes);
        store(colors, vertex, &mut bytes);
    }
    // Faces.
    for triangle in triangles.iter() {
        bytes.push(3);
        bytes.extend(triangle.iter().flat_map(|corner| corner.to_le_bytes()));
    }
    bytes
}

/// Declares the properties of a column, unless it is empty.
fn declare<const N: usize>(column: &VertexColumn<N>, names: [&str; N], head: &mut String) {
    let kind = match column {
        _ if column.is_empty() => return,
        VertexColumn::Single(_) => "float",
        VertexColumn::Double(_) => "double",
    };
    for name in names {
        writeln!(head, "property {kind} {name}").expect("a string takes all that is written to it");
    }
}

/// Writes the values of a vertex; skips an empty column.
fn store<const N: usize>(column: &VertexColumn<N>, vertex: usize, bytes: &mut Vec<u8>) {
    match column {
        VertexColumn::Single(vectors) => {
            let vector = vectors.get(vertex).into_iter().flatten();
            bytes.extend(vector.flat_map(|number| number.to_le_bytes()));
        }
        VertexColumn::Double(vectors) => {
            let vector = vectors.get(vertex).into_iter().flatten();
            bytes.extend(vector.flat_map(|number| number.to_le_bytes()));
        }
    }
}
