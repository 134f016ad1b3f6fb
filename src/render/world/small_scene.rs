//! A world of at most 64 surfaces, none of them flattened, as bit sets. A ray tests only the
//! candidates of its cone.

use super::{Hit, NO_PRIMITIVE, Surface, SurfaceId, World, segment};
use crate::accel::ray_cone_cache::{BoundingSpheres, MAX_ITEMS};
use crate::ray::Ray;
use crate::shape::geometry::Intersect;
use crate::shape::tie::ClosestHit;
use crate::shape::triangle::WatertightRay;
use rtc_math::{IdTable, Vec3};
use rtc_plan::{LightPlan, Plan};
use rtc_valid::{CourseLight, CourseLightId};

/// Surfaces with bits: that of a surface is its index in the world.
pub(crate) struct SmallScene {
    pub(crate) balls: BoundingSpheres,
    /// The surfaces that look at the shear of a ray.
    sheared: u64,
    /// The surfaces that cast shadows.
    casters: u64,
    /// For each light of the plan and surface of the scene, the possible occluders between them.
    hiding: IdTable<CourseLight, Vec<u64>>,
}

impl SmallScene {
    /// The surfaces given of a world, and of those the ones that cast shadows; `None` if there are
    /// too many.
    pub(super) fn new<S: Intersect>(
        surfaces: &IdTable<Surface, Surface<S>>,
        all: &[SurfaceId],
        casters: &[SurfaceId],
    ) -> Option<Self> {
        if surfaces.len() != all.len() || surfaces.len() > MAX_ITEMS {
            return None;
        }
        let balls = surfaces.iter().map(|surface| surface.shape.ball());
        let sheared = surfaces
            .entries()
            .filter(|(_, surface)| surface.shape.uses_watertight_ray());
        Some(Self {
            balls: BoundingSpheres::new(balls.enumerate()),
            sheared: bits(sheared.map(|(id, _)| id)),
            casters: bits(casters.iter().copied()),
            hiding: IdTable::default(),
        })
    }

    /// Takes over from a plan which surfaces may hide a light from which.
    pub(super) fn follow<S>(&mut self, surfaces: &IdTable<Surface, Surface<S>>, plan: &Plan) {
        let hiding = |light: &LightPlan, receiver: usize| {
            let may_occlude = |id: &SurfaceId| light.may_occlude(surfaces[*id].index, receiver);
            self.casters & bits(surfaces.ids().filter(may_occlude))
        };
        let of_light = |light: &LightPlan| {
            let receivers = 0..light.occluders.len();
            receivers.map(|receiver| hiding(light, receiver)).collect()
        };
        self.hiding = plan.lights.iter().map(of_light).collect();
    }

    /// The surfaces that may hide a light from a surface of the scene.
    #[inline]
    pub(crate) fn hiding(&self, light: CourseLightId, receiver: usize) -> u64 {
        let of_light = &self.hiding[light];
        of_light.get(receiver).copied().unwrap_or(self.casters)
    }

    /// The watertight ray of a ray, if one of some surfaces uses it.
    #[inline(always)]
    fn watertight(&self, items: u64, ray: &Ray) -> WatertightRay {
        if items & self.sheared == 0 {
            WatertightRay::UNUSED
        } else {
            WatertightRay::new(ray)
        }
    }

    /// The watertight ray of a ray, if a shape uses it.
    #[inline(always)]
    pub(crate) fn shear_of<S: Intersect>(shape: &S, ray: &Ray) -> WatertightRay {
        if shape.uses_watertight_ray() {
            WatertightRay::new(ray)
        } else {
            WatertightRay::UNUSED
        }
    }

    /// The first surface of some, which is left out of them.
    #[inline(always)]
    pub(crate) fn pop(items: &mut u64) -> Option<SurfaceId> {
        if *items == 0 {
            return None;
        }
        let surface = SurfaceId::new(items.trailing_zeros() as usize);
        *items &= *items - 1;
        Some(surface)
    }
}

/// A number with some bits.
fn bits(ids: impl Iterator<Item = SurfaceId>) -> u64 {
    ids.fold(0, |bits, id| bits | 1 << id.index())
}

impl<S: Intersect> World<S> {
    /// As [`World::closest_hit`], for a finite ray of length 1 that can hit only some surfaces.
    #[inline(always)]
    pub(crate) fn closest_hit_of(
        &self,
        small_scene: &SmallScene,
        mut items: u64,
        ray: &Ray,
    ) -> Option<Hit> {
        let mut nearest = ClosestHit::up_to(f64::INFINITY, NO_PRIMITIVE);
        if items == 0 {
            return None;
        }
        let watertight = small_scene.watertight(items, ray);
        while let Some(surface) = SmallScene::pop(&mut items) {
            let shape = &self.surfaces[surface].shape;
            if let Some((t, prim_id)) = shape.closest_hit(ray, &watertight, nearest.limit()) {
                nearest.add(t, (surface, prim_id));
            }
        }
        self.hit(ray, 1.0, NO_PRIMITIVE, &nearest)
    }

    /// As [`World::occluded`], where only some surfaces can occlude.
    #[inline(always)]
    pub(crate) fn occluded_by(
        &self,
        small_scene: &SmallScene,
        mut items: u64,
        [from, to]: [Vec3; 2],
    ) -> bool {
        let ray = Ray {
            origin: from,
            direction: to - from,
        };
        if !ray.is_scaled() {
            return self.occluded(from, to);
        }
        let watertight = small_scene.watertight(items, &ray);
        // The end of the segment is computed only where it is compared.
        let is_before_end = |t: f64| segment(from, to).is_some_and(|(_, t_max)| t < t_max);
        while let Some(surface) = SmallScene::pop(&mut items) {
            let shape = &self.surfaces[surface].shape;
            let hit = shape.intersect(&ray, &watertight, 1.0);
            if hit.is_some_and(|(t, _)| is_before_end(t)) {
                return true;
            }
        }
        false
    }
}
