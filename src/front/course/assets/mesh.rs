//! The meshes: their files found and read, each once.

use super::{Known, Porter, Wanted, Without};
use crate::diag::{Diagnostic, codes};
use crate::front::mesh::{MAX_FAULTS, Parsed, ParsedMesh, Unread, is_mesh, parse};
use crate::front::over_limit;
use crate::ir::{Lowered, Mesh, MeshId, Scene, Shape};
use crate::source::{FileId, FileKind, Found};
use std::collections::BTreeMap;

/// The largest mesh file read, in bytes: some two million triangles.
const MAX_BYTES: u64 = 1 << 28;

/// Such files.
pub(super) const KIND: FileKind = FileKind {
    extensions: &["obj", "off"],
    begins: is_mesh,
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
    let file = read(found, wish, porter)?;
    match parse(porter.map.bytes(file), porter.map.budget()) {
        Ok(Parsed { mesh, not_drawn }) => {
            if let Some((first, count)) = not_drawn {
                let message = format!("{} show: {}", count_of(count), first.message);
                let finding =
                    Diagnostic::new(&codes::NOT_DRAWN, message).at(first.span(file), first.label);
                porter
                    .sink
                    .push(finding.also(wish.span, "the file is named here"));
            }
            return Some(mesh);
        }
        Err(Unread::Limit(fault)) => {
            let what = format!("the mesh `{}`", found.shown.display());
            porter.refuse(
                over_limit(&what, &fault).at(wish.span, "named here"),
                Without::Object,
            );
        }
        // Lenient, the object is left out once.
        Err(Unread::Faults(faults)) => {
            let told = if porter.options.lenient {
                1
            } else {
                MAX_FAULTS
            };
            for fault in faults.into_iter().take(told) {
                let finding = Diagnostic::new(&codes::BAD_MESH_FILE, fault.message.as_str());
                let finding = finding
                    .at(fault.span(file), fault.label)
                    .also(wish.span, "the file is named here");
                porter.refuse(finding, Without::Object);
            }
        }
    }
    None
}

fn count_of(count: usize) -> String {
    if count == 1 {
        "an element of this file does not".to_owned()
    } else {
        format!("{count} elements of this file don't")
    }
}

fn read(found: &Found, wish: &Wanted, porter: &mut Porter<'_>) -> Option<FileId> {
    match porter.loader.found(found, MAX_BYTES, porter.map) {
        Ok(bytes) if is_mesh(&bytes) => Some(porter.map.add_found(found, bytes)),
        // A finding within would quote a file that is none of the scene's business.
        Ok(bytes) => {
            let name = found.shown.display();
            let message = match bytes.is_empty() {
                true => format!("the mesh file `{name}` is empty"),
                false => format!("`{name}` is neither OBJ nor OFF"),
            };
            porter.refuse(
                Diagnostic::new(&codes::BAD_MESH_FILE, message).at(wish.span, "named here"),
                Without::Object,
            );
            None
        }
        Err(error) => {
            porter.unreadable(found, &error.to_string(), wish.span, Without::Object);
            None
        }
    }
}
