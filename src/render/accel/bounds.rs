//! Bounding spheres, and a conservative slab test: it never misses a box whose content the ray
//! hits.

use crate::ray::Ray;
use rtc_math::{Bounds, U, Vec3};

/// A sphere.
#[derive(Clone, Copy, Debug)]
pub struct BoundingSphere {
    /// Its centre.
    pub center: Vec3,
    /// Its radius.
    pub radius: f64,
}

/// The data of a ray that the slab test needs.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SlabTest {
    origin: Vec3,
    inverse: Vec3,
}

impl SlabTest {
    /// The slabs of a ray.
    #[must_use]
    pub(crate) fn new(ray: &Ray) -> Self {
        Self {
            origin: ray.origin,
            inverse: ray.direction.recip(),
        }
    }

    /// True for the axes along which the ray runs downwards.
    #[must_use]
    pub(crate) fn runs_down(&self, axis: usize) -> bool {
        self.inverse[axis] < 0.0
    }

    /// Whether the ray may hit the box before `t_max`, a root that may itself be rounded.
    ///
    /// Conservative as in Ize, "Robust BVH ray traversal" (JCGT 2, 2013), but the far end grows by
    /// 2γ₄, as its growing is rounded too: `docs/proofs/slabs.g`. Comparisons are written so that
    /// the NaN of a ray inside a slab's plane leaves the interval as it is. `t_max` grows by more,
    /// as a root may be known less well than the ends of a slab: of surfaces at the same t none is
    /// missed.
    #[must_use]
    #[inline]
    pub(crate) fn meet(&self, bounds: &Bounds, t_max: f64) -> bool {
        const FAR_SCALE: f64 = 1.0 + 2.0 * (4.0 * U / (1.0 - 4.0 * U));
        const T_SLACK: f64 = 1.0 + 1.0 / 1_048_576.0;
        let (mut near, mut far) = (0.0, t_max * T_SLACK);
        for axis in 0..3 {
            let first = (bounds.min[axis] - self.origin[axis]) * self.inverse[axis];
            let second = (bounds.max[axis] - self.origin[axis]) * self.inverse[axis];
            let (enter, leave) = if self.inverse[axis] < 0.0 {
                (second, first)
            } else {
                (first, second)
            };
            let leave = leave * FAR_SCALE;
            if enter > near {
                near = enter;
            }
            if leave < far {
                far = leave;
            }
        }
        near <= far
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sampler::PathVertexKey;
    use crate::shape::triangle::{Triangle, WatertightRay};
    use rayon::prelude::*;

    /// Corners anywhere, at one z, with the ray in the plane of a face of the box, and far from the
    /// origin.
    const FAMILIES: [&str; 4] = [
        "generic",
        "flat box",
        "ray in the plane of a face",
        "at 1e6",
    ];

    /// A triangle, and a ray that aims at its inside, at an edge, or at a corner in turn.
    fn aimed(family: usize, index: u64) -> (Triangle, Ray) {
        let key = PathVertexKey::new([u32::try_from(family).unwrap(), 5], index);
        let frame =
            |k: u64| Vec3::new(key.uniform(k), key.uniform(k + 1), key.uniform(k + 2)) * 2.0 - 1.0;
        let mut points = [frame(0), frame(3), frame(6), frame(9) * 4.0];
        match family {
            1 => points[..3].iter_mut().for_each(|point| point.z = 0.25),
            2 => {
                points[0].y = points[1].y.max(points[2].y).max(points[0].y);
                points[3].y = points[0].y;
            }
            3 => points
                .iter_mut()
                .for_each(|point| *point += Vec3::new(1e6, -1e6, 1e6)),
            _ => {}
        }
        let [a, b, c, origin] = points;
        let (u, v) = (key.uniform(12), key.uniform(13));
        let target = match if family == 2 { 2 } else { index % 3 } {
            0 => a + (b - a) * (u * v) + (c - a) * (u * (1.0 - v)),
            1 => a + (b - a) * u,
            _ => a,
        };
        (
            Triangle::new([a, b, c]).unwrap(),
            Ray {
                origin,
                direction: target - origin,
            },
        )
    }

    /// A box is hit wherever its triangle is hit, even with that hit as the end of the ray.
    #[test]
    fn no_box_is_missed_where_its_triangle_is_hit() {
        let rays = std::env::var("RTC_RAYS")
            .ok()
            .and_then(|count| count.parse().ok())
            .unwrap_or(250_000_u64);
        for (family, name) in FAMILIES.into_iter().enumerate() {
            let intersect4 = |index: u64| {
                let (triangle, ray) = aimed(family, index);
                let Some(t) = triangle.intersect(&ray, &WatertightRay::new(&ray)) else {
                    return (0, 0);
                };
                (
                    1,
                    u64::from(!SlabTest::new(&ray).meet(&Bounds::of(*triangle.vertices()), t)),
                )
            };
            let (hits, missed) = (0..rays)
                .into_par_iter()
                .map(intersect4)
                .reduce(|| (0, 0), |a, b| (a.0 + b.0, a.1 + b.1));
            println!("| boxes missed | {name} | {hits} | {missed} |");
            assert!(hits > rays / 4 && missed == 0, "{name}: {missed} of {hits}");
        }
    }
}
