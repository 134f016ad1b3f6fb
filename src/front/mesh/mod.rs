//! Mesh files, OBJ or OFF, told apart by content: bytes to vertices and triangles.
//!
//! What a mesh takes is charged before it is there; every fault has its place in the file. Who asked
//! for the file, and what is done without it, is the affair of others.

mod material_use;
pub mod mtl;
mod obj;
mod off;

pub use crate::front::words::{Unread, WordFault, WordSpan};
pub use material_use::{MaterialUse, Named};

use crate::front::words::{Lines, Word};
use crate::source::Budget;

/// So many faults of one file are told.
pub const MAX_FAULTS: usize = 10;

/// A mesh file as read.
#[derive(Debug, Default)]
pub struct Parsed {
    /// What is drawn.
    pub mesh: ParsedMesh,
    /// Elements that don't show: the first, and how many.
    pub not_drawn: Option<(WordFault, usize)>,
    /// Which materials it asks for.
    pub material_use: MaterialUse,
}

/// A mesh without a name.
#[derive(Debug, Default)]
pub struct ParsedMesh {
    /// Where each vertex is.
    pub positions: Vec<[f64; 3]>,
    /// The normal of each vertex; none if no face has any.
    pub normals: Vec<[f64; 3]>,
    /// The texture coordinates of each vertex; none if no face has any.
    pub uvs: Vec<[f64; 2]>,
    /// The vertices of each triangle, from 0, in range.
    pub triangles: Vec<[u32; 3]>,
}

/// Whether a file that begins so is a mesh: it starts as OFF, or as OBJ and has a vertex.
#[must_use]
pub fn is_mesh(head: &[u8]) -> bool {
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
///
/// # Errors
/// If it has faults, or would take more than the budget has.
pub fn parse(bytes: &[u8], budget: &Budget) -> Result<Parsed, Unread> {
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
