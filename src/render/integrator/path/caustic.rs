//! Caustics: next-event estimation through chains of smooth surfaces, by specular manifold sampling
//! (Zeltner, Georgiev, Jakob, "Specular manifold sampling for rendering high-frequency caustics and
//! glints", SIGGRAPH 2020).
//!
//! A trial takes a random direction from the receiver to a smooth surface and a random chain along
//! it, and turns the direction by Newton's method until the chain ends at the sampled light, as a
//! manifold walk does (Hanika, Droske, Fascione, "Manifold next event estimation", EGSR 2015). The
//! unknowns are the two angles of the direction for chains of any length; ray differentials give
//! the Jacobian. A solution is found with an unknown probability p, whose reciprocal is estimated
//! without bias by the number of further trials until it is found again.
//!
//! With the determinant of that Jacobian, dω/dω' from the directions at the end of the chain to
//! those at the receiver, the light is that of a light sample from the last surface divided by it.

use super::PathTracer;
use super::chain::{DifferentialRay, MAX_CHAIN, SmoothChain};
use super::scatter::VertexBsdf;
use super::state::PathState;
use super::vertex::{PathVertex, RayEnd};
use crate::bsdf::BsdfLobes;
use crate::bsdf::standard::StandardParameters;
use crate::light::IncidentLight;
use crate::light::caustic::{CausticLights, CausticTarget};
use crate::shape::geometry::Intersect;
use crate::world::segment;
use rtc_math::{OrthonormalBasis, Vec3};
use rtc_plan::{Effect, PathFeatures};

/// The maximum number of trials until a solution is found again: the part (1 − p)ⁿ of its light is
/// lost.
const MAX_TRIALS: u32 = 1024;

/// The maximum number of steps of Newton's method.
const MAX_STEPS: u32 = 20;

/// The maximum number of times that a step is halved.
const MAX_HALVINGS: u32 = 4;

/// The rounding error of a cosine.
const ROUNDING: f64 = 1e-14;

/// A walk has arrived when its step is shorter, in radians.
const ARRIVED: f64 = 1e-9;

/// Two solutions are the same if their directions differ by less.
const SAME: f64 = 1e-6;

/// The point that a hit of an emitter may be off the sampled one, in units of the distance.
const NEAR: f64 = 1e-5;

/// The least roughness of a receiver: BSDF sampling is better at caustics on narrow lobes.
const LEAST_ROUGHNESS: f64 = 0.1;

/// The part of the estimates of caustics of glass that are made where no glass is straight before
/// the light: there they are mostly dim, and take most of the trials.
const SHARE_ASIDE: f64 = 0.25;

/// A direction in which a chain of smooth surfaces leads to the light.
struct Solution {
    chain: SmoothChain,
    direction: Vec3,
    /// The determinant of the derivative of the direction at the end by that at the receiver.
    determinant: f64,
}

impl Solution {
    fn is_same(&self, other: &Self) -> bool {
        self.chain == other.chain && self.direction.distance(other.direction) < SAME
    }
}

/// A step of Newton's method.
struct Turn {
    /// How the direction at the receiver has to turn.
    angles: [f64; 2],
    /// The determinant of the Jacobian.
    determinant: f64,
    /// 1 − cos of the angle between the ray at the end of the chain and the light.
    off: f64,
}

impl<'world, S: Intersect, const F: u32> PathTracer<'world, S, F> {
    /// The light that reaches a vertex from a sampled light through smooth surfaces.
    pub(super) fn caustic(
        &mut self,
        state: &PathState,
        vertex: &PathVertex<'_, 'world>,
        shading: &VertexBsdf<'_, F>,
    ) -> Vec3 {
        let lights = self.lights;
        let left = self.world.plan.max_depth - state.bounces;
        let most = MAX_CHAIN.min(left.saturating_sub(1) as usize);
        let Some(caustics) = lights.caustics.as_ref().filter(|_| most > 0) else {
            return Vec3::ZERO;
        };
        self.counts.add(Effect::Caustics);
        // Draw numbers that no other decision of the path uses.
        let mut drawn = 0;
        let mut number = || {
            drawn += 1;
            state.sobol.uniform(!state.bounces, drawn)
        };
        let u = [number(), number()];
        let Some(target) = caustics.target(lights, u) else {
            return Vec3::ZERO;
        };
        let straight = self.straight(caustics, vertex, &target);
        let is_aside = straight.is_none() && caustics.is_of_glass();
        let share = if is_aside { SHARE_ASIDE } else { 1.0 };
        if is_aside && number() >= share {
            return Vec3::ZERO;
        }
        let seeds = (most, straight);
        let mut trial = |tracer: &Self| tracer.trial(caustics, vertex, &target, seeds, &mut number);
        let Some(solution) = trial(self) else {
            return Vec3::ZERO;
        };
        let light = self.light_along(state, vertex, shading, &target, &solution);
        if light == Vec3::ZERO {
            return light;
        }
        // Estimate the reciprocal of the probability of the solution.
        let trials = (1..MAX_TRIALS).find(|_| {
            !self.heartbeat.passes(&self.counts)
                || trial(self).is_some_and(|other| other.is_same(&solution))
        });
        light * (f64::from(trials.unwrap_or(MAX_TRIALS)) / share)
    }

    /// The direction to the light, if a surface that transmits is first in the way.
    fn straight(
        &self,
        caustics: &CausticLights,
        vertex: &PathVertex<'_, 'world>,
        target: &CausticTarget<'_>,
    ) -> Option<Vec3> {
        let (direction, _) = target.aim(vertex.at.point)?;
        let from = (vertex.hit.surface, vertex.hit.prim_id);
        let hit = self
            .world
            .closest_hit_from(&vertex.at.ray(direction), from)?;
        let material = self.world.surfaces[hit.surface].material;
        let transmits = self.world.standards[material].transmission.factor > 0.0;
        (transmits && caustics.casts(hit.surface)).then_some(direction)
    }

    /// Walks from a random chain to one that leads to the light.
    fn trial(
        &self,
        caustics: &CausticLights,
        vertex: &PathVertex<'_, 'world>,
        target: &CausticTarget<'_>,
        (most, straight): (usize, Option<Vec3>),
        mut number: impl FnMut() -> f64,
    ) -> Option<Solution> {
        let from = (vertex.hit.surface, vertex.hit.prim_id);
        let ray = |direction| DifferentialRay::new(vertex.at, from, direction);
        let at = vertex.at.point;
        let (mut direction, longest) = caustics.seed(self.world, at, straight, &mut number)?;
        let (chain, beam, mut first) = self.random_chain(caustics, ray(direction), most, number)?;
        let mut turn = Turn::of(&beam, target)?;
        for _ in 0..MAX_STEPS {
            let [a, b] = turn.angles;
            if (a * a + b * b).sqrt() < ARRIVED {
                return Some(Solution {
                    chain,
                    direction,
                    determinant: turn.determinant,
                });
            }
            // Move the first point along its surface; halve the step until the chain exists and
            // leads closer to the light.
            let mut share = 2.0;
            let mut halvings = 0..=MAX_HALVINGS;
            (direction, first, turn) = halvings.find_map(|_| {
                share *= 0.5;
                let point = self.moved(&first, turn.angles, longest, share);
                let next = (point - at).try_normalize()?;
                let (beam, vertex) = self.follow(caustics, ray(next), &chain)?;
                let closer = Turn::of(&beam, target)?;
                (closer.off <= turn.off + ROUNDING).then_some((next, vertex, closer))
            })?;
        }
        None
    }

    /// The light along a solution: the BSDF, the throughput of the chain and the light at its end.
    fn light_along(
        &mut self,
        state: &PathState,
        vertex: &PathVertex<'_, 'world>,
        VertexBsdf { frame, bsdf, wo }: &VertexBsdf<'_, F>,
        target: &CausticTarget<'_>,
        solution: &Solution,
    ) -> Vec3 {
        let (at, wi) = (vertex.at, solution.direction);
        let local = frame.to_local(wi);
        let through = local.z * wo.z < 0.0;
        if through != (wi.dot(at.normal) * -state.ray.direction.dot(at.normal) < 0.0) {
            return Vec3::ZERO;
        }
        let f = bsdf.f(local) * (local.z.abs() / solution.determinant);
        if f == Vec3::ZERO || !f.is_finite() {
            return Vec3::ZERO;
        }
        let mut end = PathState::new(at.ray(wi), state.sobol);
        (end.from, end.channel) = ((vertex.hit.surface, vertex.hit.prim_id), state.channel);
        (end.bounces, end.body) = (state.bounces + 1, state.body);
        if through && vertex.point.material.bounds_a_volume {
            end.enter(vertex.point.material, wi.dot(at.normal) < 0.0);
        }
        for transmits in solution.chain.transmits() {
            if !self.pass(&mut end, *transmits) {
                return Vec3::ZERO;
            }
        }
        f * end.beta * self.light_at_end(&mut end, target)
    }

    /// Scatters the light of a path at the smooth surface that its ray meets; false if it cannot.
    fn pass(&mut self, end: &mut PathState, transmits: bool) -> bool {
        let multiple = self.multiple_scattering;
        let passed = self.at_closest_hit(end, |tracer, end, vertex| {
            end.attenuate();
            let wo = -end.ray.direction;
            let point = vertex.point;
            let (frame, coat) = point.frame::<F>(vertex.at, vertex.shading_attributes, wo);
            let standard = point.standard::<F>(&frame, coat, end.channel, multiple);
            let local = frame.to_local(wo);
            let bsdf = BsdfLobes::<F>::new(&standard, local);
            let (wi, fraction) = bsdf.smooth(transmits)?;
            let wi = frame.to_world(wi).normalize();
            let is_regular = tracer.is_regular(vertex, frame.to_world(Vec3::Z));
            let crosses = wi.dot(vertex.at.normal) * wo.dot(vertex.at.normal) < 0.0;
            if !is_regular || crosses != transmits {
                return None;
            }
            end.beta *= fraction;
            if transmits && point.material.bounds_a_volume {
                end.enter(point.material, wi.dot(vertex.at.normal) < 0.0);
            }
            end.ray = vertex.at.ray(wi);
            end.from = (vertex.hit.surface, vertex.hit.prim_id);
            Some(())
        });
        matches!(passed, RayEnd::Surface(Some(())))
    }

    /// The light that arrives at the end of a chain.
    fn light_at_end(&self, end: &mut PathState, target: &CausticTarget<'_>) -> Vec3 {
        let origin = end.ray.origin;
        let Some(IncidentLight {
            wi,
            radiance,
            place,
            ..
        }) = target.received(origin)
        else {
            return Vec3::ZERO;
        };
        let distance = place.map_or(f64::INFINITY, |place| place.distance(origin));
        let is_visible = match (target.surface(), place.map(|place| segment(origin, place))) {
            // The emitter itself is the closest hit, at the sampled point.
            (Some(surface), _) => {
                let hit = self.world.closest_hit_from(&end.ray, end.from);
                hit.is_some_and(|hit| {
                    hit.surface == surface && (hit.t - distance).abs() <= NEAR * distance
                })
            }
            (None, None) => !self.world.any_hit_from(&end.ray, f64::INFINITY, end.from),
            (None, Some(Some((ray, t_max)))) => !self.world.any_hit_from(&ray, t_max, end.from),
            (None, Some(None)) => true,
        };
        if !is_visible || wi.dot(end.ray.direction) < 1.0 - NEAR {
            return Vec3::ZERO;
        }
        if end.body.absorption != Vec3::ZERO && !distance.is_finite() {
            return Vec3::ZERO;
        }
        radiance * end.body.carried(place.map(|_| distance))
    }

    /// Whether a vertex of a path continues a chain that [`Self::caustic`] covers: its surface is a
    /// caster, and its shading normal is not clamped.
    pub(super) fn is_regular(&self, vertex: &PathVertex<'_, 'world>, normal: Vec3) -> bool {
        let caustics = self.lights.caustics.as_ref();
        let interpolated = vertex.shading_attributes.normal.unwrap_or(vertex.at.normal);
        caustics.is_some_and(|caustics| caustics.casts(vertex.hit.surface))
            && interpolated.dot(normal).abs() > 1.0 - 1e-12
    }

    /// Whether caustics are estimated on the surface of a vertex: not on those that cast some.
    pub(super) fn receives(
        &self,
        vertex: &PathVertex<'_, 'world>,
        standard: &StandardParameters,
    ) -> bool {
        let is_rough = standard.roughness == 0.0 || standard.roughness >= LEAST_ROUGHNESS;
        let caustics = self.lights.caustics.as_ref();
        is_rough && caustics.is_some_and(|caustics| !caustics.casts(vertex.hit.surface))
    }

    /// Whether caustics are estimated.
    #[inline]
    pub(super) fn has_caustics(&self) -> bool {
        self.does(PathFeatures::NEE) && self.lights.caustics.is_some()
    }
}

impl Turn {
    /// The step after which the ray at the end of the chain meets the light; `None` if the Jacobian
    /// is singular.
    fn of(beam: &DifferentialRay, target: &CausticTarget<'_>) -> Option<Self> {
        let d = beam.ray.direction;
        let (towards, distance) = target.aim(beam.ray.origin)?;
        let OrthonormalBasis {
            tangent, bitangent, ..
        } = OrthonormalBasis::around(d);
        let across = |v: Vec3| [tangent.dot(v), bitangent.dot(v)];
        // A light behind the ray is as far away as possible.
        let off = match towards.dot(d) < 0.0 {
            true => (towards - d * d.dot(towards)).normalize_or(tangent),
            false => towards,
        };
        let [x, y] = across(off);
        // The direction to the light turns against that of the ray.
        let [[a, c], [b, e]] = beam
            .differentials
            .map(|change| across(change.direction + change.origin / distance));
        let determinant = a * e - b * c;
        let angles = [(x * e - b * y) / determinant, (a * y - x * c) / determinant];
        (angles[0].is_finite() && angles[1].is_finite()).then(|| Self {
            angles,
            determinant: determinant.abs(),
            off: 1.0 - d.dot(towards),
        })
    }
}
