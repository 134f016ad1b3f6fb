//! The meshes: OBJ or OFF, told apart by content.

use super::scan::{Fault, Lines, Word};
use super::{Porter, Wanted, Without, obj, off};
use crate::diag::{Diagnostic, codes};
use crate::ir::{Lowered, Mesh, MeshId};
use crate::source::{FileId, Found, Kind};

/// The largest mesh file read, in bytes: some two million triangles.
const MAX_BYTES: u64 = 1 << 28;

/// So many faults of one file are told.
pub(super) const MAX_FAULTS: usize = 10;

/// Such files.
pub(super) const KIND: Kind = Kind { extensions: &["obj", "off"], begins: is_mesh };

/// A mesh file as read.
#[derive(Debug, Default)]
pub(super) struct Parsed {
    pub(super) mesh: Geometry,
    /// Elements that don't show: the first, and how many.
    pub(super) not_drawn: Option<(Fault, usize)>,
}

/// A mesh without a name.
#[derive(Debug, Default)]
pub(super) struct Geometry {
    pub(super) positions: Vec<[f64; 3]>,
    pub(super) normals: Vec<[f64; 3]>,
    pub(super) uvs: Vec<[f64; 2]>,
    pub(super) triangles: Vec<[u32; 3]>,
}

/// Brings one mesh; without its file it stays empty, and nothing shows of it.
pub(super) fn bring(id: MeshId, wish: &Wanted, lowered: &mut Lowered, porter: &mut Porter<'_>) {
    let Some(found) = porter.find(wish, Without::Object) else { return };
    let Some(file) = read(&found, wish, porter) else { return };
    match parse(porter.map.bytes(file)) {
        Ok(Parsed { mesh, not_drawn }) => {
            if let Some((first, count)) = not_drawn {
                let message = format!("{} show: {}", count_of(count), first.message);
                let finding = Diagnostic::new(&codes::NOT_DRAWN, message).at(first.span(file), first.label);
                porter.sink.push(finding.also(wish.span, "the file is named here"));
            }
            if let Some(place) = lowered.scene.meshes.get_mut(id.0 as usize) {
                let Geometry { positions, normals, uvs, triangles } = mesh;
                let name = std::mem::take(&mut place.name);
                *place = Mesh {
                    name,
                    positions: positions.into(),
                    normals: normals.into(),
                    uvs: uvs.into(),
                    triangles: triangles.into(),
                    ..Mesh::default()
                };
            }
        }
        // Lenient, the object is left out once.
        Err(faults) => {
            let told = if porter.options.lenient { 1 } else { MAX_FAULTS };
            for fault in faults.into_iter().take(told) {
                let finding = Diagnostic::new(&codes::BAD_MESH_FILE, fault.message.as_str());
                let finding = finding.at(fault.span(file), fault.label).also(wish.span, "the file is named here");
                porter.refuse(finding, Without::Object);
            }
        }
    }
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
            porter.refuse(Diagnostic::new(&codes::BAD_MESH_FILE, message).at(wish.span, "named here"), Without::Object);
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

/// Reads a mesh file of either format; the faults are in the order of the file, at least one.
pub(super) fn parse(bytes: &[u8]) -> Result<Parsed, Vec<Fault>> {
    let mut words = Vec::new();
    Lines::new(bytes).next(&mut words);
    let parsed = match words.first() {
        Some(head) if off::is_head(head) => off::parse(bytes)?,
        Some(_) | None => obj::parse(bytes)?,
    };
    if parsed.mesh.triangles.is_empty() {
        return Err(vec![words.first().unwrap_or(&Word::START).fault("the mesh has no faces", "nothing is drawn")]);
    }
    Ok(parsed)
}
