//! Caustics by manifold sampling: the surfaces that cast them, and the lights that they are
//! estimated for.
//!
//! - A caster is a surface of a smooth mirror or of clear glass, whose normals have a known
//!   derivative. A light path is seeded by a random point of one.
//! - A [`CausticTarget`] is a punctual light, or a point of a small emissive surface. Large lights
//!   are left to BSDF sampling, which finds them more often than not.

use super::{IncidentLight, Light, LightId, Lights, is_room_for};
use crate::bsdf::direction_at_angle;
use crate::light::punctual::Punctual;
use crate::sampler::discrete::DiscreteDistribution;
use crate::shape::emitter::EmitterPoint;
use crate::shape::geometry::Intersect;
use crate::world::{Surface, SurfaceId, World};
use rtc_math::{Id, IdTable, OrthonormalBasis, Vec3, to_u32};
use rtc_plan::CausticMaterials;

/// A light is small if its radius is at most this fraction of its distance from a caster.
const MOST_EXTENT: f64 = 0.25;

/// The casters and the lights of caustics.
pub(crate) struct CausticLights {
    casters: Vec<SurfaceId>,
    is_caster: IdTable<Surface, bool>,
    is_of_glass: bool,
    targets: Vec<LightId>,
    by_power: DiscreteDistribution,
    is_target: IdTable<Surface, bool>,
}

/// A sampled light, or a sampled point of one.
pub(crate) struct CausticTarget<'lights> {
    light: TargetLight<'lights>,
    /// The probability of the light; of a surface, its density per area.
    density: f64,
}

/// What a light path ends on.
enum TargetLight<'lights> {
    Punctual(&'lights Punctual),
    Surface {
        surface: SurfaceId,
        at: EmitterPoint,
        /// Whether only the side of the normal can be seen.
        is_closed: bool,
        emission: Vec3,
    },
}

impl CausticLights {
    /// Those of a world whose lights have these powers; `None` if there is no caster or no light.
    pub(super) fn new<S: Intersect>(
        lights: &Lights<'_, S>,
        powers: &IdTable<Light, f64>,
    ) -> Option<Self> {
        let world = lights.world;
        let materials = world.plan.paths.as_ref()?.caustics.as_ref()?;
        let is_caster = world
            .surfaces
            .iter()
            .map(|surface| casts(materials, surface))
            .collect::<IdTable<Surface, bool>>();
        let casters: Vec<_> = is_caster
            .ids()
            .filter(|surface| is_caster[*surface])
            .collect();
        if casters.is_empty() {
            return None;
        }
        // Select the emissive surfaces that are small from each caster.
        let mut is_target = IdTable::from(vec![false; world.surfaces.len()]);
        for surface in world.surfaces.ids() {
            let material = world.surfaces[surface].material.index();
            is_target[surface] = materials.emitters[Id::new(material)]
                && !is_caster[surface]
                && is_small(world, surface, &casters);
        }
        let power = |light: LightId| match &lights.lights[light] {
            Light::Punctual(..) => powers[light],
            Light::Triangle(triangle) if is_target[triangle.surface] => powers[light],
            Light::Shape(shape) if is_target[shape.surface] && shape.face.is_none() => {
                powers[light]
            }
            Light::Triangle(_) | Light::Shape(_) | Light::Environment => 0.0,
        };
        let targets: Vec<_> = (lights.lights.ids())
            .filter(|light| power(*light) > 0.0)
            .collect();
        let by_power = DiscreteDistribution::new(targets.iter().map(|light| power(*light)));
        // A light of power 0 is left to BSDF sampling.
        let mut shines = IdTable::<Surface, _>::from(vec![false; world.surfaces.len()]);
        for surface in targets.iter().filter_map(|light| lights.surface_of(*light)) {
            shines[surface] = true;
        }
        let transmits = |surface: &SurfaceId| {
            let material = world.surfaces[*surface].material;
            world.standards[material].transmission.factor > 0.0
        };
        (!targets.is_empty()).then_some(Self {
            is_of_glass: casters.iter().all(transmits),
            casters,
            is_caster,
            targets,
            by_power,
            is_target: shines,
        })
    }

    /// Whether a surface casts caustics that are estimated.
    #[inline]
    pub(crate) fn casts(&self, surface: SurfaceId) -> bool {
        self.is_caster[surface]
    }

    /// Whether all surfaces that cast caustics transmit light.
    #[inline]
    pub(crate) fn is_of_glass(&self) -> bool {
        self.is_of_glass
    }

    /// Whether caustics of an emissive surface are estimated.
    #[inline]
    pub(crate) fn is_aimed_at(&self, surface: SurfaceId) -> bool {
        self.is_target[surface]
    }

    /// A random direction from a point to a caster, and the largest useful step of a walk along
    /// its surface. Where a caster is straight before the light, half of the directions are near
    /// that of the light.
    pub(crate) fn seed<S: Intersect>(
        &self,
        world: &World<S>,
        from: Vec3,
        straight: Option<Vec3>,
        mut number: impl FnMut() -> f64,
    ) -> Option<(Vec3, f64)> {
        /// The largest step, in units of the size of the caster.
        const MOST: f64 = 0.5;
        /// 1 − cos of the angle to the straight direction, at most.
        const VERSINE: f64 = 0.03;
        // Choose a caster.
        let index = index_below(self.casters.len(), number());
        let shape = &world.surfaces[self.casters[index]].shape;
        let u = [number(), number()];
        let longest = shape
            .ball()
            .map_or(f64::INFINITY, |ball| MOST * ball.radius);
        // Sample a direction near the straight one, or a point of the caster.
        if let Some(straight) = straight
            && number() < 0.5
        {
            let cosine = 1.0 - VERSINE * number();
            let local = direction_at_angle(cosine, number());
            return Some((OrthonormalBasis::around(straight).to_world(local), longest));
        }
        let point = if let Some(emitter) = shape.emitter() {
            emitter.sample(from, u).point
        } else if shape.triangles() > 0 {
            let prim_id = to_u32(index_below(shape.triangles(), number()));
            let [a, b, c] = shape.corners(prim_id)?;
            let root = u[0].sqrt();
            a * (1.0 - root) + b * (root * (1.0 - u[1])) + c * (root * u[1])
        } else {
            from + direction_at_angle(1.0 - 2.0 * u[0], u[1])
        };
        Some(((point - from).try_normalize()?, longest))
    }

    /// Samples a light, or a point of one.
    pub(crate) fn target<'lights, S: Intersect>(
        &self,
        lights: &'lights Lights<'_, S>,
        u: [f64; 2],
    ) -> Option<CausticTarget<'lights>> {
        let (index, rest) = self.by_power.choose(u[0])?;
        let probability = self.by_power.probability(index);
        let surface = |surface, at, density, is_closed| CausticTarget {
            light: TargetLight::Surface {
                surface,
                at,
                is_closed,
                emission: lights.emission(surface, &at),
            },
            density: probability * density,
        };
        let u = [rest, u[1]];
        match &lights.lights[self.targets[index]] {
            Light::Punctual(light, _) => Some(CausticTarget {
                light: TargetLight::Punctual(light),
                density: probability,
            }),
            Light::Triangle(light) => {
                let at = light.at(light.point(u));
                Some(surface(light.surface, at, 1.0 / light.area(), false))
            }
            Light::Shape(light) => {
                // From its centre no part of a closed shape is hidden.
                let at = light.emitter.sample(light.middle(), u);
                let is_closed = !light.emitter.is_open();
                let density = light.emitter.density(&at);
                Some(surface(light.surface, at, density, is_closed))
            }
            Light::Environment => None,
        }
    }
}

/// The index of one of some things, by a number in [0, 1).
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "below the count"
)]
fn index_below(count: usize, u: f64) -> usize {
    ((u * count as f64) as usize).min(count - 1)
}

/// Whether a surface casts caustics that manifold sampling can find.
fn casts<S: Intersect>(materials: &CausticMaterials, surface: &Surface<S>) -> bool {
    let shape = &surface.shape;
    materials.casters[Id::new(surface.material.index())]
        && shape.normal_field().is_some()
        && is_room_for(shape.triangles(), 0)
}

/// Whether an emissive surface is small as seen from each of the casters.
fn is_small<S: Intersect>(world: &World<S>, surface: SurfaceId, casters: &[SurfaceId]) -> bool {
    let Some(ball) = world.surfaces[surface].shape.ball() else {
        return false;
    };
    let is_far = |caster: &SurfaceId| {
        let bounds = world.surfaces[*caster].shape.bounds();
        bounds
            .is_none_or(|bounds| ball.radius <= MOST_EXTENT * bounds.center().distance(ball.center))
    };
    casters.iter().all(is_far)
}

impl CausticTarget<'_> {
    /// The unit vector from a point to the light, and the distance; infinite for a sun.
    pub(crate) fn aim(&self, from: Vec3) -> Option<(Vec3, f64)> {
        let place = match &self.light {
            TargetLight::Punctual(Punctual::Directional(sun)) => {
                return Some((sun.direction, f64::INFINITY));
            }
            TargetLight::Punctual(Punctual::Point(light)) => light.position,
            TargetLight::Surface { at, .. } => at.point,
        };
        let (to, distance) = (place - from, place.distance(from));
        (distance > 0.0).then(|| (to / distance, distance))
    }

    /// The light that a point receives without anything between.
    pub(crate) fn received(&self, from: Vec3) -> Option<IncidentLight> {
        match &self.light {
            TargetLight::Punctual(light) => light.sample(from, self.density),
            TargetLight::Surface {
                at,
                is_closed,
                emission,
                ..
            } => {
                let (wi, distance) = self.aim(from)?;
                let cosine = -wi.dot(at.normal);
                let cosine = if *is_closed { cosine } else { cosine.abs() };
                // Convert from area to solid angle.
                let pdf = self.density * distance * distance / cosine;
                (pdf > 0.0 && pdf.is_finite()).then(|| IncidentLight {
                    wi,
                    radiance: *emission / pdf,
                    pdf: Some(pdf),
                    place: Some(at.point),
                })
            }
        }
    }

    /// The surface that the light is a part of.
    pub(crate) fn surface(&self) -> Option<SurfaceId> {
        match &self.light {
            TargetLight::Punctual(_) => None,
            TargetLight::Surface { surface, .. } => Some(*surface),
        }
    }
}

impl<S: Intersect> Lights<'_, S> {
    /// The surface that a light is a part of.
    fn surface_of(&self, light: LightId) -> Option<SurfaceId> {
        match &self.lights[light] {
            Light::Triangle(triangle) => Some(triangle.surface),
            Light::Shape(shape) => Some(shape.surface),
            Light::Punctual(..) | Light::Environment => None,
        }
    }
}
