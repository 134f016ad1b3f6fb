//! The world: a proven scene in the shape that tracing wants, and the two questions a ray asks of it.

use super::bvh::Bvh;
use super::geometry::Geometry;
use super::material::Materials;
use super::ray::Ray;
use super::shape::Shape;
use super::triangle::Shear;
use super::verify::Verify;
use crate::math::Vec3;
use crate::plan::Plan;
use crate::valid::{self, Phong, ValidScene};
use std::sync::Arc;

/// The first hit of a ray.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit {
    /// Where along the ray.
    pub t: f64,
    /// The surface: an index into [`World::surfaces`].
    pub surface: usize,
    /// Which part of the surface, for shapes of several.
    pub part: u32,
}

/// A surface of the world.
#[derive(Clone, Debug)]
pub struct Surface<S = Shape> {
    /// Its shape.
    pub shape: S,
    /// The index of its material in [`World::materials`].
    pub material: usize,
    /// Its index in the scene.
    pub index: usize,
}

/// A scene prepared for tracing, of shapes `S`.
pub struct World<S = Shape> {
    /// The camera, settings, lights and materials as proven.
    pub scene: ValidScene,
    /// What the picture needs of it.
    pub plan: Plan,
    /// The materials, without maps that show one value.
    pub materials: Vec<Phong>,
    /// The surfaces that are planned, in the order of the scene.
    pub surfaces: Vec<Surface<S>>,
    /// The plan to be validated by a naive render.
    pub(super) verify: Option<Verify>,
    unbounded: Vec<u32>,
    bounded: Vec<u32>,
    bvh: Bvh,
}

impl<S: Geometry> World<S> {
    /// Prepares a scene: planes of shapes, the BVH.
    #[must_use]
    pub fn prepare(scene: &ValidScene, plan: &Plan) -> Self {
        let meshes = scene.meshes().iter().map(|mesh| Arc::new(S::prepare_mesh(mesh))).collect::<Vec<_>>();
        let mut materials = Materials::new(scene, plan);
        let surface = |(index, surface): (usize, &valid::Surface)| {
            let shape = S::prepare(&surface.shape, &meshes)?;
            Some(Surface { material: materials.of(surface.material, shape.has_uv()), shape, index })
        };
        let planned = scene.surfaces().iter().enumerate().filter(|(index, _)| plan.surfaces[*index]);
        let surfaces = planned.filter_map(surface).collect::<Vec<_>>();
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
        let materials = materials.all;
        Self { scene: scene.clone(), plan: plan.clone(), materials, surfaces, verify: None, unbounded, bounded, bvh }
    }

    /// The nearest hit with t > 0; of several at the same t, that of the first surface. Rays that are none hit nothing.
    #[must_use]
    pub fn nearest(&self, ray: &Ray) -> Option<Hit> {
        // A NaN passes every slab test, so such a ray would visit all there is.
        if !(ray.origin.is_finite() && ray.direction.is_finite()) {
            return None;
        }
        let (ray, unit) = ray.tamed();
        let shear = Shear::new(&ray);
        let mut best = Hit { t: f64::INFINITY, surface: usize::MAX, part: 0 };
        let mut visit = |surface: u32| {
            let surface = surface as usize;
            if let Some((t, part)) = self.surfaces[surface].shape.intersect(&ray, &shear, best.t)
                && (t < best.t || (t == best.t && surface < best.surface))
            {
                best = Hit { t, surface, part };
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
    pub(super) fn any(&self, ray: &Ray, t_max: f64) -> bool {
        const FOUND: f64 = -1.0;
        let shear = Shear::new(ray);
        let hits = |surface: u32| {
            let hit = self.surfaces[surface as usize].shape.intersect(ray, &shear, t_max);
            hit.is_some_and(|(t, _)| t < t_max)
        };
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
