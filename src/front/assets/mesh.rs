//! The meshes: OBJ or OFF, told apart by content.

use super::scan::{Fault, Lines, Word};
use super::{Known, Porter, Wanted, Without, obj, off, over_limit};
use crate::diag::{Diagnostic, codes};
use crate::ir::{Lowered, Mesh, MeshId, Scene, Shape};
use crate::source::{Budget, Exceeded, FileId, Found};
use std::collections::BTreeMap;

/// The largest mesh file read, in bytes: some two million triangles.
const MAX_BYTES: u64 = 1 << 28;

/// So many faults of one file are told.
pub(super) const MAX_FAULTS: usize = 10;

/// A mesh file as read.
#[derive(Debug, Default)]
pub(super) struct Parsed {
    pub(super) mesh: Geometry,
    /// Elements that don't show: the first, and how many.
    pub(super) not_drawn: Option<(Fault, usize)>,
}

/// Why a mesh file can't be read.
pub(super) enum Unread {
    /// Its faults in the order of the file, at least one.
    Faults(Vec<Fault>),
    /// It would take more than the budget has.
    Limit(Exceeded),
}

impl From<Exceeded> for Unread {
    fn from(fault: Exceeded) -> Self {
        Self::Limit(fault)
    }
}

/// A mesh without a name.
#[derive(Debug, Default)]
pub(super) struct Geometry {
    pub(super) positions: Vec<[f64; 3]>,
    pub(super) normals: Vec<[f64; 3]>,
    pub(super) uvs: Vec<[f64; 2]>,
    pub(super) triangles: Vec<[u32; 3]>,
}

/// Brings one mesh, or the one that the same file became before, whatever it was called; without a file it stays empty,
/// and nothing shows of it.
pub(super) fn bring(
    id: MeshId,
    wish: &Wanted,
    lowered: &mut Lowered,
    known: &mut Known<MeshId>,
    porter: &mut Porter<'_>,
) -> MeshId {
    let Some(found) = porter.find(wish, Without::Object) else { return id };
    let mesh = known.of(&found, || {
        let Geometry { positions, normals, uvs, triangles } = load(&found, wish, porter)?;
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
            instance.mesh = mesh_of.get(&instance.mesh.0).copied().unwrap_or(instance.mesh);
        }
    }
}

/// The mesh in a file, if there is a sound one.
fn load(found: &Found, wish: &Wanted, porter: &mut Porter<'_>) -> Option<Geometry> {
    let file = read(found, wish, porter)?;
    match parse(porter.map.bytes(file), porter.map.budget()) {
        Ok(Parsed { mesh, not_drawn }) => {
            if let Some((first, count)) = not_drawn {
                let message = format!("{} show: {}", count_of(count), first.message);
                let finding = Diagnostic::new(&codes::NOT_DRAWN, message).at(first.span(file), first.label);
                porter.sink.push(finding.also(wish.span, "the file is named here"));
            }
            return Some(mesh);
        }
        Err(Unread::Limit(fault)) => {
            let what = format!("the mesh `{}`", found.shown.display());
            porter.refuse(over_limit(&what, &fault).at(wish.span, "named here"), Without::Object);
        }
        // Lenient, the object is left out once.
        Err(Unread::Faults(faults)) => {
            let told = if porter.options.lenient { 1 } else { MAX_FAULTS };
            for fault in faults.into_iter().take(told) {
                let finding = Diagnostic::new(&codes::BAD_MESH_FILE, fault.message.as_str());
                let finding = finding.at(fault.span(file), fault.label).also(wish.span, "the file is named here");
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
    match porter.loader.bytes(&found.path, MAX_BYTES) {
        Ok(bytes) => Some(porter.map.add(found.shown.display().to_string(), bytes)),
        Err(error) => {
            porter.unreadable(found, &error.to_string(), wish.span, Without::Object);
            None
        }
    }
}

/// Reads a mesh file of either format.
fn parse(bytes: &[u8], budget: &Budget) -> Result<Parsed, Unread> {
    let mut words = Vec::new();
    let has_words = Lines::new(bytes).next(&mut words);
    let parsed = match words.first() {
        Some(head) if off::is_head(head) => off::parse(bytes, budget)?,
        Some(_) | None => obj::parse(bytes, budget)?,
    };
    if parsed.mesh.triangles.is_empty() {
        let (message, label) = match words.first().filter(|_| has_words) {
            Some(_) => ("the mesh has no faces", "neither OFF nor OBJ with faces"),
            None => ("the mesh file is empty", "nothing here"),
        };
        return Err(Unread::Faults(vec![words.first().unwrap_or(&Word::START).fault(message, label)]));
    }
    Ok(parsed)
}
