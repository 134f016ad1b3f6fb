//! The world: a validated scene prepared for ray tracing, with the two ray queries: closest hit and
//! any hit.
//!
//! - `prepare` builds a [`World`] from a `ValidScene`; `shape`, `material`, `light`, `texture` and
//!   `settings` prepare its parts.
//! - Triangles of meshes that may be flattened are in one 8-wide BVH (`flattened`); all other
//!   surfaces are in the `ObjectBvh`. A scene with few surfaces has a [`SmallScene`] as well, which
//!   tests the candidates of the ray-cone cache only.
//! - `search` has the BVH visitors, `alpha` the alpha test.
//! - `behind` finds what camera rays see behind back faces.
//! - `any` chooses the shape set and the arithmetic; `verify` renders without pruning.
//!
//! Queries accept directions of any length. `t` is in units of the direction's length.

pub(crate) mod alpha;
pub(crate) mod any;
pub(crate) mod behind;
mod flattened;
mod light;
mod material;
mod panes;
mod prepare;
mod search;
pub(crate) mod settings;
pub(crate) mod shape;
pub(crate) mod small_scene;
mod texture;
pub(crate) mod verify;

use crate::accel::bvh::Bvh;
use crate::accel::simd::SimdLevel;
use crate::accel::wide::Candidate;
use crate::camera::Camera;
use crate::frame::verify::PlanVerification;
use crate::material::phong::PhongMaterial;
use crate::material::standard::StandardMaterial;
use crate::medium::HomogeneousMedium;
use crate::ray::Ray;
use crate::sampler::sobol::{SobolPair, SobolPath};
use crate::shape::Shape;
use crate::shape::geometry::Intersect;
use crate::shape::tie::{CLOSE, ClosestHit, ClosestHitCandidates};
use crate::shape::triangle::WatertightRay;
use alpha::AlphaTested;
use flattened::{FlattenedInstances, FlattenedRay};
use light::LightList;
use rtc_math::{Id, IdTable, Vec3};
use rtc_plan::Plan;
use rtc_valid::ValidScene;
pub(crate) use rtc_valid::{CourseLightId, PunctualId};
use search::{AnySearch, ClosestSearch};
use settings::Settings;
use small_scene::SmallScene;

/// A material of a world, of either model.
#[derive(Debug)]
pub(crate) enum Material {}

/// The id of a material of a world.
pub(crate) type MaterialId = Id<Material>;
/// The id of a participating medium of a world.
pub(crate) type MediumId = Id<HomogeneousMedium>;
/// The id of a surface in [`World::surfaces`], of whichever shapes.
pub(crate) type SurfaceId = Id<Surface>;

/// A surface, and a primitive of it.
pub(crate) type SurfacePrimitive = (SurfaceId, u32);

/// The closest hit of a ray.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit {
    /// The ray parameter, in units of the direction's length, > 0.
    pub t: f64,
    /// The surface.
    pub surface: SurfaceId,
    /// The primitive of the surface, for shapes with several.
    pub prim_id: u32,
}

/// A surface of the world.
#[derive(Clone, Debug)]
pub struct Surface<S = Shape> {
    /// Its shape.
    pub shape: S,
    /// Its material.
    pub(crate) material: MaterialId,
    /// Its index in the scene.
    pub index: usize,
}

/// A scene prepared for tracing, of shapes `S`.
pub struct World<S = Shape> {
    /// The validated scene, for changes of its camera and settings.
    scene: ValidScene,
    /// The camera.
    pub camera: Camera,
    /// The settings.
    pub(crate) settings: Settings,
    /// The features that the picture needs.
    pub plan: Plan,
    /// The materials of the Whitted integrator; constant maps are folded into the factors.
    pub(crate) phongs: IdTable<Material, PhongMaterial>,
    /// The materials of the path tracer.
    pub(crate) standards: IdTable<Material, StandardMaterial>,
    /// The participating media of the materials and around the camera.
    pub(crate) media: IdTable<HomogeneousMedium>,
    /// The medium around the camera.
    pub(crate) camera_medium: Option<MediumId>,
    /// Whether the scene names media, so that panes cost no bounce.
    pub(crate) has_free_panes: bool,
    /// Which materials of the path tracer may be panes, and whether a surface has one.
    pub(crate) panes: IdTable<Material, bool>,
    pub(crate) has_panes: bool,
    /// The lights.
    pub(crate) lights: LightList,
    /// The surfaces that the plan keeps, in the order of the scene.
    pub surfaces: IdTable<Surface, Surface<S>>,
    /// The plan to validate by a render without pruning.
    pub(crate) verify: Option<PlanVerification>,
    /// The surfaces that shadow rays of paths test for alpha.
    pub(crate) alpha_tested: AlphaTested,
    objects: ObjectBvh,
    /// The surfaces of `objects` that cast shadows, if some do not.
    casters: Option<ObjectBvh>,
    flattened: Option<FlattenedInstances>,
    /// The SIMD instructions that rays are traced with.
    pub(crate) simd: SimdLevel,
    /// The worlds at the moments of the shutter, if surfaces move. This one is that of the moment
    /// when the shutter opens.
    pub(crate) moments: Vec<World<S>>,
    /// All surfaces, if they are few and the integrator uses ray cones.
    pub(crate) small_scene: Option<SmallScene>,
}

/// The surfaces that are not flattened.
struct ObjectBvh {
    unbounded: Vec<SurfaceId>,
    bounded: Vec<SurfaceId>,
    /// The BVH of `bounded`.
    bvh: Bvh,
}

impl ObjectBvh {
    /// Whether there are none.
    #[inline]
    fn is_empty(&self) -> bool {
        self.unbounded.is_empty() && self.bounded.is_empty()
    }
}

/// The `t_max` that ends a traversal.
const STOP: f64 = -1.0;

/// The primitive of a ray that starts at no surface.
pub(crate) const NO_PRIMITIVE: SurfacePrimitive = (SurfaceId::NONE, u32::MAX);

impl<S> World<S> {
    /// Which moment of the shutter a sample is taken at; `None` if nothing moves.
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "a share of the moments, below their number"
    )]
    #[inline]
    pub(crate) fn moment_of(&self, numbers: &SobolPath) -> Option<usize> {
        let count = self.moments.len();
        let time = || numbers.pair(SobolPair::SHUTTER)[0];
        (count > 0).then(|| (time() * count as f64) as usize)
    }
}

impl<S: Intersect> World<S> {
    /// The closest hit with t > 0. Ties within rounding go to the first surface and its first
    /// primitive. Non-finite rays hit nothing.
    #[must_use]
    pub fn closest_hit(&self, ray: &Ray) -> Option<Hit> {
        self.closest_hit_from(ray, NO_PRIMITIVE)
    }

    /// As [`World::closest_hit`], for a ray that starts at a primitive of a surface. A flattened
    /// triangle is flat, so the ray cannot hit it again.
    pub(crate) fn closest_hit_from(&self, ray: &Ray, from: SurfacePrimitive) -> Option<Hit> {
        // A NaN passes every slab test, so such a ray would visit every node.
        if !(ray.origin.is_finite() && ray.direction.is_finite()) {
            return None;
        }
        let (ray, unit) = ray.rescaled();
        let mut nearest = self.closest_hit_in_objects(&ray);
        if S::FLATTENS
            && let Some(flattened) = &self.flattened
        {
            let triangles = FlattenedRay::new(&ray, from, &self.surfaces, flattened);
            let mut search = ClosestSearch { triangles, nearest };
            flattened.hierarchy.traverse(&ray, nearest.t, &mut search);
            nearest = search.nearest;
        }
        self.hit(&ray, unit, from, &nearest)
    }

    /// The hit that is nearest, of a ray rescaled by `unit`.
    #[inline(always)]
    fn hit(
        &self,
        ray: &Ray,
        unit: f64,
        from: SurfacePrimitive,
        nearest: &ClosestHit<SurfacePrimitive>,
    ) -> Option<Hit> {
        let (t, (surface, prim_id)) = match nearest.key {
            _ if nearest.key == NO_PRIMITIVE => return None,
            _ if nearest.is_tied() => self.resolve(ray, from, nearest.t)?,
            key => (nearest.t, key),
        };
        Some(Hit {
            t: t * unit,
            surface,
            prim_id,
        })
    }

    /// The closest hit on surfaces that are not flattened; infinite if there is none.
    #[inline]
    fn closest_hit_in_objects(&self, ray: &Ray) -> ClosestHit<SurfacePrimitive> {
        let mut nearest = ClosestHit::up_to(f64::INFINITY, NO_PRIMITIVE);
        let objects = &self.objects;
        if objects.is_empty() {
            return nearest;
        }
        let watertight = WatertightRay::new(ray);
        let mut visit = |surface: SurfaceId| {
            if let Some((t, prim_id)) =
                self.surfaces[surface]
                    .shape
                    .closest_hit(ray, &watertight, nearest.limit())
            {
                nearest.add(t, (surface, prim_id));
            }
            nearest.t
        };
        for surface in &objects.unbounded {
            visit(*surface);
        }
        objects.bvh.traverse(ray, f64::INFINITY, |item, _| {
            visit(objects.bounded[item as usize])
        });
        nearest
    }

    /// The closest hit of a ray of length 1 where others are as close as `t`.
    pub(crate) fn resolved(&self, ray: &Ray, t: f64) -> Option<Hit> {
        let (t, (surface, prim_id)) = self.resolve(ray, NO_PRIMITIVE, t)?;
        Some(Hit {
            t,
            surface,
            prim_id,
        })
    }

    /// Breaks the tie between the hits as close as the one at `t`.
    #[cold]
    #[inline(never)]
    fn resolve(
        &self,
        ray: &Ray,
        from: SurfacePrimitive,
        t: f64,
    ) -> Option<(f64, SurfacePrimitive)> {
        let (mut tie, watertight) = (ClosestHitCandidates::new(), WatertightRay::new(ray));
        // Collect all roots near `t` with their error bounds.
        let mut add = |t: f64, surface: SurfaceId, prim_id: u32| {
            tie.add(
                t,
                self.surfaces[surface].shape.error(ray, t, prim_id),
                (surface, prim_id),
            );
        };
        let mut visit = |surface: SurfaceId| {
            let shape = &self.surfaces[surface].shape;
            shape.visit_roots(ray, &watertight, t * CLOSE, &mut |t, prim_id| {
                add(t, surface, prim_id)
            });
        };
        // Visit the objects that the ray may hit there.
        let objects = &self.objects;
        objects.unbounded.iter().for_each(|surface| visit(*surface));
        objects.bvh.traverse(ray, t, |item, _| {
            visit(objects.bounded[item as usize]);
            t
        });
        // Visit the triangles of flattened instances.
        if S::FLATTENS
            && let Some(flattened) = &self.flattened
        {
            let mut triangles = FlattenedRay::new(ray, from, &self.surfaces, flattened);
            let mut visit = |candidate: Candidate<'_>| {
                if let Some((t, (surface, prim_id))) = triangles.root(&candidate) {
                    add(t, surface, prim_id);
                }
                t
            };
            flattened.hierarchy.traverse(ray, t, &mut visit);
        }
        // Choose the nearest root, by surface and primitive among equals.
        tie.first()
    }

    /// Whether any shadow caster is strictly between `from` and `to`; both ends may be on surfaces.
    ///
    /// `from` should be a start of rays, off its own surface. Hits within the rounding error of
    /// `to` are ignored: a light on a surface is not occluded by it.
    #[must_use]
    pub fn occluded(&self, from: Vec3, to: Vec3) -> bool {
        segment(from, to).is_some_and(|(ray, t_max)| self.any_hit(&ray, t_max))
    }

    /// Whether anything that casts shadows is hit with 0 < t < `t_max`.
    #[must_use]
    pub fn any_hit(&self, ray: &Ray, t_max: f64) -> bool {
        self.any_hit_from(ray, t_max, NO_PRIMITIVE)
    }

    /// As [`World::any_hit`], for a ray that starts at the primitive `from`.
    pub(crate) fn any_hit_from(&self, ray: &Ray, t_max: f64, from: SurfacePrimitive) -> bool {
        let (ray, unit) = ray.rescaled();
        let t_max = t_max / unit;
        if self.any_hit_in_objects(&ray, t_max) {
            return true;
        }
        if S::FLATTENS
            && let Some(flattened) = &self.flattened
        {
            let triangles = FlattenedRay::new(&ray, from, &self.surfaces, flattened);
            let mut search = AnySearch::new(triangles, t_max);
            flattened.hierarchy.traverse(&ray, t_max, &mut search);
            return search.is_hit;
        }
        false
    }

    /// The product of `pass` over all hits with 0 < t < `t_max`, until it is 0. Only flattened
    /// triangles are tested; all other surfaces are opaque. The ray starts at the primitive `from`.
    pub(crate) fn transmittance(
        &self,
        ray: &Ray,
        t_max: f64,
        from: SurfacePrimitive,
        pass: &mut dyn FnMut(Hit) -> f64,
    ) -> f64 {
        let (ray, unit) = ray.rescaled();
        let t_max = t_max / unit;
        if self.any_hit_in_objects(&ray, t_max) {
            return 0.0;
        }
        let mut transmittance = 1.0;
        if S::FLATTENS
            && let Some(flattened) = &self.flattened
        {
            let mut triangles = FlattenedRay::new(&ray, from, &self.surfaces, flattened);
            let mut visit = |candidate: Candidate<'_>| {
                if let Some((t, (surface, prim_id))) = triangles.root_before(&candidate, t_max) {
                    transmittance *= pass(Hit {
                        t: t * unit,
                        surface,
                        prim_id,
                    });
                }
                if transmittance > 0.0 { t_max } else { STOP }
            };
            flattened.hierarchy.traverse(&ray, t_max, &mut visit);
        }
        transmittance
    }

    /// Whether a surface that casts shadows and is not flattened is hit with 0 < t < `t_max`.
    fn any_hit_in_objects(&self, ray: &Ray, t_max: f64) -> bool {
        let objects = self.casters.as_ref().unwrap_or(&self.objects);
        if objects.is_empty() {
            return false;
        }
        let watertight = WatertightRay::new(ray);
        let hits = |surface: SurfaceId| {
            let hit = self.surfaces[surface]
                .shape
                .intersect(ray, &watertight, t_max);
            hit.is_some_and(|(t, _)| t < t_max)
        };
        if objects.unbounded.iter().any(|surface| hits(*surface)) {
            return true;
        }
        let mut blocked = false;
        objects.bvh.traverse(ray, t_max, |item, t_max| {
            blocked = blocked || hits(objects.bounded[item as usize]);
            if blocked { STOP } else { t_max }
        });
        blocked
    }
}

/// The end of a segment is known to this many units of its size.
pub(crate) const END: f64 = 16.0 * rtc_math::U;

/// The ray from one point to another, and the far bound that excludes the surface at its end;
/// `None` if the points coincide within rounding.
pub(crate) fn segment(from: Vec3, to: Vec3) -> Option<(Ray, f64)> {
    let direction = to - from;
    let size = (from.abs() + to.abs()).element_sum();
    let length = direction.length();
    let t_max = 1.0 - END * (1.0 + size / length);
    (t_max > 0.0).then_some((
        Ray {
            origin: from,
            direction,
        },
        t_max,
    ))
}
