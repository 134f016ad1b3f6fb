//! The lights that paths can be aimed at, each chosen by its power: lights without extent, shining
//! triangles, and the image that surrounds the scene.
//!
//! A light of weight 0 is never aimed at; surfaces that scatter find it.

pub(in crate::render) mod environment;

use crate::math::Vec3;
use crate::plan::LightLeft;
use crate::render::accel::bounds::Bounds;
use crate::render::integrator::path::Strategy;
use crate::render::light::environment::{Environment, Seen};
use crate::render::material::standard::Point;
use crate::render::ray::{Interaction, Ray};
use crate::render::sampler::discrete::Choice;
use crate::render::shape::geometry::Geometry;
use crate::render::shape::instance::Asked;
use crate::render::world::World;
use crate::valid::{Emitter, Falloff, Punctual};
use std::f64::consts::PI;

/// All lights of a world.
pub(in crate::render) struct Lights<'world, S> {
    world: &'world World<S>,
    environment: Environment<'world>,
    lights: Vec<Light>,
    choice: Choice,
    /// The index of the first light of each surface that has some.
    firsts: Vec<Option<usize>>,
}

enum Light {
    Punctual(Punctual, LightLeft),
    Triangle {
        surface: usize,
        part: u32,
        corners: [Vec3; 3],
    },
    Environment,
}

/// Light that a point receives from one direction.
pub(in crate::render) struct Incident {
    /// The unit vector to the light.
    pub(in crate::render) wi: Vec3,
    /// The radiance, divided by the density unless that is a delta.
    pub(in crate::render) radiance: Vec3,
    /// The density per solid angle; `None` for a light that nothing else finds.
    pub(in crate::render) pdf: Option<f64>,
    /// Where it is, unless infinitely far away.
    pub(in crate::render) place: Option<Vec3>,
}

impl<'world, S: Geometry> Lights<'world, S> {
    /// The lights of a world.
    pub(in crate::render) fn new(world: &'world World<S>, strategy: Strategy) -> Self {
        let environment = Environment::new(&world.scene);
        let left = |index: usize| {
            let plan = world.plan.paths.as_ref();
            plan.map_or(LightLeft::All, |plan| plan.lights[index])
        };
        let punctual = world.scene.punctual().iter().enumerate();
        let mut lights = punctual
            .filter(|(index, _)| left(*index) != LightLeft::Nothing)
            .map(|(index, light)| Light::Punctual(*light, left(index)))
            .collect::<Vec<_>>();
        let mut firsts = vec![None; world.surfaces.len()];
        for (index, surface) in world.surfaces.iter().enumerate() {
            let material = &world.standards[surface.material];
            if !material.unlit && material.emissive != [0.0; 3] && surface.shape.triangles() > 0 {
                firsts[index] = Some(lights.len());
                let parts = u32::try_from(surface.shape.triangles()).unwrap_or(u32::MAX);
                let corners =
                    (0..parts).filter_map(|part| Some((part, surface.shape.corners(part)?)));
                lights.extend(corners.map(|(part, corners)| Light::Triangle {
                    surface: index,
                    part,
                    corners,
                }));
            }
        }
        lights.push(Light::Environment);
        let mut all = Self {
            world,
            environment,
            lights,
            choice: Choice::new(std::iter::empty()),
            firsts,
        };
        let disc = PI * all.radius_squared();
        all.choice = Choice::new(
            all.lights
                .iter()
                .map(|light| all.weight(light, disc, strategy)),
        );
        all
    }

    /// The square of the radius of a sphere around all that has an end.
    fn radius_squared(&self) -> f64 {
        let boxes = self
            .world
            .surfaces
            .iter()
            .filter_map(|surface| surface.shape.bounds());
        let whole = boxes.fold(Bounds::EMPTY, Bounds::union);
        let square = (whole.max - whole.min).length_squared() / 4.0;
        if square > 0.0 && square.is_finite() {
            square
        } else {
            1.0
        }
    }

    /// About the power that a light sends to the scene, whose silhouette is `disc`.
    fn weight(&self, light: &Light, disc: f64, strategy: Strategy) -> f64 {
        match light {
            _ if strategy == Strategy::BsdfSampling && !matches!(light, Light::Punctual(..)) => 0.0,
            Light::Punctual(light, _) => {
                let solid_angle = match light.emitter {
                    Emitter::Sun(_) => disc,
                    Emitter::Point(_, Falloff::Square(_)) => 4.0 * PI,
                    Emitter::Spot {
                        outer,
                        falloff: Falloff::Square(_),
                        ..
                    } => 2.0 * PI * (1.0 - outer),
                    // Without falloff it is as strong everywhere.
                    Emitter::Point(..) | Emitter::Spot { .. } => disc,
                };
                light.intensity.max_element() * solid_angle
            }
            Light::Triangle {
                surface,
                part,
                corners,
            } => {
                let [a, b, c] = *corners;
                let area = 0.5 * (b - a).cross(c - a).length();
                2.0 * PI * area * self.mean_emission(*surface, *part, *corners).max_element()
            }
            // What is the same everywhere is found best by scattering.
            Light::Environment if self.environment.is_uniform() && strategy != Strategy::Nee => 0.0,
            Light::Environment => PI * self.environment.mean() * disc,
        }
    }

    /// The mean of the radiance at some points of a triangle.
    fn mean_emission(&self, surface: usize, part: u32, corners: [Vec3; 3]) -> Vec3 {
        const WEIGHTS: [[f64; 3]; 4] = [
            [1.0 / 3.0, 1.0 / 3.0, 1.0 / 3.0],
            [0.8, 0.1, 0.1],
            [0.1, 0.8, 0.1],
            [0.1, 0.1, 0.8],
        ];
        let material = &self.world.standards[self.world.surfaces[surface].material];
        if material.emissive_map.is_none() {
            return Vec3::from_array(material.emissive);
        }
        let at = |[u, v, w]: [f64; 3]| corners[0] * u + corners[1] * v + corners[2] * w;
        WEIGHTS
            .map(|weights| self.emission(surface, part, at(weights), corners))
            .into_iter()
            .sum::<Vec3>()
            / 4.0
    }

    /// The radiance of a point of a triangle.
    fn emission(&self, surface: usize, part: u32, point: Vec3, [a, b, c]: [Vec3; 3]) -> Vec3 {
        let surface = &self.world.surfaces[surface];
        let material = &self.world.standards[surface.material];
        if material.emissive_map.is_none() {
            return Vec3::from_array(material.emissive);
        }
        let normal = (b - a).cross(c - a).normalize_or(Vec3::Z);
        let ray = Ray {
            origin: point,
            direction: normal,
        };
        let at = Interaction {
            point,
            normal,
            offset: 0.0,
            back: -normal,
        };
        let details = surface.shape.details(
            &ray,
            &at,
            part,
            Asked {
                uv: true,
                tangent: false,
            },
        );
        Point::new(&self.world.scene, material, &details).emission()
    }

    /// Light for a point, from a light chosen by `choice` and a place on it, if it has several, by
    /// `u`.
    pub(in crate::render) fn sample(
        &self,
        from: Vec3,
        choice: f64,
        u: impl FnOnce() -> [f64; 2],
    ) -> Option<Incident> {
        let (index, _) = self.choice.choose(choice)?;
        let probability = self.choice.probability(index);
        match &self.lights[index] {
            Light::Punctual(_, LightLeft::Place | LightLeft::Nothing) => None,
            Light::Punctual(light, LightLeft::All) => punctual(light, from, probability),
            Light::Triangle {
                surface,
                part,
                corners,
            } => {
                let point = point_of_triangle(corners, u());
                let wi = (point - from).try_normalize()?;
                let pdf = probability * pdf_of_triangle(corners, wi, point.distance_squared(from));
                let radiance = self.emission(*surface, *part, point, *corners) / pdf;
                (pdf > 0.0 && pdf.is_finite()).then_some(Incident {
                    wi,
                    radiance,
                    pdf: Some(pdf),
                    place: Some(point),
                })
            }
            Light::Environment => {
                let (wi, Seen { radiance, pdf }) = self.environment.sample(u());
                let pdf = probability * pdf;
                (pdf > 0.0).then_some(Incident {
                    wi,
                    radiance: radiance / pdf,
                    pdf: Some(pdf),
                    place: None,
                })
            }
        }
    }

    /// The density with which [`Lights::sample`] takes the direction `wi`, in which a part of a
    /// surface is found at the square of a distance given.
    pub(in crate::render) fn pdf_of_surface(
        &self,
        surface: usize,
        part: u32,
        wi: Vec3,
        distance_squared: f64,
    ) -> f64 {
        let Some(first) = self.firsts[surface] else {
            return 0.0;
        };
        let index = first + part as usize;
        match &self.lights[index] {
            Light::Triangle { corners, .. } => {
                self.choice.probability(index) * pdf_of_triangle(corners, wi, distance_squared)
            }
            Light::Punctual(..) | Light::Environment => 0.0,
        }
    }

    /// The radiance from a direction that leads to no surface, and the density with which
    /// [`Lights::sample`] takes it.
    pub(in crate::render) fn environment(&self, wi: Vec3) -> (Vec3, f64) {
        let Seen { radiance, pdf } = self.environment.seen(wi);
        (
            radiance,
            self.choice.probability(self.lights.len() - 1) * pdf,
        )
    }
}

/// `r²/(A·|cos θ|)`, from area to solid angle.
fn pdf_of_triangle([a, b, c]: &[Vec3; 3], wi: Vec3, distance_squared: f64) -> f64 {
    // The cross product is twice the area times the normal.
    let projected = 0.5 * (*b - *a).cross(*c - *a).dot(wi).abs();
    if projected > 0.0 {
        distance_squared / projected
    } else {
        0.0
    }
}

/// A point of a triangle, all equally likely (Heitz, "A low-distortion map between triangle and
/// square", 2019).
fn point_of_triangle([a, b, c]: &[Vec3; 3], [u, v]: [f64; 2]) -> Vec3 {
    let (u, v) = if v > u {
        (u * 0.5, v - u * 0.5)
    } else {
        (u - v * 0.5, v * 0.5)
    };
    *a * u + *b * v + *c * (1.0 - u - v)
}

/// Light from a light without extent, chosen with the probability given.
fn punctual(light: &Punctual, from: Vec3, probability: f64) -> Option<Incident> {
    let towards = |place: Vec3| (place - from).try_normalize();
    let (wi, place, strength) = match light.emitter {
        Emitter::Sun(direction) => (direction, None, 1.0),
        Emitter::Point(place, falloff) => (
            towards(place)?,
            Some(place),
            faded(falloff, place.distance_squared(from)),
        ),
        Emitter::Spot {
            position,
            direction,
            inner,
            outer,
            falloff,
        } => {
            let wi = towards(position)?;
            // KHR_lights_punctual: the square of a ramp between the cosines.
            let ramp = ((-wi.dot(direction) - outer) / (inner - outer)).clamp(0.0, 1.0);
            (
                wi,
                Some(position),
                ramp * ramp * faded(falloff, position.distance_squared(from)),
            )
        }
    };
    let radiance = light.intensity * (strength / probability);
    (strength > 0.0 && radiance.is_finite()).then_some(Incident {
        wi,
        radiance,
        pdf: None,
        place,
    })
}

/// How light fades, by the square of the distance; with a range as KHR_lights_punctual recommends.
fn faded(falloff: Falloff, distance_squared: f64) -> f64 {
    match falloff {
        Falloff::None => 1.0,
        Falloff::Square(None) => 1.0 / distance_squared,
        Falloff::Square(Some(range)) => {
            let share = distance_squared / (range * range);
            (1.0 - share * share).clamp(0.0, 1.0) / distance_squared
        }
    }
}
