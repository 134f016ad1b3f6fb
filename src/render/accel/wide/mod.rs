//! An 8-wide BVH over triangles. It finds candidates; the visitor computes the hits.
//!
//! A node has the boxes of up to eight children, a leaf the corners of up to four triangles, both
//! in f32 in a cube around the geometry. One SIMD operation tests all of them against a ray.

mod build;
mod split;
mod stored;
mod traverse;

use crate::accel::conservative_ray::QuantizationFrame;
use crate::accel::lanes::{TRIANGLES, TriangleRow, WIDTH, WideLeaf, WideNode, place};
use crate::accel::pages::PagedRows;
use crate::accel::simd::SimdLevel;
use arrayvec::ArrayVec;
pub(crate) use build::{BvhBuilders, MOST};
use rtc_math::Vec3;
pub(crate) use stored::{BvhTopology, VERSION};
pub(crate) use traverse::TriangleVisitor;

/// Below this depth the heuristic chooses; above it the middle, which needs at most 12 more.
const HEURISTIC_DEPTH: usize = 16;

/// The levels of nodes at most.
const MAX_DEPTH: usize = HEURISTIC_DEPTH + 12;

/// The traversal stack, with the entry point of each node: a level adds at most seven children.
type TraversalStack = ArrayVec<(f32, u32), { MAX_DEPTH * (WIDTH - 1) + 1 }>;

/// The bit of a link that leads to a leaf; the two lowest are then one less than the triangles in
/// it, those between are its first row.
const LEAF: u32 = 1 << 31;

/// The link to a child that is not there.
const NONE: u32 = u32::MAX;

/// The BVH.
#[derive(Debug)]
pub(crate) struct WideBvh {
    simd: SimdLevel,
    frame: QuantizationFrame,
    nodes: PagedRows<WideNode>,
    /// The triangles of a leaf together.
    triangles: PagedRows<TriangleRow>,
    root: u32,
    /// What 1 of the cube is in space, if leaves hold all corners exactly.
    unit: Option<f64>,
}

impl WideBvh {
    /// Has candidates come without corners.
    pub(crate) fn forget_corners(&mut self) {
        self.unit = None;
    }
}

/// A triangle that a ray may hit.
#[derive(Clone, Copy)]
pub(crate) struct Candidate<'traverse> {
    /// Its number.
    pub(crate) item: u32,
    leaf: WideLeaf<'traverse>,
    lane: usize,
    unit: Option<f64>,
    /// Whether the instructions of the traversal fuse products and sums.
    pub(crate) is_fused: bool,
}

impl Candidate<'_> {
    /// Its corners, if they are here with every bit.
    #[inline(always)]
    pub(crate) fn corners(&self) -> Option<[Vec3; 3]> {
        let unit = self.unit?;
        let number =
            |corner, axis| f64::from(self.leaf.number(place(corner, axis), self.lane)) * unit;
        let point = |corner| Vec3::new(number(corner, 0), number(corner, 1), number(corner, 2));
        Some([point(0), point(1), point(2)])
    }
}

/// The leaf that a link leads to.
#[inline(always)]
fn leaf_at(rows: &[TriangleRow], link: u32) -> WideLeaf<'_> {
    let (first, count) = leaf_rows(link);
    WideLeaf::new(rows, first, count)
}

/// The first row of the leaf that a link leads to, and the number of its triangles.
#[inline(always)]
fn leaf_rows(link: u32) -> (usize, usize) {
    let (first, less) = ((link & !LEAF) >> 2, link & (TRIANGLES as u32 - 1));
    (first as usize, less as usize + 1)
}

#[cfg(test)]
mod tests;
