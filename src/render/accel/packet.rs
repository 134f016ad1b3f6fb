//! Packets of eight coherent rays against the boxes of a node and against a triangle, with interval
//! arithmetic. If the packet misses a box, each of its rays misses it.
//!
//! Rounding is monotonic: a result for the ends of an interval bounds the results for each ray in
//! it. So intervals need no error bounds beyond those of a single ray.

use crate::accel::conservative_ray::ConservativeRay;
use crate::accel::lanes::{
    FAR_SCALE, HitMask, TriangleLanes, WIDTH, WideLeaf, WideNode, bits, nearer_ends,
};
use fearless_simd::prelude::*;
use fearless_simd::{Simd, f32x8};

/// Rays of a packet.
pub(in crate::accel) const RAYS: usize = 8;

/// A number of each ray.
type OfRays = [f32; RAYS];

/// Eight conservative rays that have the same main axis, and the same signs along all axes.
pub(in crate::accel) struct Packet<S: Simd> {
    /// The offsets of the nearer ends of boxes, per axis.
    near: [usize; 3],
    /// The origins that let boxes be entered first, and left last.
    first: [f32; 3],
    last: [f32; 3],
    /// The least and the greatest of each axis.
    inverse: [[f32; 2]; 3],
    near_origin: [f32x8<S>; 3],
    far_origin: [f32x8<S>; 3],
    inverses: [f32x8<S>; 3],
    triangles: TriangleLanes<f32x8<S>>,
}

/// A number of each conservative ray, and its range.
#[inline(always)]
fn of_each(
    conservative_rays: &[ConservativeRay; RAYS],
    number: impl Fn(&ConservativeRay) -> f32,
) -> (OfRays, [f32; 2]) {
    let (mut all, mut range) = ([0.0; RAYS], [f32::INFINITY, f32::NEG_INFINITY]);
    // Counted, as are all loops over rays here: chained iterators become calls.
    for lane in 0..RAYS {
        all[lane] = number(&conservative_rays[lane]);
        range = [range[0].min(all[lane]), range[1].max(all[lane])];
    }
    (all, range)
}

/// Whether all have the same main axis and the same signs.
#[inline(always)]
fn are_alike(conservative_rays: &[ConservativeRay; RAYS]) -> bool {
    let mut are_alike = true;
    for lane in 1..RAYS {
        are_alike &= conservative_rays[lane].axes[2] == conservative_rays[0].axes[2]
            && conservative_rays[lane].down == conservative_rays[0].down;
    }
    are_alike
}

impl<S: Simd> Packet<S> {
    /// The packet of eight conservative rays; `None` if they are not coherent.
    #[inline(always)]
    pub(in crate::accel) fn new(
        simd: S,
        conservative_rays: &[ConservativeRay; RAYS],
    ) -> Option<Self> {
        // Reject rays with different main axes or signs.
        if !are_alike(conservative_rays) {
            return None;
        }
        let ConservativeRay { axes, down, .. } = conservative_rays[0];
        let lanes = |lanes: OfRays| f32x8::load_array(simd, lanes);
        let zero = f32x8::splat(simd, 0.0);
        let [mut near_origin, mut far_origin, mut inverses] = [[zero; 3]; 3];
        let [mut first, mut last] = [[0.0; 3]; 2];
        let mut inverse = [[0.0; 2]; 3];
        // Bound the origins and the inverse directions of all rays along each axis.
        for axis in 0..3 {
            let (near, near_range) = of_each(conservative_rays, |conservative_ray| {
                conservative_ray.near_origin[axis]
            });
            let (far, far_range) = of_each(conservative_rays, |conservative_ray| {
                conservative_ray.far_origin[axis]
            });
            let (all, range) = of_each(conservative_rays, |conservative_ray| {
                conservative_ray.inverse[axis]
            });
            (near_origin[axis], far_origin[axis]) = (lanes(near), lanes(far));
            (inverses[axis], inverse[axis]) = (lanes(all), range);
            first[axis] = near_range[usize::from(!down[axis])];
            last[axis] = far_range[usize::from(down[axis])];
        }
        // Collect the shear of each ray for the triangle test.
        let origin = |k: usize| {
            lanes(
                of_each(conservative_rays, |conservative_ray| {
                    conservative_ray.origin[k]
                })
                .0,
            )
        };
        let slope = |k: usize| {
            lanes(
                of_each(conservative_rays, |conservative_ray| {
                    conservative_ray.slopes[k]
                })
                .0,
            )
        };
        Some(Self {
            near: nearer_ends(down),
            first,
            last,
            inverse,
            near_origin,
            far_origin,
            inverses,
            triangles: TriangleLanes {
                axes,
                origin: [origin(0), origin(1), origin(2)],
                main: f32x8::splat(simd, conservative_rays[0].main),
                slopes: [slope(0), slope(1)],
                error: lanes(
                    of_each(conservative_rays, |conservative_ray| conservative_ray.error).0,
                ),
            },
        })
    }

    /// The offsets of the ends of boxes, nearer or farther ones.
    #[inline(always)]
    fn ends(&self, axis: usize, is_far: bool) -> usize {
        let near = if is_far {
            !self.near[axis]
        } else {
            self.near[axis]
        };
        2 * WIDTH * axis + (near & WIDTH)
    }

    /// The two products, one of which bounds those of all rays with the ends of boxes.
    #[inline(always)]
    fn products(&self, simd: S, node: &WideNode, axis: usize, is_far: bool) -> [f32x8<S>; 2] {
        let at = self.ends(axis, is_far);
        let origin = if is_far { self.last } else { self.first }[axis];
        let distance = f32x8::from_slice(simd, &node[at..at + WIDTH]) - origin;
        let [least, greatest] = self.inverse[axis];
        [distance * least, distance * greatest]
    }

    #[inline(always)]
    fn enter(&self, simd: S, node: &WideNode, axis: usize) -> f32x8<S> {
        let [a, b] = self.products(simd, node, axis, false);
        a.min(b)
    }

    #[inline(always)]
    fn leave(&self, simd: S, node: &WideNode, axis: usize) -> f32x8<S> {
        let [a, b] = self.products(simd, node, axis, true);
        a.max(b)
    }

    /// The boxes of a node that any of the conservative rays may hit before `t_far`, as bits, and
    /// the earliest entry points.
    #[inline(always)]
    pub(in crate::accel) fn meet(
        &self,
        simd: S,
        node: &WideNode,
        t_far: f32,
    ) -> (u32, [f32; WIDTH]) {
        let enter = self
            .enter(simd, node, 0)
            .max(self.enter(simd, node, 1))
            .max(self.enter(simd, node, 2).max(0.0));
        let leave = self
            .leave(simd, node, 0)
            .min(self.leave(simd, node, 1))
            .min(self.leave(simd, node, 2))
            * FAR_SCALE;
        let hits = enter.simd_le(leave.min(t_far));
        (bits(hits.to_bitmask()), enter.into())
    }

    /// Whether any conservative ray hits the box of a child before its own `t_far`.
    #[inline(always)]
    pub(in crate::accel) fn is_hit(
        &self,
        simd: S,
        node: &WideNode,
        child: usize,
        limits: &OfRays,
    ) -> bool {
        let enter = |axis: usize| {
            let end = f32x8::splat(simd, node[self.ends(axis, false) + child]);
            (end - self.near_origin[axis]) * self.inverses[axis]
        };
        let leave = |axis: usize| {
            let end = f32x8::splat(simd, node[self.ends(axis, true) + child]);
            (end - self.far_origin[axis]) * self.inverses[axis]
        };
        let first = enter(0).max(enter(1)).max(enter(2).max(0.0));
        let last = leave(0).min(leave(1)).min(leave(2)) * FAR_SCALE;
        let hits = first.simd_le(last.min(f32x8::load_array(simd, *limits)));
        bits(hits.to_bitmask()) != 0
    }

    /// Which conservative rays may hit a triangle of a leaf before their limits; if `CERTAIN`, also
    /// which certainly hit it before the second ones.
    #[inline(always)]
    pub(in crate::accel) fn intersect4<const CERTAIN: bool>(
        &self,
        simd: S,
        leaf: WideLeaf<'_>,
        lane: usize,
        limits: &[OfRays; 2],
    ) -> HitMask {
        self.triangles.hit_mask::<CERTAIN, S>(
            #[inline(always)]
            |place: usize| f32x8::splat(simd, leaf.number(place, lane)),
            [
                f32x8::load_array(simd, limits[0]),
                f32x8::load_array(simd, limits[1]),
            ],
        )
    }
}
