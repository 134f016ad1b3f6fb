//! The corners of faces of an OBJ, as indices.

use crate::words::{Word, WordError};

/// The counts of positions, texture coordinates and normals.
pub(super) type CornerCounts = [usize; 3];

/// The indices of a corner, from 0.
pub(super) type Corner = [Option<u32>; 3];

/// What corners refer to, in the order of their parts.
const NOUNS: [&str; 3] = ["vertex", "texture coordinate", "normal"];

/// What other readers do where a corner refers to a texture coordinate or a normal that is not
/// there.
const WITHOUT: &str = "the corner is without it";

/// The indices of a corner, from 0: `v`, `v/vt`, `v//vn` or `v/vt/vn`, each from 1 or, negative,
/// from the last so far.
pub(super) fn indices(
    corner: &Word<'_>,
    so_far: CornerCounts,
    total: CornerCounts,
) -> Result<Corner, WordError> {
    read(corner, |part, index| {
        resolve(index, NOUNS[part], so_far[part], total[part]).map(Some)
    })
}

/// As [`indices`], without the texture coordinate or the normal that is not there.
pub(super) fn indices_there(
    corner: &Word<'_>,
    so_far: CornerCounts,
    total: CornerCounts,
) -> Result<Corner, WordError> {
    read(corner, |part, index| {
        match resolve(index, NOUNS[part], so_far[part], total[part]) {
            Err(fault) if fault.repair.is_some() => Ok(None),
            found => found.map(Some),
        }
    })
}

fn read(
    corner: &Word<'_>,
    mut resolve: impl FnMut(usize, &Word<'_>) -> Result<Option<u32>, WordError>,
) -> Result<Corner, WordError> {
    if corner.bytes[0] == b'/' {
        return Err(corner.fault(
            format!("the corner `{}` has no vertex", corner.text()),
            "a corner of a face",
        ));
    }
    let mut found = [None; 3];
    for (part, index) in corner.split(b'/').enumerate() {
        let Some(slot) = found.get_mut(part) else {
            return Err(corner.fault(
                format!("`{}` has more than three parts", corner.text()),
                "a corner of a face",
            ));
        };
        if !index.bytes.is_empty() {
            *slot = resolve(part, &index)?;
        }
    }
    Ok(found)
}

fn resolve(index: &Word<'_>, entity: &str, so_far: usize, total: usize) -> Result<u32, WordError> {
    let number = index.integer()?;
    let distance = usize::try_from(number.unsigned_abs()).unwrap_or(usize::MAX);
    let resolved = if number < 0 {
        so_far.checked_sub(distance)
    } else {
        distance.checked_sub(1)
    };
    resolved
        .filter(|index| *index < total)
        .and_then(|index| u32::try_from(index).ok())
        .ok_or_else(|| {
            let there = if number < 0 {
                format!("only {so_far} come before it")
            } else {
                format!("the file has only {total}")
            };
            let fault = index.fault(
                format!("a face refers to {entity} {number}, but {there}"),
                format!("there is no such {entity}"),
            );
            match entity == NOUNS[0] {
                true => fault,
                false => fault.repaired(WITHOUT),
            }
        })
}
