//! Builds the mesh of an OBJ, after its contents are checked and counted against the budget.

use super::corner::{Corner, CornerCounts, indices, indices_there};
use super::smooth::SmoothNormals;
use super::{ObjCheck, ObjVertices, is_face, part_of};
use crate::mesh::polygon::EarClipper;
use crate::mesh::stroke::{Segments, StrokeMesher, join};
use crate::mesh::{SpannedName, TextParseError};
use crate::words::WordLines;
use rtc_ir::Mesh;
use rtc_math::{VertexColumn, to_u32};
use rtc_source::{Budget, LimitExceeded, Resource};

impl ObjCheck {
    /// The mesh of a file without errors.
    pub(super) fn mesh(&mut self, bytes: &[u8], budget: &Budget) -> Result<Mesh, TextParseError> {
        let smoothing = self.smoothing(bytes, budget)?;
        let is_plain = self.used == [false; 2];
        // The temporary memory of the map that merges equal corners.
        let passing = if is_plain {
            4 * self.vertices.positions.len()
        } else {
            20 * self.corners
        };
        let colors = 16 * usize::from(!self.vertices.tints.is_empty());
        let vertex = 24 + 16 * usize::from(self.used[0]) + 24 * usize::from(self.used[1]) + colors;
        let at_most = if is_plain {
            self.vertices.positions.len().min(self.corners)
        } else {
            self.corners
        };
        budget.has(
            Resource::Memory,
            (passing + vertex * at_most + 12 * self.triangles) as u64,
        )?;
        let strokes = self.drawn_meshes(budget)?;
        let mut mesh = if is_plain {
            self.plain(bytes)
        } else {
            self.merged(bytes, smoothing)
        };
        let mut count = mesh.triangles.len();
        for (named, stroke) in &strokes {
            self.material_use.resume(named.clone());
            self.material_use.face(count);
            count += stroke.triangles.len();
        }
        join(
            &mut mesh,
            strokes.into_iter().map(|(_, stroke)| stroke).collect(),
        );
        Ok(mesh)
    }

    /// The normals of the smoothing groups, beside those of the file.
    fn smoothing(&mut self, bytes: &[u8], budget: &Budget) -> Result<SmoothNormals, LimitExceeded> {
        let mut smoothing = SmoothNormals::default();
        if self.smooth_corners > 0 {
            budget.has(
                Resource::Memory,
                SmoothNormals::at_most(self.smooth_corners),
            )?;
            self.each_face(bytes, |face, group| smoothing.request(face, group));
            smoothing.begin();
            self.each_face(bytes, |face, group| {
                smoothing.add(face, group, &self.vertices.positions);
            });
            smoothing.finish(&mut self.vertices.normals);
            self.used[1] = true;
        }
        Ok(smoothing)
    }

    /// The strokes of lines and points, each with its material; all vertices as points if there is
    /// nothing else.
    fn drawn_meshes(&mut self, budget: &Budget) -> Result<Vec<(SpannedName, Mesh)>, LimitExceeded> {
        let has_nothing = self.triangles == 0 && self.not_drawn.is_none();
        if self.strokes.is_empty() && !has_nothing {
            return Ok(Vec::new());
        }
        let count = self.vertices.positions.len();
        budget.has(Resource::Memory, 40 * count as u64)?;
        let source = Mesh {
            positions: self.vertices.positions.clone().into(),
            colors: self.vertices.tints.clone().column(),
            ..Mesh::default()
        };
        let mut strokes = std::mem::take(&mut self.strokes);
        if strokes.is_empty() {
            let current = self.material_use.current().clone();
            strokes.push((current, Segments::points(&source)));
        }
        let mesher = StrokeMesher::new(&source, self.options, budget);
        let mut drawn_meshes = Vec::new();
        for (named, strokes) in strokes {
            let polygon = mesher.draw(strokes)?;
            drawn_meshes.extend(polygon.into_iter().map(|mesh| (named.clone(), mesh)));
        }
        Ok(drawn_meshes)
    }

    /// The mesh of a file whose corners are positions only: the used ones, in the order of first
    /// use.
    fn plain(&mut self, bytes: &[u8]) -> Mesh {
        const UNUSED: u32 = u32::MAX;
        let mut vertex_of = vec![UNUSED; self.vertices.positions.len()];
        let (mut used, mut triangles) = (Vec::new(), Vec::with_capacity(self.triangles));
        let (all, mut clipper) = (&self.vertices.positions, EarClipper::new(self.corners));
        let mut polygon = Vec::new();
        self.each_face(bytes, |face, _| {
            polygon.clear();
            polygon.extend(face.iter().map(|corner| {
                let at = corner[0].unwrap_or_default();
                let vertex = &mut vertex_of[at as usize];
                if *vertex == UNUSED {
                    *vertex = to_u32(used.len());
                    used.push(at);
                }
                *vertex
            }));
            let position = |at: usize| all[used[polygon[at] as usize] as usize];
            let take = |three: [usize; 3]| triangles.push(three.map(|at| polygon[at]));
            clipper.cut(face.len(), position, take);
        });
        let ObjVertices {
            positions, tints, ..
        } = std::mem::take(&mut self.vertices);
        Mesh {
            positions: VertexColumn::from(positions).pick(&used),
            colors: tints.column().pick(&used),
            triangles: triangles.into(),
            ..Mesh::default()
        }
    }

    /// The mesh of a file whose corners are more than positions.
    fn merged(&mut self, bytes: &[u8], smoothing: SmoothNormals) -> Mesh {
        let [_, uvs, normals] = self.vertices.counts();
        let mut sorted = Vec::with_capacity(self.corners);
        let mut triangles = Vec::with_capacity(self.triangles);
        let (all, mut clipper) = (&self.vertices.positions, EarClipper::new(self.corners));
        self.each_face(bytes, |face, group| {
            let first = to_u32(sorted.len());
            // Those that have none share one of zeros.
            let used = |part: usize, index: Option<u32>, none: usize| {
                if self.used[part] {
                    index.unwrap_or(to_u32(none))
                } else {
                    0
                }
            };
            for (at, corner) in (first..).zip(face) {
                let [v, vt, vn] = *corner;
                sorted.push([
                    v.unwrap_or_default(),
                    used(0, vt, uvs),
                    used(1, vn.or_else(|| smoothing.normal(corner, group)), normals),
                    at,
                ]);
            }
            let position = |at: usize| all[face[at][0].unwrap_or_default() as usize];
            let take = |three: [usize; 3]| triangles.push(three.map(|at| first + to_u32(at)));
            clipper.cut(face.len(), position, take);
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
        let ObjVertices {
            positions,
            uvs,
            normals,
            tints,
        } = std::mem::take(&mut self.vertices);
        fn pick<const N: usize>(
            sorted: &[[u32; 4]],
            part: usize,
            from: &[[f64; N]],
        ) -> VertexColumn<N> {
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
                VertexColumn::default()
            },
            normals: if self.used[1] {
                pick(&sorted, 2, &normals)
            } else {
                VertexColumn::default()
            },
            colors: tints
                .column()
                .pick(&sorted.iter().map(|corner| corner[0]).collect::<Vec<_>>()),
            triangles: triangles.into(),
            ..Mesh::default()
        }
    }

    /// The corners of each face that shows, and its smoothing group.
    fn each_face(&self, bytes: &[u8], mut take: impl FnMut(&[Corner], u32)) {
        let (mut lines, mut words, mut so_far) =
            (WordLines::new(bytes), Vec::new(), CornerCounts::default());
        let (total, mut corners, mut group) = (self.vertices.counts(), Vec::new(), 0);
        let indices = match self.options.is_lenient {
            true => indices_there,
            false => indices,
        };
        while lines.next(&mut words) {
            let (head, rest) = (&words[0], &words[1..]);
            if let Some(part) = part_of(head) {
                so_far[part] += 1;
            }
            if head.bytes == b"s" {
                group = super::smooth::group(rest);
            }
            if is_face(head) && rest.len() > 2 {
                corners.clear();
                let polygon = rest
                    .iter()
                    .map_while(|corner| indices(corner, so_far, total).ok());
                corners.extend(polygon);
                if corners.len() == rest.len() {
                    take(&corners, group);
                }
            }
        }
    }
}
