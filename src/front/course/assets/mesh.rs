//! The meshes: their files found and read, each once.

use super::text::TextKind;
use super::{Known, Porter, Wanted, Without};
use crate::diag::{Diagnostic, codes};
use crate::front::mesh::{Parsed, ParsedMesh, is_mesh, parse};
use crate::ir::{Lowered, Mesh, MeshId, Scene, Shape};
use crate::source::{FileKind, Found};
use std::collections::BTreeMap;

/// Such files.
pub(super) const TEXT: TextKind = TextKind {
    noun: "mesh",
    is_not: "neither OBJ nor OFF",
    code: &codes::BAD_MESH_FILE,
    without: Without::Object,
    // Some two million triangles.
    max_bytes: 1 << 28,
    file: FileKind {
        extensions: &["obj", "off"],
        begins: is_mesh,
    },
};

/// Brings one mesh, or the one that the same file became before, whatever it was called; without a
/// file it stays empty, and nothing shows of it.
pub(super) fn bring(
    id: MeshId,
    wish: &Wanted,
    lowered: &mut Lowered,
    known: &mut Known<MeshId>,
    porter: &mut Porter<'_>,
) -> MeshId {
    let Some(found) = porter.find(wish, Without::Object) else {
        return id;
    };
    let mesh = known.of(&found, || {
        let ParsedMesh {
            positions,
            normals,
            uvs,
            triangles,
        } = load(&found, wish, porter)?;
        let place = lowered.scene.meshes.get_mut(id.0 as usize)?;
        let name = std::mem::take(&mut place.name);
        *place = Mesh {
            name,
            positions: positions.into(),
            normals: normals.into(),
            uvs: uvs.into(),
            triangles: triangles.into(),
            ..Mesh::default()
        };
        Some(id)
    });
    mesh.copied().unwrap_or(id)
}

/// Has instances show the meshes that came of those they wanted.
pub(super) fn settle(mesh_of: &BTreeMap<u32, MeshId>, scene: &mut Scene) {
    for surface in &mut scene.surfaces {
        if let Shape::Instance(instance) = &mut surface.shape {
            instance.mesh = mesh_of
                .get(&instance.mesh.0)
                .copied()
                .unwrap_or(instance.mesh);
        }
    }
}

/// The mesh in a file, if there is a sound one.
fn load(found: &Found, wish: &Wanted, porter: &mut Porter<'_>) -> Option<ParsedMesh> {
    let (file, Parsed { mesh, not_drawn }) = porter.read_text(found, wish, &TEXT, parse)?;
    if let Some((first, count)) = not_drawn {
        let message = format!("{} show: {}", count_of(count), first.message);
        let finding = Diagnostic::new(&codes::NOT_DRAWN, message).at(first.span(file), first.label);
        porter
            .sink
            .push(finding.also(wish.span, "the file is named here"));
    }
    Some(mesh)
}

fn count_of(count: usize) -> String {
    if count == 1 {
        "an element of this file does not".to_owned()
    } else {
        format!("{count} elements of this file don't")
    }
}
