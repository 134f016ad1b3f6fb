//! Eight boxes or four triangles against one ray at once, in single precision.
//!
//! Each level of [`super::simd`] does the same operations in the same order, and none of them is a
//! fused one: so all find the same.

use crate::render::accel::beam::Beam;
use fearless_simd::prelude::*;
use fearless_simd::{Simd, f32x4, f32x8};

/// Children of a node.
pub(in crate::render::accel) const WIDTH: usize = 8;

/// Triangles of a leaf.
pub(in crate::render::accel) const TRIANGLES: usize = 4;

/// A node: for each axis the lower and the upper ends of eight boxes, then eight links as the bits of
/// numbers; four cache lines.
pub(in crate::render::accel) type WideNode = [f32; 64];

/// Where the links of a node are.
pub(in crate::render::accel) const LINKS: usize = 6 * WIDTH;

/// A leaf: for each corner and axis the coordinates of four triangles, then their items as the bits
/// of numbers.
pub(in crate::render::accel) type WideLeaf = [f32; 40];

/// Where the items of a leaf are.
pub(in crate::render::accel) const ITEMS: usize = 9 * TRIANGLES;

/// Where a coordinate of a corner of the first triangle of a leaf is.
#[inline(always)]
pub(in crate::render::accel) const fn place(corner: usize, axis: usize) -> usize {
    (3 * corner + axis) * TRIANGLES
}

#[inline(always)]
fn eights<S: Simd>(simd: S, [x, y, z]: [f32; 3]) -> [f32x8<S>; 3] {
    [
        f32x8::splat(simd, x),
        f32x8::splat(simd, y),
        f32x8::splat(simd, z),
    ]
}

#[inline(always)]
fn fours<S: Simd>(simd: S, [x, y, z]: [f32; 3]) -> [f32x4<S>; 3] {
    [
        f32x4::splat(simd, x),
        f32x4::splat(simd, y),
        f32x4::splat(simd, z),
    ]
}

/// What of a beam boxes are met by.
#[derive(Clone, Copy)]
pub(in crate::render::accel) struct BoxLanes<S: Simd> {
    near_origin: [f32x8<S>; 3],
    far_origin: [f32x8<S>; 3],
    inverse: [f32x8<S>; 3],
    /// Where the nearer ends of boxes are among those of an axis.
    near: [usize; 3],
}

impl<S: Simd> BoxLanes<S> {
    #[inline(always)]
    pub(in crate::render::accel) fn new(simd: S, beam: &Beam) -> Self {
        Self {
            near_origin: eights(simd, beam.near_origin),
            far_origin: eights(simd, beam.far_origin),
            inverse: eights(simd, beam.inverse),
            near: beam.down.map(|down| if down { WIDTH } else { 0 }),
        }
    }

    /// Where the beam enters the slabs of an axis.
    #[inline(always)]
    fn enter<const AXIS: usize>(&self, simd: S, node: &WideNode) -> f32x8<S> {
        let at = 2 * WIDTH * AXIS + (self.near[AXIS] & WIDTH);
        let ends = f32x8::from_slice(simd, &node[at..at + WIDTH]);
        (ends - self.near_origin[AXIS]) * self.inverse[AXIS]
    }

    /// Where the beam leaves the slabs of an axis.
    #[inline(always)]
    fn leave<const AXIS: usize>(&self, simd: S, node: &WideNode) -> f32x8<S> {
        let at = 2 * WIDTH * AXIS + (!self.near[AXIS] & WIDTH);
        let ends = f32x8::from_slice(simd, &node[at..at + WIDTH]);
        (ends - self.far_origin[AXIS]) * self.inverse[AXIS]
    }

    /// Which boxes of a node the beam may meet before `limit`, as bits, and where.
    ///
    /// As in Ize, "Robust BVH ray traversal" (JCGT 2, 2013): the far end grows by more than the
    /// relative errors of both.
    #[inline(always)]
    pub(in crate::render::accel) fn meet(
        &self,
        simd: S,
        node: &WideNode,
        limit: f32,
    ) -> (u32, [f32; WIDTH]) {
        const GROWN: f32 = 1.0 + 16.0 * f32::EPSILON;
        let enter = self
            .enter::<0>(simd, node)
            .max(self.enter::<1>(simd, node))
            .max(self.enter::<2>(simd, node).max(f32x8::splat(simd, 0.0)));
        let leave = self
            .leave::<0>(simd, node)
            .min(self.leave::<1>(simd, node))
            .min(self.leave::<2>(simd, node))
            * f32x8::splat(simd, GROWN);
        let met = enter.simd_le(leave.min(f32x8::splat(simd, limit)));
        (bits(met.to_bitmask()), enter.into())
    }
}

/// The bits of at most 32 lanes.
#[inline(always)]
#[expect(clippy::cast_possible_truncation, reason = "there are 8 lanes at most")]
fn bits(mask: u64) -> u32 {
    mask as u32
}

/// Corners of four triangles after the shear that turns the beam into its main axis.
type Sheared<S> = [f32x4<S>; 3];

/// What of a beam triangles are hit by.
#[derive(Clone, Copy)]
pub(in crate::render::accel) struct TriangleLanes<S: Simd> {
    axes: [usize; 3],
    origin: [f32x4<S>; 3],
    main: f32x4<S>,
    slopes: [f32x4<S>; 2],
    error: f32x4<S>,
}

/// Which triangles of a leaf a beam may hit, and which of them it hits for sure, as bits.
#[derive(Clone, Copy)]
pub(in crate::render::accel) struct LeafVerdict {
    pub(in crate::render::accel) may: u32,
    pub(in crate::render::accel) sure: u32,
}

impl<S: Simd> TriangleLanes<S> {
    #[inline(always)]
    pub(in crate::render::accel) fn new(simd: S, beam: &Beam) -> Self {
        let [x, y] = beam.slopes;
        Self {
            axes: beam.axes,
            origin: fours(simd, beam.origin),
            main: f32x4::splat(simd, beam.main),
            slopes: [f32x4::splat(simd, x), f32x4::splat(simd, y)],
            error: f32x4::splat(simd, beam.error),
        }
    }

    /// A corner as seen from the origin, along the k-th axis of the beam.
    #[inline(always)]
    fn seen<const CORNER: usize>(&self, simd: S, leaf: &WideLeaf, k: usize) -> f32x4<S> {
        let at = place(CORNER, self.axes[k]);
        f32x4::from_slice(simd, &leaf[at..at + TRIANGLES]) - self.origin[k]
    }

    #[inline(always)]
    fn sheared<const CORNER: usize>(&self, simd: S, leaf: &WideLeaf) -> Sheared<S> {
        let along = self.seen::<CORNER>(simd, leaf, 2) * self.main;
        [
            self.seen::<CORNER>(simd, leaf, 0) - along * self.slopes[0],
            self.seen::<CORNER>(simd, leaf, 1) - along * self.slopes[1],
            along,
        ]
    }

    /// Which triangles of a leaf the beam may hit before `limit`; if `SURE`, also which it surely
    /// hits before `sure_limit`.
    ///
    /// The signs of the edge functions are those of exact arithmetic where they exceed a bound on
    /// their error: a triangle with two sure signs that differ is missed, one with three that agree
    /// is hit.
    #[inline(always)]
    pub(in crate::render::accel) fn judge<const SURE: bool>(
        &self,
        simd: S,
        leaf: &WideLeaf,
        [limit, sure_limit]: [f32; 2],
    ) -> LeafVerdict {
        let error = self.error;
        let a = self.sheared::<0>(simd, leaf);
        let b = self.sheared::<1>(simd, leaf);
        let c = self.sheared::<2>(simd, leaf);
        let (u, v, w) = (edge(&c, &b), edge(&a, &c), edge(&b, &a));
        // Products of coordinates of size m with errors e: 4·m·e + 2·e², and 3 roundings of each
        // product.
        let size = size_of(&a).max(size_of(&b)).max(size_of(&c)) + error;
        let relative = f32x4::splat(simd, 8.0 * f32::EPSILON);
        let bound = size * (size * relative + error * f32x4::splat(simd, 6.0));
        let (min, max) = (u.min(v).min(w), u.max(v).max(w));
        let outside = min.simd_lt(-bound) & max.simd_gt(bound);
        let nearest = a[2].min(b[2]).min(c[2]) - error;
        let farthest = a[2].max(b[2]).max(c[2]) + error;
        let beyond =
            nearest.simd_gt(f32x4::splat(simd, limit)) | farthest.simd_lt(f32x4::splat(simd, 0.0));
        let may = !bits((outside | beyond).to_bitmask()) & 0b1111;
        if !SURE {
            return LeafVerdict { may, sure: 0 };
        }
        let inside = min.simd_gt(bound) | max.simd_lt(-bound);
        let between = nearest.simd_gt(error) & farthest.simd_lt(f32x4::splat(simd, sure_limit));
        let sure = bits((inside & between).to_bitmask()) & may;
        LeafVerdict { may, sure }
    }
}

/// The larger of the sizes of both coordinates across the beam.
#[inline(always)]
fn size_of<S: Simd>(corner: &Sheared<S>) -> f32x4<S> {
    corner[0].abs().max(corner[1].abs())
}

/// The edge function of the edge between two corners.
#[inline(always)]
fn edge<S: Simd>(p: &Sheared<S>, q: &Sheared<S>) -> f32x4<S> {
    p[0] * q[1] - p[1] * q[0]
}
