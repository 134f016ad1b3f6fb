//! Wavefront OBJ: the lines are read three times, for the vertices, for the faults of the faces,
//! and for the faces; so little is held beside what becomes the mesh, and what that takes is known
//! before.
//!
//! Groups make no difference; which material each face asks for is kept beside the mesh. Corners
//! without a normal, where others have one, are shaded flat.

use super::{MAX_FAULTS, MaterialUse, Parsed, Unread};
use crate::words::{Lines, Word, WordFault, numbers};
use rtc_ir::Mesh;
use rtc_math::Column;
use rtc_source::{Budget, Resource};

/// How many there are of what corners refer to: positions, texture coordinates, normals.
type Counts = [usize; 3];

/// What a corner refers to, from 0.
type Corner = [Option<u32>; 3];

/// What corners refer to, in the order of their parts.
const NOUNS: [&str; 3] = ["vertex", "texture coordinate", "normal"];

/// True if the word opens a statement that OBJ files begin with.
pub(super) fn is_keyword(word: &Word<'_>) -> bool {
    const KEYWORDS: [&[u8]; 16] = [
        b"v", b"vt", b"vn", b"vp", b"f", b"fo", b"l", b"p", b"g", b"o", b"s", b"mg", b"mtllib",
        b"usemtl", b"maplib", b"usemap",
    ];
    KEYWORDS.contains(&word.bytes)
}

/// Reads an OBJ.
pub(super) fn parse(bytes: &[u8], budget: &Budget) -> Result<Parsed, Unread> {
    let mut check = Check::default();
    check.vertices(bytes);
    budget.has(Resource::Memory, MaterialUse::at_most(check.switches))?;
    if check.faults.is_empty() {
        check.faces(bytes);
    }
    if !check.faults.is_empty() {
        return Err(Unread::Faults(check.faults));
    }
    budget.charge(Resource::Memory, MaterialUse::at_most(check.switches))?;
    let mesh = check.mesh(bytes, budget)?;
    Ok(Parsed {
        mesh,
        not_drawn: check.not_drawn,
        material_use: check.material_use,
    })
}

/// What was checked, and what was found.
#[derive(Default)]
struct Check {
    vertices: Vertices,
    /// The corners of all faces.
    corners: usize,
    /// How many triangles the faces have.
    triangles: usize,
    /// Whether any corner has a texture coordinate, and a normal.
    used: [bool; 2],
    /// How many lines ask for another material.
    switches: usize,
    material_use: MaterialUse,
    faults: Vec<WordFault>,
    not_drawn: Option<(WordFault, usize)>,
}

/// What corners refer to.
#[derive(Default)]
struct Vertices {
    positions: Vec<[f64; 3]>,
    uvs: Vec<[f64; 2]>,
    normals: Vec<[f64; 3]>,
}

impl Vertices {
    fn counts(&self) -> Counts {
        [self.positions.len(), self.uvs.len(), self.normals.len()]
    }

    fn read(&mut self, part: usize, head: &Word<'_>, rest: &[Word<'_>]) -> Result<(), WordFault> {
        match part {
            0 => self.positions.push(numbers(head, rest)?),
            // A height of a texture is rarely written.
            1 if rest.len() == 1 => self.uvs.push([rest[0].number()?, 0.0]),
            1 => self.uvs.push(numbers(head, rest)?),
            _ => self.normals.push(numbers(head, rest)?),
        }
        Ok(())
    }
}

impl Check {
    fn vertices(&mut self, bytes: &[u8]) {
        let (mut lines, mut words) = (Lines::new(bytes), Vec::new());
        while lines.next(&mut words) && self.faults.len() < MAX_FAULTS {
            let (head, rest) = (&words[0], &words[1..]);
            if let Some(part) = part_of(head) {
                let outcome = self.vertices.read(part, head, rest);
                self.faults.extend(outcome.err());
            }
            self.switches += usize::from(matches!(head.bytes, b"usemtl" | b"mtllib"));
        }
    }

    /// Checks the faces; what they refer to may follow them.
    fn faces(&mut self, bytes: &[u8]) {
        let (mut lines, mut words, mut so_far) = (Lines::new(bytes), Vec::new(), Counts::default());
        while lines.next(&mut words) && self.faults.len() < MAX_FAULTS {
            let (head, rest) = (words[0], &words[1..]);
            if let Some(part) = part_of(&head) {
                so_far[part] += 1;
            }
            match head.bytes {
                b"f" | b"fo" if rest.len() >= 3 => {
                    let outcome = self.face(rest, so_far);
                    self.faults.extend(outcome.err());
                }
                b"f" | b"fo" => self.skip(&head, "faces need three corners"),
                b"usemtl" => self.material_use.switch(rest, bytes),
                b"mtllib" => self.material_use.library(rest, bytes),
                b"l" | b"p" => self.skip(&head, "lines and points have no surface"),
                b"curv" | b"curv2" | b"surf" => {
                    self.skip(&head, "free-form curves and surfaces are not supported")
                }
                _ => {}
            }
        }
    }

    fn face(&mut self, corners: &[Word<'_>], so_far: Counts) -> Result<(), WordFault> {
        for corner in corners {
            let [_, uv, normal] = indices(corner, so_far, self.vertices.counts())?;
            self.used[0] |= uv.is_some();
            self.used[1] |= normal.is_some();
        }
        self.material_use.face(self.triangles);
        self.corners += corners.len();
        self.triangles += corners.len() - 2;
        Ok(())
    }

    fn skip(&mut self, head: &Word<'_>, why: &str) {
        self.not_drawn
            .get_or_insert_with(|| (head.fault(why, "the first one"), 0))
            .1 += 1;
    }

    /// The mesh of a file without faults.
    fn mesh(&mut self, bytes: &[u8], budget: &Budget) -> Result<Mesh, Unread> {
        let is_plain = self.used == [false; 2];
        // A corner, and its number, while equal ones are looked for.
        let passing = if is_plain {
            4 * self.vertices.positions.len()
        } else {
            20 * self.corners
        };
        let vertex = 24 + 16 * usize::from(self.used[0]) + 24 * usize::from(self.used[1]);
        let at_most = if is_plain {
            self.vertices.positions.len().min(self.corners)
        } else {
            self.corners
        };
        budget.has(
            Resource::Memory,
            (passing + vertex * at_most + 12 * self.triangles) as u64,
        )?;
        let mesh = if is_plain {
            self.plain(bytes)
        } else {
            self.merged(bytes)
        };
        let vertices = mesh.positions.len();
        budget.charge(Resource::Vertices, vertices as u64)?;
        budget.charge(
            Resource::Memory,
            (vertex * vertices + 12 * self.triangles) as u64,
        )?;
        Ok(mesh)
    }

    /// The mesh of a file whose corners are positions alone: those that are used, in the order of
    /// their first use.
    fn plain(&mut self, bytes: &[u8]) -> Mesh {
        const UNUSED: u32 = u32::MAX;
        let mut vertex_of = vec![UNUSED; self.vertices.positions.len()];
        let (mut positions, mut triangles) = (Vec::new(), Vec::with_capacity(self.triangles));
        self.each_face(bytes, |face| {
            let mut vertex = |corner: &Corner| {
                let at = corner[0].unwrap_or_default() as usize;
                if vertex_of[at] == UNUSED {
                    vertex_of[at] = to_u32(positions.len());
                    positions.push(self.vertices.positions[at]);
                }
                vertex_of[at]
            };
            let (first, mut last) = (vertex(&face[0]), vertex(&face[1]));
            triangles.extend(face[2..].iter().map(|corner| {
                let before = std::mem::replace(&mut last, vertex(corner));
                [first, before, last]
            }));
        });
        Mesh {
            positions: positions.into(),
            triangles: triangles.into(),
            ..Mesh::default()
        }
    }

    /// The mesh of a file whose corners are more than positions.
    fn merged(&mut self, bytes: &[u8]) -> Mesh {
        let [_, uvs, normals] = self.vertices.counts();
        let mut sorted = Vec::with_capacity(self.corners);
        let mut triangles = Vec::with_capacity(self.triangles);
        self.each_face(bytes, |face| {
            let first = to_u32(sorted.len());
            // Those that have none share one of zeros.
            let used = |part: usize, index: Option<u32>, none: usize| {
                if self.used[part] {
                    index.unwrap_or(to_u32(none))
                } else {
                    0
                }
            };
            for (at, [v, vt, vn]) in (first..).zip(face) {
                sorted.push([
                    v.unwrap_or_default(),
                    used(0, *vt, uvs),
                    used(1, *vn, normals),
                    at,
                ]);
            }
            triangles.extend(
                (first + 1..to_u32(sorted.len()) - 1).map(|corner| [first, corner, corner + 1]),
            );
        });
        self.merge(sorted, triangles)
    }

    /// Makes one vertex of equal corners, in the order in which they are first used.
    fn merge(&mut self, mut sorted: Vec<[u32; 4]>, mut triangles: Vec<[u32; 3]>) -> Mesh {
        sorted.sort_unstable();
        let same = |a: &[u32; 4], b: &[u32; 4]| a[..3] == b[..3];
        // Of each corner the first that is equal, and then the vertex.
        let mut vertex_of = vec![0; sorted.len()];
        for equal in sorted.chunk_by(same) {
            equal
                .iter()
                .for_each(|corner| vertex_of[corner[3] as usize] = equal[0][3]);
        }
        let mut count = 0_u32;
        for corner in 0..vertex_of.len() {
            let first = vertex_of[corner] as usize;
            if first == corner {
                vertex_of[corner] = count;
                count += 1;
            } else {
                vertex_of[corner] = vertex_of[first];
            }
        }
        for triangle in &mut triangles {
            *triangle = triangle.map(|corner| vertex_of[corner as usize]);
        }
        sorted.dedup_by(|b, a| same(a, b));
        sorted.shrink_to_fit();
        sorted.sort_unstable_by_key(|corner| corner[3]);
        drop(vertex_of);
        let Vertices {
            positions,
            uvs,
            normals,
        } = std::mem::take(&mut self.vertices);
        fn pick<const N: usize>(sorted: &[[u32; 4]], part: usize, from: &[[f64; N]]) -> Column<N> {
            sorted
                .iter()
                .map(|corner| from.get(corner[part] as usize).copied().unwrap_or([0.0; N]))
                .collect()
        }
        Mesh {
            positions: pick(&sorted, 0, &positions),
            uvs: if self.used[0] {
                pick(&sorted, 1, &uvs)
            } else {
                Column::default()
            },
            normals: if self.used[1] {
                pick(&sorted, 2, &normals)
            } else {
                Column::default()
            },
            triangles: triangles.into(),
            ..Mesh::default()
        }
    }

    /// The corners of each face of a file without faults.
    fn each_face(&self, bytes: &[u8], mut take: impl FnMut(&[Corner])) {
        let (mut lines, mut words, mut so_far) = (Lines::new(bytes), Vec::new(), Counts::default());
        let (total, mut corners) = (self.vertices.counts(), Vec::new());
        while lines.next(&mut words) {
            if let Some(part) = part_of(&words[0]) {
                so_far[part] += 1;
            }
            if matches!(words[0].bytes, b"f" | b"fo") && words.len() > 3 {
                corners.clear();
                corners.extend(
                    words[1..]
                        .iter()
                        .filter_map(|corner| indices(corner, so_far, total).ok()),
                );
                take(&corners);
            }
        }
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

/// The indices of a corner, from 0: `v`, `v/vt`, `v//vn` or `v/vt/vn`, each from 1 or, negative,
/// from the last so far.
fn indices(corner: &Word<'_>, so_far: Counts, total: Counts) -> Result<Corner, WordFault> {
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
            *slot = Some(resolve(&index, NOUNS[part], so_far[part], total[part])?);
        }
    }
    Ok(found)
}

fn resolve(index: &Word<'_>, noun: &str, so_far: usize, total: usize) -> Result<u32, WordFault> {
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
                format!("{so_far} stand before it")
            } else {
                format!("the file has {total}")
            };
            index.fault(
                format!("a face refers to {noun} {number}, and {there}"),
                format!("there is no such {noun}"),
            )
        })
}

/// A count of what a file holds.
fn to_u32(count: usize) -> u32 {
    u32::try_from(count).expect("the loader refuses files of 4 GiB and more")
}
