//! Next-event estimation: the lights of a scene, and how a point samples them.
//!
//! - [`Lights`] lists punctual lights (`punctual`), emissive triangles and shapes (`triangle`,
//!   `shape`), and
//!   the environment (`environment`). `course` has the lights of the Whitted integrator.
//! - [`Lights`] chooses a light in proportion to its power, or by a light tree (`tree`) if there
//!   are
//!   many local lights, then a point or a direction on it: an [`IncidentLight`].
//! - It also returns the density with which it would sample a direction, for multiple importance
//!   sampling with the BSDF.
//!
//! A light of zero weight is never sampled; only BSDF sampling finds it.

mod aimed;
pub(crate) mod caustic;
pub(crate) mod course;
pub(crate) mod environment;
pub(crate) mod punctual;
mod shape;
mod tree;
mod triangle;

use crate::integrator::path::SamplingStrategy;
use crate::light::caustic::CausticLights;
use crate::light::environment::EnvironmentRadiance;
use crate::light::punctual::Punctual;
use crate::light::shape::ShapeLight;
use crate::light::tree::{LightTree, TreeLight};
use crate::light::triangle::TriangleLight;
use crate::material::point::MaterialPoint;
use crate::material::standard::{Alpha, StandardMaterial};
use crate::ray::{Interaction, Ray};
use crate::sampler::discrete::DiscreteDistribution;
use crate::shape::emitter::EmitterPoint;
use crate::shape::geometry::{AttributeRequest, Intersect, ShadingAttributes};
use crate::world::{PunctualId, Surface, SurfaceId, SurfacePrimitive, World};
use rtc_math::{Bounds, Id, IdTable, Vec3, to_u32};
use rtc_plan::RemainingLight;
use std::f64::consts::PI;

/// Fewer local lights are chosen by power alone: with 8 a tree is slower (benches/sampling.md).
const LEAST_FOR_TREE: usize = 16;

/// The maximum number of listed lights, of some 300 bytes each: instances may repeat the triangles
/// of a mesh more often than memory allows.
const MOST_LISTED: usize = 1 << 21;

/// All lights of a world.
pub(crate) struct Lights<'world, S> {
    world: &'world World<S>,
    lights: IdTable<Light>,
    /// Over the lights, those of the tree with weight 0; the tree itself, if any, comes last.
    by_power: DiscreteDistribution,
    tree: Option<LightTree>,
    /// The one light that is ever chosen, if it is one.
    only: Option<LightId>,
    /// The probabilities of `by_power`.
    probabilities: IdTable<Light, f64>,
    /// The index of the first light of each surface that has some.
    first_light_of_surface: IdTable<Surface, Option<LightId>>,
    /// The numbers of the faces of each surface that has such lights, in order.
    faces_of_surface: IdTable<Surface, Vec<u32>>,
    /// What caustics are estimated for, if they are.
    pub(crate) caustics: Option<CausticLights>,
    /// Those at the moments of the shutter, as the worlds have them.
    pub(crate) moments: Vec<Lights<'world, S>>,
}

/// One of the lights that the path tracer chooses from.
enum Light {
    Punctual(Punctual, RemainingLight),
    Triangle(TriangleLight),
    Shape(Box<ShapeLight>),
    Environment,
}

/// The id of a light of the path tracer.
type LightId = Id<Light>;

/// Light that a point receives from one direction.
pub(crate) struct IncidentLight {
    /// The unit vector to the light.
    pub(crate) wi: Vec3,
    /// The radiance divided by the density.
    pub(crate) radiance: Vec3,
    /// The density per solid angle; `None` for a delta light, which BSDF sampling cannot find.
    pub(crate) pdf: Option<f64>,
    /// The sampled point, unless it is infinitely far away.
    pub(crate) place: Option<Vec3>,
}

/// Whether this many triangles of a surface are listed after this many lights. If not, only BSDF
/// sampling finds them.
fn is_room_for(triangles: usize, listed: usize) -> bool {
    listed.saturating_add(triangles) <= MOST_LISTED
}

/// The mean of some vectors, a power of two of them. They are added in pairs, so that the mean of
/// equal ones is exact.
fn mean(values: &[Vec3]) -> Vec3 {
    match values {
        [] => Vec3::ZERO,
        [value] => *value,
        _ => {
            let (first, second) = values.split_at(values.len() / 2);
            0.5 * (mean(first) + mean(second))
        }
    }
}

impl<'world, S: Intersect> Lights<'world, S> {
    /// The lights of a world.
    pub(crate) fn new(world: &'world World<S>, strategy: SamplingStrategy) -> Self {
        let left = |light: PunctualId| {
            let plan = world.plan.paths.as_ref();
            plan.map_or(RemainingLight::All, |plan| plan.lights[light])
        };
        // List the punctual lights that the plan keeps.
        let punctual = world.lights.punctual.entries();
        let mut lights = punctual
            .filter(|(index, _)| left(*index) != RemainingLight::Nothing)
            .map(|(index, light)| Light::Punctual(light.clone(), left(index)))
            .collect::<IdTable<Light>>();
        // List the emissive surfaces: shapes as one light, meshes by triangle.
        let mut first_light_of_surface = IdTable::from(vec![None; world.surfaces.len()]);
        let mut faces_of_surface = IdTable::from(vec![Vec::new(); world.surfaces.len()]);
        for (index, surface) in world.surfaces.entries() {
            let material = &world.standards[surface.material];
            let shines = !material.is_unlit && material.emission.factor != Vec3::ZERO;
            if !shines {
                continue;
            }
            for light in ShapeLight::of(index, &surface.shape) {
                let face = light.face;
                let id = lights.push(Light::Shape(Box::new(light)));
                first_light_of_surface[index].get_or_insert(id);
                faces_of_surface[index].extend(face);
            }
            let triangles = surface.shape.triangles();
            if triangles > 0 && is_room_for(triangles, lights.len()) {
                first_light_of_surface[index] = Some(LightId::new(lights.len()));
                let parts = to_u32(triangles);
                let corners = (0..parts)
                    .filter_map(|prim_id| Some((prim_id, surface.shape.corners(prim_id)?)));
                for (prim_id, corners) in corners {
                    lights.push(Light::Triangle(TriangleLight::new(index, prim_id, corners)));
                }
            }
        }
        // The environment is the last light.
        lights.push(Light::Environment);
        let mut all = Self {
            world,
            lights,
            by_power: DiscreteDistribution::new(std::iter::empty()),
            tree: None,
            only: None,
            probabilities: IdTable::default(),
            first_light_of_surface,
            faces_of_surface,
            caustics: None,
            moments: Vec::new(),
        };
        let moments = world.moments.iter();
        all.moments = moments.map(|world| Self::new(world, strategy)).collect();
        all.build_distribution(strategy);
        all
    }

    /// Computes the probabilities of lights, and builds a tree over the local lights if they are
    /// many.
    fn build_distribution(&mut self, strategy: SamplingStrategy) {
        let disc = PI * self.radius_squared();
        let weight = |light| self.weight(light, disc, strategy);
        let mut weights = self
            .lights
            .iter()
            .map(weight)
            .collect::<IdTable<Light, _>>();
        if self.world.settings.caustics && strategy != SamplingStrategy::BsdfSampling {
            self.caustics = CausticLights::new(self, &weights);
        }
        let numbered = weights.entries();
        let emitters = numbered.filter_map(|(light, power)| self.emitter(light, *power));
        let emitters = emitters.collect::<Vec<_>>();
        if emitters.len() >= LEAST_FOR_TREE {
            for emitter in &emitters {
                weights[emitter.light] = 0.0;
            }
            weights.push(emitters.iter().map(|emitter| emitter.power).sum());
            self.tree = Some(LightTree::new(emitters, self.lights.len()));
        }
        self.by_power = DiscreteDistribution::new(weights.iter().copied());
        let is_light = |light: &LightId| *light != self.tree_id();
        self.only = self.by_power.only().map(LightId::new).filter(is_light);
        let probability = |index| self.by_power.probability(index);
        self.probabilities = (0..weights.len()).map(probability).collect();
    }

    /// The id of the tree among the probabilities of the lights.
    fn tree_id(&self) -> LightId {
        LightId::new(self.lights.len())
    }

    /// A light as a tree stores it; `None` for one without a position or power.
    fn emitter(&self, light: LightId, power: f64) -> Option<TreeLight> {
        let (bounds, normal) = match &self.lights[light] {
            Light::Punctual(light, _) => (Bounds::around(light.place_of_falloff()?, 0.0), None),
            Light::Triangle(triangle) => (Bounds::of(triangle.corners), Some(triangle.normal())),
            Light::Shape(shape) => (shape.bounds?, shape.emitter.flat_normal()),
            Light::Environment => return None,
        };
        (power > 0.0).then_some(TreeLight {
            light,
            bounds,
            power,
            normal,
        })
    }

    /// Chooses a light for a point: its id, its probability, and the sample values for a point
    /// on it.
    fn choose(&self, from: Vec3, u: impl FnOnce() -> [f64; 2]) -> Option<(LightId, f64, [f64; 2])> {
        if let Some(only) = self.only {
            // A light without size needs no numbers, if it is the only one.
            let u = match self.lights[only] {
                Light::Punctual(..) => [0.0; 2],
                Light::Triangle(_) | Light::Shape(_) | Light::Environment => u(),
            };
            return Some((only, self.probabilities[only], u));
        }
        let [u, v] = u();
        let (index, rest) = self.by_power.choose(u)?;
        let index = LightId::new(index);
        let probability = self.probabilities[index];
        Some(match &self.tree {
            Some(tree) if index == self.tree_id() => {
                let (light, share, rest) = tree.choose(from, rest);
                (light, probability * share, [rest, v])
            }
            _ => (index, probability, [rest, v]),
        })
    }

    /// The probability of choosing a light for a point.
    fn probability(&self, light: LightId, from: Vec3) -> f64 {
        let by_power = self.probabilities[light];
        self.tree.as_ref().map_or(by_power, |tree| {
            by_power + self.probabilities[self.tree_id()] * tree.probability(light, from)
        })
    }

    /// The square of the radius of a sphere around all bounded surfaces.
    fn radius_squared(&self) -> f64 {
        let boxes = self
            .world
            .surfaces
            .iter()
            .filter_map(|surface| surface.shape.bounds());
        let total = boxes.fold(Bounds::EMPTY, Bounds::union);
        let square = (total.max - total.min).length_squared() / 4.0;
        if square > 0.0 && square.is_finite() {
            square
        } else {
            1.0
        }
    }

    /// The approximate power that a light sends to the scene, whose cross section is `disc`.
    fn weight(&self, light: &Light, disc: f64, strategy: SamplingStrategy) -> f64 {
        match light {
            _ if strategy == SamplingStrategy::BsdfSampling
                && !matches!(light, Light::Punctual(..)) =>
            {
                0.0
            }
            Light::Punctual(light, _) => light.power(disc),
            Light::Triangle(triangle) => {
                2.0 * PI * triangle.area() * self.mean_emission(triangle).max_element()
            }
            Light::Shape(shape) => {
                shape.power(self.mean_emission_of_shape(shape), (disc / PI).sqrt())
            }
            // BSDF sampling is best for a uniform environment.
            Light::Environment
                if self.world.lights.environment.is_uniform()
                    && strategy != SamplingStrategy::Nee =>
            {
                0.0
            }
            Light::Environment => PI * self.world.lights.environment.mean() * disc,
        }
    }

    /// The mean radiance of a triangle, estimated at four points.
    fn mean_emission(&self, triangle: &TriangleLight) -> Vec3 {
        const WEIGHTS: [[f64; 3]; 4] = [
            [1.0 / 3.0, 1.0 / 3.0, 1.0 / 3.0],
            [0.8, 0.1, 0.1],
            [0.1, 0.8, 0.1],
            [0.1, 0.1, 0.8],
        ];
        let emission = &self.material(triangle.surface).emission;
        if emission.map.is_none() {
            return emission.factor;
        }
        let [a, b, c] = triangle.corners;
        let at = |[u, v, w]: [f64; 3]| triangle.at(a * u + b * v + c * w);
        let emission = |weights| self.point(triangle.surface, &at(weights)).0.emission();
        mean(&WEIGHTS.map(emission))
    }

    /// The mean radiance of a shape, estimated at 16 points.
    fn mean_emission_of_shape(&self, light: &ShapeLight) -> Vec3 {
        /// The points are the centres of this many cells, squared.
        const CELLS: u32 = 4;
        let emission = &self.material(light.surface).emission;
        if emission.map.is_none() {
            return emission.factor;
        }
        let middle = |cell: u32| (f64::from(cell) + 0.5) / f64::from(CELLS);
        let at = |cell: u32| {
            let u = [middle(cell % CELLS), middle(cell / CELLS)];
            let mut at = light.emitter.sample(light.middle(), u);
            at.prim_id = light.face.unwrap_or(at.prim_id);
            self.point(light.surface, &at).0.emission()
        };
        mean(&(0..CELLS * CELLS).map(at).collect::<Vec<_>>())
    }

    /// The material at a point of a surface.
    fn point(
        &self,
        surface: SurfaceId,
        at: &EmitterPoint,
    ) -> (MaterialPoint<'world>, ShadingAttributes) {
        let ray = Ray {
            origin: at.point,
            direction: at.normal,
        };
        let interaction = Interaction {
            point: at.point,
            normal: at.normal,
            offset: 0.0,
            back: -at.normal,
        };
        let request = AttributeRequest {
            uv: true,
            tangent: false,
        };
        let shape = &self.world.surfaces[surface].shape;
        let attributes = shape.shading_attributes(&ray, &interaction, at.prim_id, request);
        let point = MaterialPoint::new(self.material(surface), &attributes, at.point);
        (point, attributes)
    }

    /// The radiance that a point of a surface emits on average: alpha leaves out the rest.
    fn emission(&self, surface: SurfaceId, at: &EmitterPoint) -> Vec3 {
        let material = self.material(surface);
        let is_whole = material.alpha == Alpha::Opaque && material.blend.is_none();
        if material.emission.map.is_none() && is_whole {
            return material.emission.factor;
        }
        let (point, attributes) = self.point(surface, at);
        let emission = point.emission();
        emission * point.mean_opacity(&self.world.standards, &attributes)
    }

    fn material(&self, surface: SurfaceId) -> &'world StandardMaterial {
        &self.world.standards[self.world.surfaces[surface].material]
    }

    /// Samples the light that reaches a point: two values in [0, 1), drawn where they are needed,
    /// choose a point on it or a direction to it; the first one chooses the light, too.
    pub(crate) fn sample(&self, from: Vec3, u: impl FnOnce() -> [f64; 2]) -> Option<IncidentLight> {
        let (index, probability, u) = self.choose(from, u)?;
        match &self.lights[index] {
            Light::Punctual(_, RemainingLight::OnlyIndex | RemainingLight::Nothing) => None,
            Light::Punctual(light, RemainingLight::All) => light.sample(from, probability),
            Light::Triangle(triangle) => {
                // Sample a point of the triangle, and convert from area to solid angle.
                let point = triangle.point(u);
                let wi = (point - from).try_normalize()?;
                let pdf = probability * triangle.pdf(wi, point.distance_squared(from));
                let radiance = self.emission(triangle.surface, &triangle.at(point)) / pdf;
                (pdf > 0.0 && pdf.is_finite()).then_some(IncidentLight {
                    wi,
                    radiance,
                    pdf: Some(pdf),
                    place: Some(point),
                })
            }
            Light::Shape(light) => self.sample_shape(light, from, probability, u),
            Light::Environment => {
                let (wi, EnvironmentRadiance { radiance, pdf }) =
                    self.world.lights.environment.sample(u);
                let pdf = probability * pdf;
                (pdf > 0.0).then_some(IncidentLight {
                    wi,
                    radiance: radiance / pdf,
                    pdf: Some(pdf),
                    place: None,
                })
            }
        }
    }

    /// Samples a shape that is chosen with a probability.
    fn sample_shape(
        &self,
        light: &ShapeLight,
        from: Vec3,
        probability: f64,
        u: [f64; 2],
    ) -> Option<IncidentLight> {
        let at = light.emitter.sample(from, u);
        let wi = (at.point - from).try_normalize()?;
        let square = at.point.distance_squared(from);
        let pdf = probability * light.emitter.pdf(from, wi, &at, square);
        let shape = &self.world.surfaces[light.surface].shape;
        let (at, end) = light.seen(shape, from, wi, at)?;
        let radiance = self.emission(light.surface, &at) / pdf;
        (pdf > 0.0 && pdf.is_finite()).then_some(IncidentLight {
            wi,
            radiance,
            pdf: Some(pdf),
            place: Some(end),
        })
    }

    /// The density with which [`Lights::sample`] samples the direction `wi` to a point of a
    /// primitive of a surface, where the normal is given, from a point at the given distance.
    pub(crate) fn pdf_of_surface(
        &self,
        (surface, prim_id): SurfacePrimitive,
        (place, normal): (Vec3, Vec3),
        wi: Vec3,
        distance: f64,
    ) -> f64 {
        let Some(first) = self.first_light_of_surface[surface] else {
            return 0.0;
        };
        let (from, square) = (place - wi * distance, distance * distance);
        if let Light::Shape(_) = &self.lights[first] {
            let (face, normal) = self.world.surfaces[surface].shape.face(prim_id, normal);
            let faces = &self.faces_of_surface[surface];
            let at = EmitterPoint {
                point: place,
                normal,
                prim_id,
            };
            let place = match faces.is_empty() {
                true => Some(0),
                false => faces.binary_search(&face).ok(),
            };
            return place.map_or(0.0, |place| {
                let index = LightId::new(first.index() + place);
                let Light::Shape(light) = &self.lights[index] else {
                    return 0.0;
                };
                self.probability(index, from) * light.emitter.pdf(from, wi, &at, square)
            });
        }
        let index = LightId::new(first.index() + prim_id as usize);
        match &self.lights[index] {
            Light::Triangle(triangle) => self.probability(index, from) * triangle.pdf(wi, square),
            Light::Shape(_) | Light::Punctual(..) | Light::Environment => 0.0,
        }
    }

    /// The radiance of the environment in a direction, and, if requested, the density with which
    /// [`Lights::sample`] samples it.
    pub(crate) fn environment(&self, wi: Vec3) -> (Vec3, impl FnOnce() -> f64) {
        let environment = &self.world.lights.environment;
        let (radiance, place) = environment.seen(wi);
        let probability = self.probabilities[LightId::new(self.lights.len() - 1)];
        (radiance, move || probability * environment.pdf(wi, place))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_mean_of_equal_emission_is_exact() {
        for count in [1, 4, 16] {
            let value = Vec3::new(0.1, 0.7, 1.0 / 3.0);
            assert_eq!(mean(&vec![value; count]), value, "{count}");
        }
    }

    #[test]
    fn instances_do_not_fill_memory_with_lights() {
        assert!(is_room_for(MOST_LISTED, 0));
        assert!(!is_room_for(MOST_LISTED, 1) && !is_room_for(usize::MAX, 1));
    }
}
