//! Smoothing groups of an OBJ: a corner without a normal has the mean of those of the faces of its
//! group around it, weighed by their angles there (Thürmer and Wüthrich, "Computing vertex normals
//! from polygonal facets", Journal of Graphics Tools 3, 1998).

use super::corner::Corner;
use crate::words::Word;
use rtc_math::{Vec3, acos, to_u32, unit};

/// The normals of the corners of all groups.
#[derive(Default)]
pub(super) struct SmoothNormals {
    /// The groups and vertices that have a normal, in order.
    corners: Vec<(u32, u32)>,
    sums: Vec<Vec3>,
    /// The number of normals in the file itself.
    before: usize,
}

/// The number of a group, 0 for none; `rest` is the text after `s`.
pub(super) fn group(rest: &[Word<'_>]) -> u32 {
    match rest.first() {
        Some(word) if word.bytes == b"on" => 1,
        Some(word) => word
            .integer()
            .ok()
            .and_then(|group| u32::try_from(group).ok())
            .unwrap_or(0),
        None => 0,
    }
}

impl SmoothNormals {
    /// The maximum memory for the given number of corners.
    pub(super) fn at_most(corners: usize) -> u64 {
        // A list that grows by doubling, sums and normals.
        72 * corners as u64
    }

    /// Records the corners of a face that need a normal.
    pub(super) fn request(&mut self, face: &[Corner], group: u32) {
        if group != 0 {
            let bare = face.iter().filter(|[_, _, normal]| normal.is_none());
            self.corners
                .extend(bare.filter_map(|[vertex, ..]| Some((group, (*vertex)?))));
        }
    }

    /// Allocates the sums, once all corners are recorded.
    pub(super) fn begin(&mut self) {
        self.corners.sort_unstable();
        self.corners.dedup();
        self.sums = vec![Vec3::ZERO; self.corners.len()];
    }

    /// Adds the normal of a face to those of its corners.
    pub(super) fn add(&mut self, face: &[Corner], group: u32, positions: &[[f64; 3]]) {
        if group == 0 {
            return;
        }
        let place = |at: usize| {
            let vertex = face[at % face.len()][0].unwrap_or_default();
            Vec3::from_array(positions[vertex as usize])
        };
        let newell = (2..face.len()).fold(Vec3::ZERO, |sum, at| {
            sum + (place(at - 1) - place(0)).cross(place(at) - place(0))
        });
        let Some(normal) = unit(newell) else { return };
        for (at, corner) in face.iter().enumerate() {
            let Some(slot) = self.slot(corner, group) else {
                continue;
            };
            let here = place(at);
            let sides = [at + face.len() - 1, at + 1].map(|other| unit(place(other) - here));
            if let [Some(before), Some(after)] = sides {
                self.sums[slot] += normal * acos(before.dot(after).clamp(-1.0, 1.0));
            }
        }
    }

    /// Puts the normals behind those of the file.
    pub(super) fn finish(&mut self, normals: &mut Vec<[f64; 3]>) {
        self.before = normals.len();
        let means = std::mem::take(&mut self.sums).into_iter();
        normals.extend(means.map(|sum| unit(sum).unwrap_or(Vec3::ZERO).to_array()));
    }

    /// The normal of a corner that has none of its own, as an index.
    pub(super) fn normal(&self, corner: &Corner, group: u32) -> Option<u32> {
        Some(to_u32(self.before + self.slot(corner, group)?))
    }

    fn slot(&self, [vertex, _, normal]: &Corner, group: u32) -> Option<usize> {
        let bare = vertex.filter(|_| normal.is_none() && group != 0)?;
        self.corners.binary_search(&(group, bare)).ok()
    }
}
