//! SIMD tests in f32: eight boxes or four triangles against one ray.
//!
//! Each level of [`super::simd`] does the same operations in the same order, without fused
//! multiply-add, so all levels give the same bits.

use crate::accel::conservative_ray::ConservativeRay;
use fearless_simd::prelude::*;
use fearless_simd::{Simd, f32x4, f32x8};

/// Children of a node.
pub(in crate::accel) const WIDTH: usize = 8;

/// Triangles of a leaf.
pub(in crate::accel) const TRIANGLES: usize = 4;

/// A node: for each axis the lower and the upper ends of eight boxes, then eight links as the bits
/// of numbers; four cache lines.
pub(in crate::accel) type WideNode = [f32; 64];

/// The offset of the links in a node.
pub(in crate::accel) const LINKS: usize = 6 * WIDTH;

/// A triangle in a BVH: the nine coordinates of its corners, and its item as the bits of a number.
/// The triangles of a leaf share their rows.
pub(in crate::accel) type TriangleRow = [f32; ITEM + 1];

/// The minimum number of rows after the first row of each leaf.
pub(in crate::accel) const ROWS_AFTER: usize = 6;

/// The maximum number of values read per leaf.
const SEEN: usize = 64;

/// A leaf of one to four triangles: for each corner and axis the coordinates of all of them, then
/// their items.
#[derive(Clone, Copy)]
pub(in crate::accel) struct WideLeaf<'rows> {
    /// Its numbers, and some of the following leaves: so four can be read at any position without a
    /// bounds check.
    numbers: &'rows [f32],
    count: usize,
}

impl<'rows> WideLeaf<'rows> {
    /// The leaf of `count` triangles whose first row is `first`.
    #[inline(always)]
    pub(in crate::accel) fn new(rows: &'rows [TriangleRow], first: usize, count: usize) -> Self {
        let numbers = rows[first..][..=ROWS_AFTER].as_flattened();
        Self { numbers, count }
    }

    /// The number of its triangles.
    #[inline(always)]
    pub(in crate::accel) fn count(&self) -> usize {
        self.count
    }

    /// A number of one of its triangles.
    #[inline(always)]
    pub(in crate::accel) fn number(&self, place: usize, lane: usize) -> f32 {
        self.numbers[(place * self.count + lane) & (SEEN - 1)]
    }

    /// The item of one of its triangles.
    #[inline(always)]
    pub(in crate::accel) fn item(&self, lane: usize) -> u32 {
        self.number(ITEM, lane).to_bits()
    }

    /// One number of all its triangles; lanes beyond them are unspecified.
    #[inline(always)]
    fn numbers<S: Simd>(&self, simd: S, place: usize) -> f32x4<S> {
        let at = (place * self.count) & (SEEN - 1);
        f32x4::from_slice(simd, &self.numbers[at..at + TRIANGLES])
    }
}

/// The factor on the far ends of boxes: more than the relative errors of both ends.
pub(in crate::accel) const FAR_SCALE: f32 = 1.0 + 16.0 * f32::EPSILON;

/// Which of the numbers of a triangle is its item.
pub(in crate::accel) const ITEM: usize = 9;

/// Which of the numbers of a triangle is a coordinate of a corner.
#[inline(always)]
pub(in crate::accel) const fn place(corner: usize, axis: usize) -> usize {
    3 * corner + axis
}

#[inline(always)]
fn splat8<S: Simd>(simd: S, [x, y, z]: [f32; 3]) -> [f32x8<S>; 3] {
    [
        f32x8::splat(simd, x),
        f32x8::splat(simd, y),
        f32x8::splat(simd, z),
    ]
}

#[inline(always)]
fn splat4<S: Simd>(simd: S, [x, y, z]: [f32; 3]) -> [f32x4<S>; 3] {
    [
        f32x4::splat(simd, x),
        f32x4::splat(simd, y),
        f32x4::splat(simd, z),
    ]
}

/// The offsets of the nearer ends of boxes, per axis.
#[inline(always)]
fn nearer_ends([x, y, z]: [bool; 3]) -> [usize; 3] {
    let nearer = |down: bool| if down { WIDTH } else { 0 };
    [nearer(x), nearer(y), nearer(z)]
}

/// The data of a conservative ray for tests of boxes.
#[derive(Clone, Copy)]
pub(in crate::accel) struct BoxLanes<S: Simd> {
    near_origin: [f32x8<S>; 3],
    far_origin: [f32x8<S>; 3],
    inverse: [f32x8<S>; 3],
    /// The offsets of the nearer ends of boxes, per axis.
    near: [usize; 3],
}

impl<S: Simd> BoxLanes<S> {
    #[inline(always)]
    pub(in crate::accel) fn new(simd: S, conservative_ray: &ConservativeRay) -> Self {
        Self {
            near_origin: splat8(simd, conservative_ray.near_origin),
            far_origin: splat8(simd, conservative_ray.far_origin),
            inverse: splat8(simd, conservative_ray.inverse),
            near: nearer_ends(conservative_ray.down),
        }
    }

    /// The t where the conservative ray enters the slabs of an axis.
    #[inline(always)]
    fn enter<const AXIS: usize>(&self, simd: S, node: &WideNode) -> f32x8<S> {
        let at = 2 * WIDTH * AXIS + (self.near[AXIS] & WIDTH);
        let ends = f32x8::from_slice(simd, &node[at..at + WIDTH]);
        (ends - self.near_origin[AXIS]) * self.inverse[AXIS]
    }

    /// The t where the conservative ray leaves the slabs of an axis.
    #[inline(always)]
    fn leave<const AXIS: usize>(&self, simd: S, node: &WideNode) -> f32x8<S> {
        let at = 2 * WIDTH * AXIS + (!self.near[AXIS] & WIDTH);
        let ends = f32x8::from_slice(simd, &node[at..at + WIDTH]);
        (ends - self.far_origin[AXIS]) * self.inverse[AXIS]
    }

    /// The boxes of a node that the conservative ray may hit before `t_far`, as bits, and their
    /// entry points.
    ///
    /// As in Ize, "Robust BVH ray traversal" (JCGT 2, 2013): the far end is [`FAR_SCALE`].
    #[inline(always)]
    pub(in crate::accel) fn meet(
        &self,
        simd: S,
        node: &WideNode,
        t_far: f32,
    ) -> (u32, [f32; WIDTH]) {
        let enter = self
            .enter::<0>(simd, node)
            .max(self.enter::<1>(simd, node))
            .max(self.enter::<2>(simd, node).max(f32x8::splat(simd, 0.0)));
        let leave = self
            .leave::<0>(simd, node)
            .min(self.leave::<1>(simd, node))
            .min(self.leave::<2>(simd, node))
            * f32x8::splat(simd, FAR_SCALE);
        let hits = enter.simd_le(leave.min(f32x8::splat(simd, t_far)));
        (bits(hits.to_bitmask()), enter.into())
    }
}

/// The bits of at most 32 lanes.
#[inline(always)]
#[expect(clippy::cast_possible_truncation, reason = "there are 8 lanes at most")]
fn bits(mask: u64) -> u32 {
    mask as u32
}

/// A corner in each lane, after the shear that turns the conservative ray into its main axis.
type ShearedCorners<S> = [f32x4<S>; 3];

/// The data of a conservative ray for tests of triangles.
#[derive(Clone, Copy)]
pub(in crate::accel) struct TriangleLanes<S: Simd> {
    axes: [usize; 3],
    origin: [f32x4<S>; 3],
    main: f32x4<S>,
    slopes: [f32x4<S>; 2],
    error: f32x4<S>,
}

/// Which lanes may be hits, and which of them are certain hits, as bits.
#[derive(Clone, Copy)]
pub(in crate::accel) struct HitMask {
    pub(in crate::accel) maybe: u32,
    pub(in crate::accel) certain: u32,
}

impl<S: Simd> TriangleLanes<S> {
    /// One conservative ray.
    #[inline(always)]
    pub(in crate::accel) fn new(simd: S, conservative_ray: &ConservativeRay) -> Self {
        let [x, y] = conservative_ray.slopes;
        Self {
            axes: conservative_ray.axes,
            origin: splat4(simd, conservative_ray.origin),
            main: f32x4::splat(simd, conservative_ray.main),
            slopes: [f32x4::splat(simd, x), f32x4::splat(simd, y)],
            error: f32x4::splat(simd, conservative_ray.error),
        }
    }

    /// A corner of each triangle, sheared.
    #[inline(always)]
    fn sheared(&self, simd: S, leaf: WideLeaf<'_>, corner: usize) -> ShearedCorners<S> {
        let seen = |k: usize| leaf.numbers(simd, place(corner, self.axes[k])) - self.origin[k];
        let along = seen(2) * self.main;
        [
            seen(0) - along * self.slopes[0],
            seen(1) - along * self.slopes[1],
            along,
        ]
    }

    /// Which triangles of a leaf the conservative ray may hit before `t_far`; if `CERTAIN`, also
    /// which it certainly hits before `t_certain`.
    ///
    /// The signs of the edge functions are those of exact arithmetic where they exceed a bound on
    /// their error: a triangle with two sure signs that differ is missed, one with three that agree
    /// is hit.
    #[inline(always)]
    pub(in crate::accel) fn intersect4<const CERTAIN: bool>(
        &self,
        simd: S,
        leaf: WideLeaf<'_>,
        [t_far, t_certain]: [f32; 2],
    ) -> HitMask {
        let error = self.error;
        let a = self.sheared(simd, leaf, 0);
        let b = self.sheared(simd, leaf, 1);
        let c = self.sheared(simd, leaf, 2);
        let (u, v, w) = (edge(&c, &b), edge(&a, &c), edge(&b, &a));
        // Products of coordinates of size m with errors e: 4·m·e + 2·e², and 3 roundings of each
        // product.
        let size = size_of(&a).max(size_of(&b)).max(size_of(&c)) + error;
        let bound = size * (size * (8.0 * f32::EPSILON) + error * 6.0);
        let (min, max) = (u.min(v).min(w), u.max(v).max(w));
        let outside = min.simd_lt(-bound) & max.simd_gt(bound);
        let nearest = a[2].min(b[2]).min(c[2]) - error;
        let farthest = a[2].max(b[2]).max(c[2]) + error;
        let beyond = nearest.simd_gt(t_far) | farthest.simd_lt(0.0);
        let maybe = bits((!(outside | beyond)).to_bitmask());
        if !CERTAIN {
            return HitMask { maybe, certain: 0 };
        }
        let inside = min.simd_gt(bound) | max.simd_lt(-bound);
        let between = nearest.simd_gt(error) & farthest.simd_lt(t_certain);
        let certain = bits((inside & between).to_bitmask()) & maybe;
        HitMask { maybe, certain }
    }
}

/// The larger of the sizes of both coordinates across the conservative ray.
#[inline(always)]
fn size_of<S: Simd>(corner: &ShearedCorners<S>) -> f32x4<S> {
    corner[0].abs().max(corner[1].abs())
}

/// The edge function of the edge between two corners.
#[inline(always)]
fn edge<S: Simd>(p: &ShearedCorners<S>, q: &ShearedCorners<S>) -> f32x4<S> {
    p[0] * q[1] - p[1] * q[0]
}
