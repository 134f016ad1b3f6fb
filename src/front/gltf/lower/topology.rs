//! The points, lines and triangles of a primitive: from lists, loops, strips and fans, with indices
//! or without.

use super::super::accessor_reader::AccessorReader;
use super::super::document::Document;
use super::super::primitive::Primitive;
use rtc_math::to_u32;

const POINTS: u64 = 0;
const LINES: u64 = 1;
const LOOP: u64 = 2;
const LINE_STRIP: u64 = 3;
const TRIANGLES: u64 = 4;
const STRIP: u64 = 5;
const FAN: u64 = 6;

/// The corners of the triangles; none if the primitive has no surface, or its indices can't be had.
pub(super) fn triangles(
    doc: &Document<'_>,
    primitive: &Primitive,
    vertices: usize,
) -> Option<Vec<[u32; 3]>> {
    let mut triangles = match primitive.indices {
        Some(index) if primitive.mode == TRIANGLES => {
            AccessorReader::of(doc, doc.accessors.get(index)?)?.groups()
        }
        _ => assemble(&indices(doc, primitive, vertices)?, primitive.mode)?,
    };
    triangles.retain(|corners| corners.iter().all(|corner| (*corner as usize) < vertices));
    Some(triangles)
}

/// The ends of the lines; a point is a line from a vertex to itself. None if the indices can't be
/// had.
pub(super) fn strokes(
    doc: &Document<'_>,
    primitive: &Primitive,
    vertices: usize,
) -> Option<Vec<[u32; 2]>> {
    let indices = indices(doc, primitive, vertices)?;
    let mut strokes = join(&indices, primitive.mode)?;
    strokes.retain(|ends| ends.iter().all(|end| (*end as usize) < vertices));
    Some(strokes)
}

/// Points and lines of a list of corners (glTF 2.0, section 3.7.2.1).
fn join(indices: &[u32], mode: u64) -> Option<Vec<[u32; 2]>> {
    let pairs = || indices.windows(2).map(|ends| [ends[0], ends[1]]);
    Some(match mode {
        POINTS => indices.iter().map(|index| [*index; 2]).collect(),
        LINES => indices.as_chunks::<2>().0.to_vec(),
        LOOP => {
            let closing = indices.last().zip(indices.first());
            let closing = closing.map(|(last, first)| [*last, *first]);
            pairs().chain(closing).collect()
        }
        LINE_STRIP => pairs().collect(),
        _ => return None,
    })
}

fn indices(doc: &Document<'_>, primitive: &Primitive, vertices: usize) -> Option<Vec<u32>> {
    match primitive.indices {
        Some(index) => Some(AccessorReader::of(doc, doc.accessors.get(index)?)?.integers()),
        None => Some((0..to_u32(vertices)).collect()),
    }
}

/// Triangles of a list of corners (glTF 2.0, section 3.7.2.1): all turn the same way.
fn assemble(indices: &[u32], mode: u64) -> Option<Vec<[u32; 3]>> {
    match mode {
        TRIANGLES => Some(indices.as_chunks::<3>().0.to_vec()),
        STRIP => {
            let corner = |at: usize, w: &[u32]| {
                if at.is_multiple_of(2) {
                    [w[0], w[1], w[2]]
                } else {
                    [w[0], w[2], w[1]]
                }
            };
            Some(
                indices
                    .windows(3)
                    .enumerate()
                    .map(|(at, window)| corner(at, window))
                    .collect(),
            )
        }
        FAN => {
            let (first, rest) = indices.split_first()?;
            Some(
                rest.windows(2)
                    .map(|pair| [pair[0], pair[1], *first])
                    .collect(),
            )
        }
        _ => None,
    }
}

/// Keeps the vertices that triangles use, if that saves much or has to be: the old index of each
/// that is kept.
pub(super) fn compact(
    triangles: &mut [[u32; 3]],
    vertices: usize,
    has_to_be: bool,
) -> Option<Vec<u32>> {
    const UNUSED: u32 = u32::MAX;
    let mut is_used = vec![false; vertices];
    let corners = triangles.iter().flatten();
    corners.for_each(|corner| is_used[*corner as usize] = true);
    let used = is_used.into_iter().filter(|is_used| *is_used).count();
    if !has_to_be && 4 * used > 3 * vertices {
        return None;
    }
    let mut renamed = vec![UNUSED; vertices];
    let mut kept = Vec::with_capacity(used);
    for corner in triangles.iter().flatten() {
        let slot = &mut renamed[*corner as usize];
        if *slot == UNUSED {
            *slot = to_u32(kept.len());
            kept.push(*corner);
        }
    }
    triangles
        .iter_mut()
        .flatten()
        .for_each(|corner| *corner = renamed[*corner as usize]);
    Some(kept)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn strips_and_fans_turn_one_way() {
        assert_eq!(
            assemble(&[0, 1, 2, 3, 4], STRIP).unwrap(),
            [[0, 1, 2], [1, 3, 2], [2, 3, 4]]
        );
        assert_eq!(
            assemble(&[0, 1, 2, 3], FAN).unwrap(),
            [[1, 2, 0], [2, 3, 0]]
        );
        assert_eq!(assemble(&[0, 1, 2, 3], TRIANGLES).unwrap(), [[0, 1, 2]]);
        assert_eq!(assemble(&[0, 1], 1), None);
    }

    #[test]
    fn points_and_lines_join_their_corners() {
        let ends = |mode| join(&[4, 5, 7], mode).unwrap();
        assert_eq!(ends(POINTS), [[4, 4], [5, 5], [7, 7]]);
        assert_eq!(ends(LINES), [[4, 5]]);
        assert_eq!(ends(LOOP), [[4, 5], [5, 7], [7, 4]]);
        assert_eq!(ends(LINE_STRIP), [[4, 5], [5, 7]]);
        assert_eq!(join(&[0, 1, 2], TRIANGLES), None);
    }

    #[test]
    fn unused_vertices_are_left_out() {
        let mut triangles = [[7, 5, 9], [9, 5, 2]];
        assert_eq!(compact(&mut triangles, 10, false), Some(vec![7, 5, 9, 2]));
        assert_eq!(triangles, [[0, 1, 2], [2, 1, 3]]);
        assert_eq!(compact(&mut triangles, 4, false), None);
        assert_eq!(compact(&mut triangles, 4, true), Some(vec![0, 1, 2, 3]));
    }
}
