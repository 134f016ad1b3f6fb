//! STL (3D Systems, "StereoLithography interface specification", 1989), as text or binary:
//! triangles that share no corners and are shaded flat.
//!
//! The normals of the file are not read: the order of the corners says the same.

use super::{MAX_FAULTS, Parsed, Unread, charge, first_lines};
use crate::words::{Lines, Word, WordFault, numbers};
use rtc_ir::Mesh;
use rtc_source::{Budget, Resource};

/// What stands before the triangles of a binary file: 80 bytes of any kind, and their count.
const HEAD: usize = 84;

/// A binary triangle: its normal, its corners, and two bytes of any kind.
const TRIANGLE: usize = 50;

/// So much of a file is read, at most, to find one that fits a name.
const LOOKED_AT: usize = 1 << 16;

/// True if a file that begins so is an STL.
pub(super) fn is_head(head: &[u8]) -> bool {
    is_binary(head) || is_text(head)
}

fn is_text(head: &[u8]) -> bool {
    let mut words = Vec::new();
    first_lines(head).next(&mut words)
        && words[0].bytes.eq_ignore_ascii_case(b"solid")
        && memchr::memmem::find(head, b"facet").is_some()
}

/// Whether it is as long as its count says; of a file of which more is there, whether it may be.
fn is_binary(head: &[u8]) -> bool {
    let Some(Ok(count)) = head.get(HEAD - 4..HEAD).map(<[u8; 4]>::try_from) else {
        return false;
    };
    let (count, length) = (u32::from_le_bytes(count), head.len() as u64);
    // More than an address of 32 bits may hold.
    let size = HEAD as u64 + TRIANGLE as u64 * u64::from(count);
    let is_cut = head.len() == LOOKED_AT && size > length;
    count > 0 && (length == size || (is_cut && is_finite(head)))
}

/// Whether the first triangles are made of numbers.
fn is_finite(head: &[u8]) -> bool {
    let triangles = head[HEAD..].as_chunks::<TRIANGLE>().0;
    triangles
        .iter()
        .flat_map(corners)
        .flatten()
        .all(f64::is_finite)
}

/// The corners of a binary triangle.
fn corners(triangle: &[u8; TRIANGLE]) -> [[f64; 3]; 3] {
    let floats = triangle[12..48].as_chunks::<4>().0;
    let number = |at: usize| f64::from(f32::from_le_bytes(floats[at]));
    [0, 3, 6].map(|at| [number(at), number(at + 1), number(at + 2)])
}

/// Reads an STL.
pub(super) fn parse(bytes: &[u8], budget: &Budget) -> Result<Parsed, Unread> {
    // A binary triangle becomes three positions and three numbers; a line of text one position, in
    // a list that grows by doubling.
    budget.has(Resource::Memory, 4 * bytes.len() as u64)?;
    let (positions, faults) = match is_binary(bytes) {
        true => binary(bytes),
        false => text(bytes),
    };
    if !faults.is_empty() {
        return Err(Unread::Faults(faults));
    }
    let count = u32::try_from(positions.len() / 3).unwrap_or(u32::MAX / 3);
    let mut mesh = Mesh {
        positions: positions.into(),
        triangles: (0..count)
            .map(|at| [3 * at, 3 * at + 1, 3 * at + 2])
            .collect(),
        ..Mesh::default()
    };
    charge(&mut mesh, budget)?;
    Ok(Parsed {
        mesh,
        ..Parsed::default()
    })
}

fn binary(bytes: &[u8]) -> (Vec<[f64; 3]>, Vec<WordFault>) {
    let triangles = bytes[HEAD..].as_chunks::<TRIANGLE>().0;
    let mut positions = Vec::with_capacity(3 * triangles.len());
    let mut faults = Vec::new();
    for (at, triangle) in triangles.iter().enumerate() {
        let corners = corners(triangle);
        if !corners.iter().flatten().all(|number| number.is_finite()) {
            let start = HEAD + TRIANGLE * at;
            let message = "a corner of a triangle is not finite";
            faults.push(WordFault::new(
                start..start + TRIANGLE,
                message,
                "this triangle",
            ));
        }
        positions.extend(corners);
        if faults.len() >= MAX_FAULTS {
            break;
        }
    }
    (positions, faults)
}

fn text(bytes: &[u8]) -> (Vec<[f64; 3]>, Vec<WordFault>) {
    let (mut lines, mut words) = (Lines::new(bytes), Vec::new());
    let (mut positions, mut faults) = (Vec::new(), Vec::new());
    while lines.next(&mut words) && faults.len() < MAX_FAULTS {
        faults.extend(statement(&words, &mut positions).err());
    }
    if !positions.len().is_multiple_of(3) && faults.is_empty() {
        let end = bytes.len();
        faults.push(WordFault::new(
            end..end,
            "the file ends within a facet",
            "here",
        ));
    }
    (positions, faults)
}

fn statement(words: &[Word<'_>], positions: &mut Vec<[f64; 3]>) -> Result<(), WordFault> {
    let head = &words[0];
    match &*head.bytes.to_ascii_lowercase() {
        b"vertex" => positions.push(numbers(head, &words[1..])?),
        b"endfacet" if !positions.len().is_multiple_of(3) => {
            return Err(head.fault("a facet has not three corners", "it ends here"));
        }
        b"facet" | b"endfacet" | b"outer" | b"endloop" | b"solid" | b"endsolid" | b"color" => {}
        _ => {
            let message = format!("`{}` is no statement of STL", head.text());
            return Err(head.fault(message, "not known"));
        }
    }
    Ok(())
}
