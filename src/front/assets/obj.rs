//! Wavefront OBJ. `tobj` makes triangles of it; before, every line it will read is checked here, so that it meets no
//! number or index it can't take, and every fault has its place.
//!
//! Groups and materials make no difference. Corners without a normal, where others have one, are shaded flat.

use super::mesh::{Geometry, MAX_FAULTS, Parsed};
use super::scan::{Fault, Lines, Word, numbers};
use std::fmt::Write as _;

/// How many there are of what corners refer to: positions, texture coordinates, normals.
type Counts = [usize; 3];

/// What corners refer to, in the order of their parts.
const NOUNS: [&str; 3] = ["vertex", "texture coordinate", "normal"];

/// True if the word opens a statement that OBJ files begin with.
pub(super) fn is_keyword(word: &Word<'_>) -> bool {
    const KEYWORDS: [&[u8]; 16] = [
        b"v", b"vt", b"vn", b"vp", b"f", b"fo", b"l", b"p", b"g", b"o", b"s", b"mg", b"mtllib", b"usemtl", b"maplib",
        b"usemap",
    ];
    KEYWORDS.contains(&word.bytes)
}

/// Reads an OBJ.
pub(super) fn parse(bytes: &[u8]) -> Result<Parsed, Vec<Fault>> {
    let mut check = Check::default();
    let total = check.vertices(bytes);
    if check.faults.is_empty() {
        check.faces(bytes, total);
    }
    if !check.faults.is_empty() {
        return Err(check.faults);
    }
    let mesh = triangulate(&check.checked(total)).map_err(|words| vec![Word::START.fault(words, "in this file")])?;
    Ok(Parsed { mesh, not_drawn: check.not_drawn })
}

/// What was checked, and what was found.
#[derive(Default)]
struct Check {
    /// The vertices with the numbers that count, one a line.
    vertices: String,
    /// The corners of all faces.
    corners: Vec<[Option<u32>; 3]>,
    /// How many corners each face has.
    arities: Vec<usize>,
    faults: Vec<Fault>,
    not_drawn: Option<(Fault, usize)>,
}

impl Check {
    /// Checks the vertices and returns how many there are.
    fn vertices(&mut self, bytes: &[u8]) -> Counts {
        let (mut lines, mut words, mut total) = (Lines::new(bytes), Vec::new(), Counts::default());
        while lines.next(&mut words) && self.faults.len() < MAX_FAULTS {
            let (head, rest) = (&words[0], &words[1..]);
            if let Some(part) = part_of(head) {
                total[part] += 1;
                let outcome = self.vertex(part, head, rest);
                self.faults.extend(outcome.err());
            }
        }
        total
    }

    fn vertex(&mut self, part: usize, head: &Word<'_>, rest: &[Word<'_>]) -> Result<(), Fault> {
        let [x, y, z] = match part {
            // A height of a texture is rarely written.
            1 if rest.len() == 1 => [rest[0].number()?, 0.0, 0.0],
            1 => numbers::<2>(head, rest).map(|[u, v]| [u, v, 0.0])?,
            _ => numbers::<3>(head, rest)?,
        };
        let keyword = ["v", "vt", "vn"][part];
        // The shortest text of a number is read back to the same bits.
        writeln!(self.vertices, "{keyword} {x} {y} {z}").expect("a string takes any text");
        Ok(())
    }

    /// Checks the faces; what they refer to may follow them.
    fn faces(&mut self, bytes: &[u8], total: Counts) {
        let (mut lines, mut words, mut so_far) = (Lines::new(bytes), Vec::new(), Counts::default());
        while lines.next(&mut words) && self.faults.len() < MAX_FAULTS {
            let (head, rest) = (words[0], &words[1..]);
            if let Some(part) = part_of(&head) {
                so_far[part] += 1;
            }
            match head.bytes {
                b"f" | b"fo" if rest.len() >= 3 => {
                    let outcome = self.face(rest, so_far, total);
                    self.faults.extend(outcome.err());
                }
                b"f" | b"fo" => self.skip(&head, "faces need three corners"),
                b"l" | b"p" => self.skip(&head, "lines and points have no surface"),
                b"curv" | b"curv2" | b"surf" => self.skip(&head, "free-form curves and surfaces are not supported"),
                _ => {}
            }
        }
    }

    fn face(&mut self, corners: &[Word<'_>], so_far: Counts, total: Counts) -> Result<(), Fault> {
        for corner in corners {
            self.corners.push(indices(corner, so_far, total)?);
        }
        self.arities.push(corners.len());
        Ok(())
    }

    fn skip(&mut self, head: &Word<'_>, why: &str) {
        self.not_drawn.get_or_insert_with(|| (head.fault(why, "the first one"), 0)).1 += 1;
    }

    /// The file as `tobj` may have it: where one corner has a texture coordinate or a normal, all have; those that had
    /// none share one of zeros.
    fn checked(&self, total: Counts) -> String {
        let used = [1, 2].map(|part| self.corners.iter().any(|corner| corner[part].is_some()));
        let mut text = self.vertices.clone();
        text.push_str("vt 0 0 0\nvn 0 0 0\n");
        let mut corners = self.corners.iter();
        for arity in &self.arities {
            text.push('f');
            for [v, vt, vn] in corners.by_ref().take(*arity) {
                let index = |index: &Option<u32>, part: usize| index.map_or(total[part], |index| index as usize) + 1;
                let vt = if used[0] { index(vt, 1).to_string() } else { String::new() };
                let vn = if used[1] { index(vn, 2).to_string() } else { String::new() };
                write!(text, " {}/{vt}/{vn}", index(v, 0)).expect("a string takes any text");
            }
            text.push('\n');
        }
        text
    }
}

/// What a line declares: an index into [`NOUNS`].
fn part_of(head: &Word<'_>) -> Option<usize> {
    match head.bytes {
        b"v" => Some(0),
        b"vt" => Some(1),
        b"vn" => Some(2),
        _ => None,
    }
}

/// The indices of a corner, from 0: `v`, `v/vt`, `v//vn` or `v/vt/vn`, each from 1 or, negative, from the last so far.
fn indices(corner: &Word<'_>, so_far: Counts, total: Counts) -> Result<[Option<u32>; 3], Fault> {
    if corner.bytes[0] == b'/' {
        return Err(corner.fault(format!("the corner `{}` has no vertex", corner.text()), "a corner of a face"));
    }
    let mut found = [None; 3];
    for (part, index) in corner.split(b'/').enumerate() {
        let Some(slot) = found.get_mut(part) else {
            return Err(corner.fault(format!("`{}` has more than three parts", corner.text()), "a corner of a face"));
        };
        if !index.bytes.is_empty() {
            *slot = Some(resolve(&index, NOUNS[part], so_far[part], total[part])?);
        }
    }
    Ok(found)
}

fn resolve(index: &Word<'_>, noun: &str, so_far: usize, total: usize) -> Result<u32, Fault> {
    let number = index.integer()?;
    let distance = usize::try_from(number.unsigned_abs()).unwrap_or(usize::MAX);
    let resolved = if number < 0 { so_far.checked_sub(distance) } else { distance.checked_sub(1) };
    resolved.filter(|index| *index < total).and_then(|index| u32::try_from(index).ok()).ok_or_else(|| {
        let there = if number < 0 { format!("{so_far} stand before it") } else { format!("the file has {total}") };
        index.fault(format!("a face refers to {noun} {number}, and {there}"), format!("there is no such {noun}"))
    })
}

/// The triangles of a checked file.
fn triangulate(text: &str) -> Result<Geometry, String> {
    let options = tobj::LoadOptions { single_index: true, triangulate: true, ignore_points: true, ignore_lines: true };
    let (models, _) = tobj::load_obj_buf(&mut text.as_bytes(), &options, |_| Ok(Default::default()))
        .map_err(|error| error.to_string())?;
    let Some(tobj::Model { mesh, name: _ }) = models.into_iter().next() else { return Ok(Geometry::default()) };
    Ok(Geometry {
        positions: mesh.positions.as_chunks().0.to_vec(),
        normals: mesh.normals.as_chunks().0.to_vec(),
        uvs: mesh.texcoords.as_chunks().0.to_vec(),
        triangles: mesh.indices.as_chunks().0.to_vec(),
    })
}
