//! The world: a proven scene in the shape that tracing wants, and the two questions a ray asks of it.

use super::bounds::Bounds;
use super::bvh::Bvh;
use super::plane::Plane;
use super::ray::{Interaction, Ray};
use super::sphere::Sphere;
use super::triangle::{Shear, Triangle};
use crate::math::Vec3;
use crate::valid::{self, ValidScene};

/// A shape ready to be hit.
#[derive(Clone, Copy, Debug)]
pub enum Shape {
    /// A sphere.
    Sphere(Sphere),
    /// An infinite plane.
    Plane(Plane),
    /// A triangle.
    Triangle(Triangle),
}

impl Shape {
    /// `None` for a triangle whose area the arithmetic can't tell from 0: no ray hits it.
    fn prepare(shape: &valid::Shape) -> Option<Self> {
        Some(match shape {
            valid::Shape::Sphere(sphere) => Self::Sphere(Sphere { center: sphere.center, radius: sphere.radius.get() }),
            valid::Shape::Plane(plane) => Self::Plane(Plane::new(plane.center, plane.normal)),
            valid::Shape::Triangle(triangle) => Self::Triangle(Triangle::new(triangle.vertices)?),
        })
    }

    /// The smallest root above 0; `shear` is that of the ray.
    #[must_use]
    #[inline]
    pub fn intersect(&self, ray: &Ray, shear: &Shear) -> Option<f64> {
        match self {
            Self::Sphere(sphere) => sphere.intersect(ray),
            Self::Plane(plane) => plane.intersect(ray),
            Self::Triangle(triangle) => triangle.intersect(ray, shear),
        }
    }

    /// What is known of the point at `t`, a root of this shape.
    #[must_use]
    pub fn interaction(&self, ray: &Ray, t: f64) -> Interaction {
        match self {
            Self::Sphere(sphere) => sphere.interaction(ray, t),
            Self::Plane(plane) => plane.interaction(ray, t),
            Self::Triangle(triangle) => triangle.interaction(ray, t),
        }
    }

    fn bounds(&self) -> Option<Bounds> {
        match self {
            Self::Sphere(sphere) => Some(Bounds::around(sphere.center, sphere.radius)),
            Self::Plane(_) => None,
            Self::Triangle(triangle) => Some(Bounds::of(triangle.vertices())),
        }
    }
}

/// The first hit of a ray.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit {
    /// Where along the ray.
    pub t: f64,
    /// The surface: an index into [`World::surfaces`].
    pub surface: usize,
}

/// A surface of the world.
#[derive(Clone, Copy, Debug)]
pub struct Surface {
    /// Its shape.
    pub shape: Shape,
    /// The index of its material.
    pub material: usize,
}

/// A scene prepared for tracing.
pub struct World {
    /// The camera, settings, lights and materials as proven.
    pub scene: ValidScene,
    /// The surfaces, in the order of the scene.
    pub surfaces: Vec<Surface>,
    unbounded: Vec<u32>,
    bounded: Vec<u32>,
    bvh: Bvh,
}

impl World {
    /// Prepares a scene: planes of shapes, the BVH.
    #[must_use]
    pub fn prepare(scene: &ValidScene) -> Self {
        let surface = |surface: &valid::Surface| {
            Some(Surface { shape: Shape::prepare(&surface.shape)?, material: surface.material })
        };
        let surfaces = scene.surfaces().iter().filter_map(surface).collect::<Vec<_>>();
        let (mut unbounded, mut bounded, mut boxes) = (Vec::new(), Vec::new(), Vec::new());
        for (index, surface) in (0_u32..).zip(&surfaces) {
            match surface.shape.bounds() {
                Some(bounds) => {
                    bounded.push(index);
                    boxes.push(bounds);
                }
                None => unbounded.push(index),
            }
        }
        let bvh = Bvh::build(&boxes);
        Self { scene: scene.clone(), surfaces, unbounded, bounded, bvh }
    }

    /// The nearest hit with t > 0; of several at the same t, that of the first surface.
    #[must_use]
    pub fn nearest(&self, ray: &Ray) -> Option<Hit> {
        let (ray, unit) = ray.tamed();
        let shear = Shear::new(&ray);
        let mut best = Hit { t: f64::INFINITY, surface: usize::MAX };
        let mut visit = |surface: u32| {
            let surface = surface as usize;
            if let Some(t) = self.surfaces[surface].shape.intersect(&ray, &shear)
                && (t < best.t || (t == best.t && surface < best.surface))
            {
                best = Hit { t, surface };
            }
            best.t
        };
        for surface in &self.unbounded {
            visit(*surface);
        }
        self.bvh.walk(&ray, f64::INFINITY, |item, _| visit(self.bounded[item as usize]));
        (best.surface != usize::MAX).then_some(Hit { t: best.t * unit, ..best })
    }

    /// Whether anything lies strictly between `from` and `to`; both ends may lie on surfaces.
    ///
    /// `from` should be a start of rays, off its own surface. What lies within the rounding error of `to` does not count:
    /// a light on a surface is not hidden by it.
    #[must_use]
    pub fn occluded(&self, from: Vec3, to: Vec3) -> bool {
        /// The end of the segment is known to this many units of its size.
        const END: f64 = 16.0 * crate::math::U;
        let direction = to - from;
        let size = (from.abs() + to.abs()).element_sum();
        let length = direction.length();
        let t_max = 1.0 - END * (1.0 + size / length);
        if t_max.is_nan() || t_max <= 0.0 {
            return false;
        }
        self.any(&Ray { origin: from, direction }, t_max)
    }

    /// Whether anything is hit with 0 < t < `t_max`.
    fn any(&self, ray: &Ray, t_max: f64) -> bool {
        const FOUND: f64 = -1.0;
        let shear = Shear::new(ray);
        let hits =
            |surface: u32| self.surfaces[surface as usize].shape.intersect(ray, &shear).is_some_and(|t| t < t_max);
        if self.unbounded.iter().any(|surface| hits(*surface)) {
            return true;
        }
        let mut found = false;
        self.bvh.walk(ray, t_max, |item, t_max| {
            found = found || hits(self.bounded[item as usize]);
            if found { FOUND } else { t_max }
        });
        found
    }
}
