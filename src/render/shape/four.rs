//! Shapes that are intersected with four rays at once.

use super::plane::{Plane, PlaneAxis};
use super::sphere::Sphere;
use super::torus::Torus;
use crate::ray::{Interactions, Rays};
use rtc_math::Double;

/// A shape that intersects four rays at once.
#[derive(Clone, Copy)]
pub enum Shape4<'a> {
    /// A sphere.
    Sphere(&'a Sphere),
    /// A torus.
    Torus(&'a Torus),
    /// A plane along an axis.
    Plane(&'a Plane, PlaneAxis),
}

impl Shape4<'_> {
    /// The roots above 0 of the lanes `active`; infinite for a miss.
    #[inline(always)]
    pub(crate) fn intersect<N: Double>(self, rays: &Rays<N>, active: N::Mask) -> N {
        match self {
            Self::Sphere(sphere) => sphere.roots(rays, active),
            Self::Torus(torus) => torus.roots(rays, active),
            Self::Plane(plane, axis) => plane.roots(axis, rays, active),
        }
    }

    /// The interactions at `t`, in the lanes where that is finite.
    #[inline(always)]
    pub(crate) fn interactions<N: Double>(self, rays: &Rays<N>, t: N) -> Interactions<N> {
        match self {
            Self::Sphere(sphere) => sphere.interactions(rays, t),
            Self::Torus(torus) => torus.interactions(rays, t),
            Self::Plane(plane, axis) => plane.interactions(axis, rays, t),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::accel::simd::baseline;
    use crate::lanes::{LANES, four_rays};
    use crate::ray::{Interaction, Ray};
    use crate::sampler::PathVertexKey;
    use crate::shape::geometry::Intersect;
    use fearless_simd::prelude::*;
    use fearless_simd::{Simd, f64x4, mask64x4};
    use rtc_math::Vec3;

    /// Rays from near and far, at the sphere and past it, from its surface and along it.
    fn rays(index: u64) -> [Ray; LANES] {
        [0, 1, 2, 3].map(|lane| {
            let key = PathVertexKey::new([7, lane], index);
            let vector = |k: u64| {
                Vec3::new(key.uniform(k), key.uniform(k + 1), key.uniform(k + 2)) * 2.0 - 1.0
            };
            let far = [1.0, 1.001, 4.0, 1e3, 1e9][(key.bits(9) % 5) as usize];
            let origin = vector(0).normalize() * far;
            let aim = match key.bits(10) % 3 {
                0 => vector(3),
                1 => vector(3).normalize(),
                _ => vector(3) * far,
            };
            Ray {
                origin,
                direction: (aim - origin).normalize(),
            }
        })
    }

    #[test]
    fn four_rays_meet_a_torus_as_each_does() {
        let simd = baseline();
        let all = mask64x4::splat(simd, true);
        let mut hits = 0;
        for (axis, major, minor) in [
            (Vec3::new(0.0, 0.0, 1.0), 0.75, 0.25),
            (Vec3::new(1.0, 2.0, -2.0), 0.9, 0.01),
            (Vec3::new(-0.3, 0.1, 0.2), 0.5, 0.5),
        ] {
            let torus = Torus::new(Vec3::new(0.1, -0.2, 0.05), axis, major, minor);
            for index in 0..5_000 {
                let each = rays(index);
                let four = four_rays(simd, &each);
                let t = torus.roots(&four, all);
                let at = torus.interactions(&four, t);
                for (lane, ray) in each.iter().enumerate() {
                    let single = torus.intersect(ray);
                    assert_eq!(single.unwrap_or(f64::INFINITY).to_bits(), t[lane].to_bits());
                    let Some(t) = single else { continue };
                    assert_same(&torus.interaction(ray, t), &at, lane);
                    hits += 1;
                }
            }
        }
        assert!(hits > 10_000, "{hits}");
    }

    #[test]
    fn four_rays_meet_a_plane_along_an_axis_as_each_does() {
        let simd = baseline();
        let all = mask64x4::splat(simd, true);
        let mut hits = 0;
        for (anchor, normal) in [
            (Vec3::new(0.1, 0.2, 0.0), Vec3::new(0.0, 0.0, -4.0)),
            (Vec3::new(0.5, -0.25, 0.3), Vec3::new(2.0, 0.0, 0.0)),
        ] {
            let plane = Plane::new(anchor, normal);
            let Some(lanes) = plane.shape4() else {
                panic!("{normal} lies along an axis")
            };
            for index in 0..20_000 {
                let mut each = rays(index);
                // Some start on the plane, or run along it.
                if index % 5 == 0 {
                    each[1].origin = anchor;
                    each[2].direction.z = 0.0;
                }
                let four = four_rays(simd, &each);
                let t = lanes.intersect(&four, all);
                let at = lanes.interactions(&four, t);
                for (lane, ray) in each.iter().enumerate() {
                    let single = plane.intersect(ray);
                    assert_eq!(single.unwrap_or(f64::INFINITY).to_bits(), t[lane].to_bits());
                    let Some(t) = single else { continue };
                    assert_same(&plane.interaction(ray, t), &at, lane);
                    hits += 1;
                }
            }
        }
        assert!(hits > 20_000, "{hits}");
    }

    /// Whether an interaction has the bits of that in a lane.
    fn assert_same(one: &Interaction, at: &Interactions<f64x4<impl Simd>>, lane: usize) {
        let bits = |v: Vec3| v.to_array().map(f64::to_bits);
        assert_eq!(bits(one.point), bits(at.point.lane(lane)));
        assert_eq!(bits(one.normal), bits(at.normal.lane(lane)));
        assert_eq!(bits(one.back), bits(at.back.lane(lane)));
        assert_eq!(one.offset.to_bits(), at.offset[lane].to_bits());
    }

    #[test]
    fn four_rays_have_the_bits_of_each() {
        let simd = baseline();
        let sphere = Sphere {
            center: Vec3::ZERO,
            radius: 1.0,
        };
        let all = mask64x4::splat(simd, true);
        let mut hits = 0;
        for index in 0..20_000 {
            let each = rays(index);
            let four = four_rays(simd, &each);
            let lanes = Shape4::Sphere(&sphere);
            let t = lanes.intersect(&four, all);
            let at = lanes.interactions(&four, t);
            let starts = at.start(at.back);
            for (lane, ray) in each.iter().enumerate() {
                let single = sphere.intersect(ray);
                assert_eq!(single.unwrap_or(f64::INFINITY).to_bits(), t[lane].to_bits());
                let Some(t) = single else { continue };
                let one = sphere.interaction(ray, t);
                assert_same(&one, &at, lane);
                let (single, lane) = (one.start(one.back), starts.lane(lane));
                assert_eq!(
                    single.to_array().map(f64::to_bits),
                    lane.to_array().map(f64::to_bits)
                );
                hits += 1;
            }
        }
        assert!(hits > 20_000, "{hits}");
    }
}
