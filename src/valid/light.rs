//! The proof of the lights.

use super::check::{Check, place};
use crate::diag::Diagnostic;
use crate::diag::codes;
use crate::ir::{self, Field, Noun, Place};
use crate::math::{NonNegative, Vec3, unit};

/// A point light, or with a radius a soft one.
#[derive(Clone, Copy, Debug)]
pub struct Light {
    /// Where it stands.
    pub position: Vec3,
    /// Its colour, each channel at least 0.
    pub color: Vec3,
    /// Its radius; 0 for a point.
    pub radius: NonNegative,
}

/// A light without extent, in physical units.
#[derive(Clone, Copy, Debug)]
pub struct Punctual {
    /// How and from where it shines.
    pub emitter: Emitter,
    /// Of a sun the irradiance on a surface that faces it, of the others the radiant intensity;
    /// each channel at least 0.
    pub intensity: Vec3,
}

/// How a light without extent shines; directions are unit vectors.
#[derive(Clone, Copy, Debug)]
pub enum Emitter {
    /// From infinitely far away, in this direction.
    Sun(Vec3),
    /// From a point into all directions.
    Point(Vec3, Falloff),
    /// From a point into a cone.
    Spot {
        /// Where it stands.
        position: Vec3,
        /// Where it shines.
        direction: Vec3,
        /// Within this cosine it shines fully.
        inner: f64,
        /// Beyond this cosine it is dark.
        outer: f64,
        /// How it fades.
        falloff: Falloff,
    },
}

/// How light fades with distance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Falloff {
    /// Not at all, as in the course.
    None,
    /// With the square of the distance, up to the range if it has one.
    Square(Option<f64>),
}

/// A light of any kind.
#[derive(Clone, Copy, Debug)]
pub(super) enum Any {
    Point(Light),
    Punctual(Punctual),
}

pub(super) fn light(light: &ir::Light, index: usize, check: &mut Check<'_>) -> Option<Any> {
    let ir::PointLight {
        position,
        color,
        radius,
    } = match light {
        ir::Light::Point(light) => light,
        ir::Light::Punctual(light) => {
            return punctual_light(light, index, check).map(Any::Punctual);
        }
    };
    let position = check.vector(*position, place(Noun::Light, index, Field::Position));
    let color = check.color(*color, place(Noun::Light, index, Field::Color));
    let radius = check.non_negative(
        *radius,
        "radius",
        place(Noun::Light, index, Field::LightRadius),
    );
    Some(Any::Point(Light {
        position: position?,
        color: color?,
        radius: radius?,
    }))
}

/// The lights of the course among all.
pub(super) fn of_the_course(lights: &[Any]) -> Vec<Light> {
    let point = |light: &Any| {
        if let Any::Point(light) = light {
            Some(*light)
        } else {
            None
        }
    };
    lights.iter().filter_map(point).collect()
}

/// The lights in physical units, and those of the course as such if `with_points`: a white Lambert
/// surface that faces one has the radiance of its colour.
pub(super) fn punctual(lights: &[Any], with_points: bool) -> Vec<Punctual> {
    let physical = |light: &Any| match light {
        Any::Punctual(light) => Some(*light),
        Any::Point(light) => with_points.then(|| Punctual {
            emitter: Emitter::Point(light.position, Falloff::None),
            intensity: light.color * std::f64::consts::PI,
        }),
    };
    lights.iter().filter_map(physical).collect()
}

fn punctual_light(light: &ir::Punctual, index: usize, check: &mut Check<'_>) -> Option<Punctual> {
    let at = place(Noun::Light, index, Field::Whole);
    let ir::Punctual { emitter, intensity } = light;
    let intensity = check.color(*intensity, at);
    let emitter = match emitter {
        ir::Emitter::Sun { direction } => direction_of(*direction, at, check).map(Emitter::Sun),
        ir::Emitter::Point { position, range } => {
            let (position, falloff) = (check.vector(*position, at), falloff(*range, at, check));
            Some(Emitter::Point(position?, falloff?))
        }
        ir::Emitter::Spot {
            position,
            direction,
            inner_angle,
            outer_angle,
            range,
        } => {
            let (position, falloff) = (check.vector(*position, at), falloff(*range, at, check));
            let (direction, cone) = (
                direction_of(*direction, at, check),
                cone(*inner_angle, *outer_angle, at, check),
            );
            let (inner, outer) = cone?;
            Some(Emitter::Spot {
                position: position?,
                direction: direction?,
                inner,
                outer,
                falloff: falloff?,
            })
        }
    };
    Some(Punctual {
        emitter: emitter?,
        intensity: intensity?,
    })
}

fn direction_of(direction: [f64; 3], at: Place, check: &mut Check<'_>) -> Option<Vec3> {
    check
        .direction(direction, "direction of a light", at)
        .and_then(unit)
}

fn falloff(range: Option<f64>, at: Place, check: &mut Check<'_>) -> Option<Falloff> {
    match range {
        Some(range) => check
            .length(range, at, &codes::BAD_LIGHT, "range")
            .map(|range| Falloff::Square(Some(range.get()))),
        None => Some(Falloff::Square(None)),
    }
}

/// The cosines of the angles of a spot light.
fn cone(inner: f64, outer: f64, at: Place, check: &mut Check<'_>) -> Option<(f64, f64)> {
    let sound =
        0.0 <= inner && inner < outer && outer <= std::f64::consts::FRAC_PI_2 * (1.0 + 1e-6);
    if !sound {
        let message =
            format!("a spot light has an inner angle of {inner} and an outer one of {outer}");
        check.report(
            at,
            "",
            Diagnostic::new(&codes::BAD_LIGHT, message).hint("0 ≤ inner < outer ≤ π/2"),
        );
    }
    sound.then(|| (libm::cos(inner), libm::cos(outer)))
}

/// No more notes than this: a file of many lights and spheres is not worth a quadratic search for
/// advice.
const MAX_PAIRS: usize = 1_000_000;

/// Notes each light that stands inside a sphere, where shadows hide it from all outside.
pub(super) fn lights_inside_spheres(scene: &ir::Scene, check: &mut Check<'_>) {
    if !scene.settings.shadows
        || scene.lights.len().saturating_mul(scene.surfaces.len()) > MAX_PAIRS
    {
        return;
    }
    for (index, light) in scene.lights.iter().enumerate() {
        let Some(light) = light.point() else { continue };
        let inside = scene
            .surfaces
            .iter()
            .position(|surface| match &surface.shape {
                ir::Shape::Sphere(ir::Sphere {
                    center,
                    radius,
                    texture_from_world: _,
                }) => {
                    Vec3::from_array(light.position).distance(Vec3::from_array(*center)) < *radius
                }
                ir::Shape::Plane(_)
                | ir::Shape::Triangle(_)
                | ir::Shape::Quad(_)
                | ir::Shape::Disc(_)
                | ir::Shape::Cylinder(_)
                | ir::Shape::Cone(_)
                | ir::Shape::Torus(_)
                | ir::Shape::Instance(_) => false,
            });
        if let Some(sphere) = inside {
            let finding =
                Diagnostic::new(&codes::LIGHT_IN_SPHERE, "a light stands inside a sphere");
            let finding = finding.also(
                check.span(place(Noun::Surface, sphere, Field::Whole)),
                "this sphere",
            );
            check.report(
                place(Noun::Light, index, Field::Position),
                "with shadows on, nothing outside the sphere sees this light",
                finding,
            );
        }
    }
}
