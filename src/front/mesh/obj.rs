//! Wavefront OBJ. The lines are read three times: for the vertices, for the errors of the faces,
//! and for the faces. So little memory is held besides the mesh, whose size is known in advance.
//!
//! Groups are ignored, except smoothing groups; the material of each face is kept beside the mesh.
//! Corners without a normal, in a file with normals, are shaded flat.

mod build;
mod corner;
mod smooth;

use super::stroke::Segments;
use super::tint::VertexColors;
use super::{MAX_FAULTS, MaterialUse, MeshOptions, ParsedMesh, SpannedName, TextParseError};
use crate::words::{Word, WordError, WordLines, numbers};
use corner::{Corner, CornerCounts, indices, indices_there};
use rtc_source::{Budget, Resource};

/// True if the word is a statement that OBJ files begin with.
pub(super) fn is_keyword(word: &Word<'_>) -> bool {
    const KEYWORDS: [&[u8]; 16] = [
        b"v", b"vt", b"vn", b"vp", b"f", b"fo", b"l", b"p", b"g", b"o", b"s", b"mg", b"mtllib",
        b"usemtl", b"maplib", b"usemap",
    ];
    KEYWORDS.contains(&word.bytes)
}

/// Reads an OBJ.
pub(super) fn parse(
    bytes: &[u8],
    options: MeshOptions,
    budget: &Budget,
) -> Result<ParsedMesh, TextParseError> {
    let mut check = ObjCheck {
        options,
        ..ObjCheck::default()
    };
    check.vertices(bytes);
    let at_most = MaterialUse::at_most(check.switches) + STROKE * check.ends as u64;
    budget.has(Resource::Memory, at_most)?;
    if check.faults.is_empty() {
        check.faces(bytes);
    }
    if !check.faults.is_empty() {
        return Err(TextParseError::Faults(check.faults));
    }
    budget.charge(Resource::Memory, MaterialUse::at_most(check.switches))?;
    let mesh = check.mesh(bytes, budget)?;
    Ok(ParsedMesh {
        mesh,
        not_drawn: check.not_drawn,
        repaired: check.repaired,
        material_use: check.material_use,
        ..ParsedMesh::default()
    })
}

/// The memory that an end of a line takes, in lists that grow by doubling.
const STROKE: u64 = 32;

/// The results of the check.
#[derive(Default)]
struct ObjCheck {
    vertices: ObjVertices,
    /// The corners of all faces.
    corners: usize,
    /// The number of triangles of the faces.
    triangles: usize,
    /// Whether any corner has a texture coordinate, and a normal.
    used: [bool; 2],
    /// The number of corners in smoothing groups without a normal.
    smooth_corners: usize,
    /// The number of ends of lines and points.
    ends: usize,
    /// Lines and points, each with its material.
    strokes: Vec<(SpannedName, Segments)>,
    /// The number of `usemtl` lines.
    switches: usize,
    material_use: MaterialUse,
    faults: Vec<WordError>,
    not_drawn: Option<(WordError, usize)>,
    options: MeshOptions,
    repaired: Option<(WordError, usize)>,
}

/// What corners refer to.
#[derive(Default)]
struct ObjVertices {
    positions: Vec<[f64; 3]>,
    uvs: Vec<[f64; 2]>,
    normals: Vec<[f64; 3]>,
    /// The colours of positions.
    tints: VertexColors,
}

impl ObjVertices {
    fn counts(&self) -> CornerCounts {
        [self.positions.len(), self.uvs.len(), self.normals.len()]
    }

    fn read(&mut self, part: usize, head: &Word<'_>, rest: &[Word<'_>]) -> Result<(), WordError> {
        match part {
            0 => {
                self.positions.push(numbers(head, rest)?);
                self.tint(rest);
            }
            // A height of a texture is rarely written.
            1 if rest.len() == 1 => self.uvs.push([rest[0].number()?, 0.0]),
            1 => self.uvs.push(numbers(head, rest)?),
            _ => self.normals.push(numbers(head, rest)?),
        }
        Ok(())
    }

    /// The colour of a position, behind it: three numbers, or four with its opacity.
    fn tint(&mut self, rest: &[Word<'_>]) {
        let color: Option<Vec<f64>> = match rest.len() {
            6 | 7 => rest[3..].iter().map(|word| word.number().ok()).collect(),
            _ => None,
        };
        match color {
            Some(color) => {
                // Those before it have none.
                while self.tints.count() + 1 < self.positions.len() {
                    self.tints.skip();
                }
                self.tints.push(&color);
            }
            None if self.tints.count() > 0 => self.tints.skip(),
            None => {}
        }
    }
}

impl ObjCheck {
    fn vertices(&mut self, bytes: &[u8]) {
        let (mut lines, mut words) = (WordLines::new(bytes), Vec::new());
        while lines.next(&mut words) && self.faults.len() < MAX_FAULTS {
            let (head, rest) = (&words[0], &words[1..]);
            if let Some(part) = part_of(head) {
                let outcome = self.vertices.read(part, head, rest);
                self.faults.extend(outcome.err());
            }
            if matches!(head.bytes, b"l" | b"p") {
                self.ends += rest.len();
            }
            self.switches += usize::from(matches!(head.bytes, b"usemtl" | b"mtllib"));
        }
    }

    /// Checks the faces; they may refer to later vertices.
    fn faces(&mut self, bytes: &[u8]) {
        let (mut lines, mut words, mut so_far) =
            (WordLines::new(bytes), Vec::new(), CornerCounts::default());
        let mut group = 0;
        while lines.next(&mut words) {
            // Count the corner data so far: negative indices refer to them.
            let (head, rest) = (words[0], &words[1..]);
            if let Some(part) = part_of(&head) {
                so_far[part] += 1;
            }
            // Add the primitive of the line.
            let outcome = match head.bytes {
                b"f" | b"fo" if rest.len() >= 3 => self.face(rest, so_far, group),
                b"f" | b"fo" => Err(head.fault("faces need three corners", "the first one")),
                b"l" => self.line(rest, so_far),
                b"p" => self.points(rest, so_far),
                b"curv" | b"curv2" | b"surf" => Err(head.fault(
                    "free-form curves and surfaces are not supported",
                    "the first one",
                )),
                b"usemtl" => {
                    self.material_use.switch(rest, bytes);
                    Ok(())
                }
                b"mtllib" => {
                    self.material_use.library(rest, bytes);
                    Ok(())
                }
                b"s" => {
                    group = smooth::group(rest);
                    Ok(())
                }
                _ => Ok(()),
            };
            // Keep the first fault and the number of all.
            if let Err(fault) = outcome {
                self.not_drawn.get_or_insert((fault, 0)).1 += 1;
            }
        }
    }

    fn face(
        &mut self,
        corners: &[Word<'_>],
        so_far: CornerCounts,
        group: u32,
    ) -> Result<(), WordError> {
        let (mut used, mut without_normal) = ([false; 2], 0);
        for corner in corners {
            let [_, uv, normal] = self.corner(corner, so_far)?;
            used[0] |= uv.is_some();
            used[1] |= normal.is_some();
            without_normal += usize::from(normal.is_none());
        }
        self.used = [self.used[0] | used[0], self.used[1] | used[1]];
        if group != 0 {
            self.smooth_corners += without_normal;
        }
        self.material_use.face(self.triangles);
        self.corners += corners.len();
        self.triangles += corners.len() - 2;
        Ok(())
    }

    /// The indices of a corner; lenient, without a texture coordinate or normal that is not there.
    fn corner(&mut self, corner: &Word<'_>, so_far: CornerCounts) -> Result<Corner, WordError> {
        let total = self.vertices.counts();
        match indices(corner, so_far, total) {
            Err(fault) if self.options.is_lenient && fault.repair.is_some() => {
                self.repaired.get_or_insert((fault, 0)).1 += 1;
                indices_there(corner, so_far, total)
            }
            found => found,
        }
    }

    /// The positions of the words of a line or point statement.
    fn ends(&mut self, words: &[Word<'_>], so_far: CornerCounts) -> Result<Vec<u32>, WordError> {
        let corners = words.iter();
        let corners = corners.map(|corner| self.corner(corner, so_far));
        corners
            .map(|corner| Ok(corner?[0].unwrap_or_default()))
            .collect()
    }

    /// The strokes of the current material.
    fn strokes(&mut self) -> &mut Segments {
        let material = self.material_use.current();
        if self
            .strokes
            .last()
            .is_none_or(|(last, _)| last.text != material.text)
        {
            self.strokes.push((material.clone(), Segments::default()));
        }
        let last = self.strokes.len() - 1;
        &mut self.strokes[last].1
    }

    fn line(&mut self, words: &[Word<'_>], so_far: CornerCounts) -> Result<(), WordError> {
        let ends = self.ends(words, so_far)?;
        self.strokes().row(&ends);
        Ok(())
    }

    fn points(&mut self, words: &[Word<'_>], so_far: CornerCounts) -> Result<(), WordError> {
        let ends = self.ends(words, so_far)?;
        let points = ends.iter().map(|end| [*end; 2]);
        self.strokes().ends.extend(points);
        Ok(())
    }
}

/// Whether a word begins a face.
fn is_face(head: &Word<'_>) -> bool {
    matches!(head.bytes, b"f" | b"fo")
}

/// The counter that a line increments: an index into the parts of a corner.
fn part_of(head: &Word<'_>) -> Option<usize> {
    match head.bytes {
        b"v" => Some(0),
        b"vt" => Some(1),
        b"vn" => Some(2),
        _ => None,
    }
}
