//! The meshes: OBJ or OFF, told apart by content.

use super::scan::{Fault, Lines, Word};
use super::{Known, Porter, Wanted, Without, obj, off, over_limit};
use crate::diag::{Diagnostic, codes};
use crate::ir::{Lowered, Mesh, MeshId, Scene, Shape};
use crate::source::{Budget, Exceeded, FileId, Found, Kind};
use std::collections::BTreeMap;

/// The largest mesh file read, in bytes: some two million triangles.
const MAX_BYTES: u64 = 1 << 28;

/// So many faults of one file are told.
pub(super) const MAX_FAULTS: usize = 10;

/// Such files.
pub(super) const KIND: Kind = Kind {
    extensions: &["obj", "off"],
    begins: is_mesh,
};

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
        let Geometry {
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
fn load(found: &Found, wish: &Wanted, porter: &mut Porter<'_>) -> Option<Geometry> {
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

/// Whether a file that begins so is a mesh: it starts as OFF, or as OBJ and has a vertex.
fn is_mesh(head: &[u8]) -> bool {
    let (mut lines, mut words) = (Lines::new(head), Vec::new());
    let has_words = lines.next(&mut words);
    if !has_words || !obj::is_keyword(&words[0]) {
        return has_words && off::is_head(&words[0]);
    }
    let is_vertex = |words: &[Word<'_>]| matches!(words, [Word { bytes: b"v", .. }, x, ..] if x.number().is_ok());
    while !is_vertex(&words) {
        if !lines.next(&mut words) {
            return false;
        }
    }
    true
}

/// Reads a mesh file of either format.
fn parse(bytes: &[u8], budget: &Budget) -> Result<Parsed, Unread> {
    let mut words = Vec::new();
    Lines::new(bytes).next(&mut words);
    let parsed = match words.first() {
        Some(head) if off::is_head(head) => off::parse(bytes, budget)?,
        Some(_) | None => obj::parse(bytes, budget)?,
    };
    if parsed.mesh.triangles.is_empty() {
        let fault = words
            .first()
            .unwrap_or(&Word::START)
            .fault("the mesh has no faces", "nothing is drawn");
        return Err(Unread::Faults(vec![fault]));
    }
    Ok(parsed)
}
