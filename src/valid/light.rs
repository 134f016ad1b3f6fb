//! The proof of the lights.

use super::check::{Check, place};
use crate::diag::Diagnostic;
use crate::diag::codes;
use crate::ir::{self, Field, Noun, Place};
use crate::math::{NonNegative, Positive, Vec3, unit};

/// A light of any kind.
#[derive(Clone, Copy, Debug)]
pub enum Light {
    /// A light of the course, in units of the display.
    Course(CourseLight),
    /// A light in physical units.
    Punctual(Punctual),
}

/// A point light without falloff, equal in all directions; a soft light if it has a radius.
#[derive(Clone, Copy, Debug)]
pub struct CourseLight {
    /// Where it stands.
    pub position: Vec3,
    /// Its colour, each channel at least 0.
    pub color: Vec3,
    /// Its radius; 0 for a point.
    pub radius: NonNegative,
}

/// A light without extent, in physical units.
#[derive(Clone, Copy, Debug)]
pub enum Punctual {
    /// From infinitely far away.
    Directional(DirectionalLight),
    /// From a point into all directions.
    Point(PointLight),
    /// From a point into a cone.
    Spot(SpotLight),
}

/// A light infinitely far away.
#[derive(Clone, Copy, Debug)]
pub struct DirectionalLight {
    /// The unit vector to it.
    pub direction: Vec3,
    /// The irradiance on a surface that faces it, each channel at least 0.
    pub irradiance: Vec3,
}

/// A point that shines equally in all directions.
#[derive(Clone, Copy, Debug)]
pub struct PointLight {
    /// Where it stands.
    pub position: Vec3,
    /// The radiant intensity, each channel at least 0.
    pub intensity: Vec3,
    /// The falloff.
    pub falloff: Falloff,
}

/// A point that shines into a cone.
#[derive(Clone, Copy, Debug)]
pub struct SpotLight {
    /// Where it stands.
    pub position: Vec3,
    /// The unit vector to where it shines.
    pub direction: Vec3,
    /// The cosine of the inner angle: full intensity inside it.
    pub inner: f64,
    /// The cosine of the outer angle, less than that of the inner one: no light outside it.
    pub outer: f64,
    /// The radiant intensity in its direction, each channel at least 0.
    pub intensity: Vec3,
    /// The falloff.
    pub falloff: Falloff,
}

/// How light fades with distance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Falloff {
    /// Not at all, as in the course.
    None,
    /// With the square of the distance.
    Square,
    /// With the square of the distance, down to zero at a range.
    Ranged(Positive),
}

pub(super) fn light(light: &ir::Light, index: usize, check: &mut Check<'_>) -> Option<Light> {
    match light {
        ir::Light::Point(light) => course(light, index, check).map(Light::Course),
        ir::Light::Punctual(light) => punctual(light, index, check).map(Light::Punctual),
    }
}

fn course(light: &ir::PointLight, index: usize, check: &mut Check<'_>) -> Option<CourseLight> {
    let ir::PointLight {
        position,
        color,
        radius,
    } = light;
    let at = |field| place(Noun::Light, index, field);
    let position = check.vector(*position, at(Field::Position));
    let color = check.color(*color, at(Field::Color));
    let radius = check.non_negative(*radius, "radius", at(Field::LightRadius));
    Some(CourseLight {
        position: position?,
        color: color?,
        radius: radius?,
    })
}

fn punctual(light: &ir::Punctual, index: usize, check: &mut Check<'_>) -> Option<Punctual> {
    let at = place(Noun::Light, index, Field::Whole);
    let ir::Punctual { emitter, intensity } = light;
    let intensity = check.color(*intensity, at);
    match emitter {
        ir::Emitter::Sun { direction } => {
            let direction = direction_of(*direction, at, check);
            Some(Punctual::Directional(DirectionalLight {
                direction: direction?,
                irradiance: intensity?,
            }))
        }
        ir::Emitter::Point { position, range } => {
            let (position, falloff) = (check.vector(*position, at), falloff(*range, at, check));
            Some(Punctual::Point(PointLight {
                position: position?,
                intensity: intensity?,
                falloff: falloff?,
            }))
        }
        ir::Emitter::Spot {
            position,
            direction,
            inner_angle,
            outer_angle,
            range,
        } => {
            let (position, falloff) = (check.vector(*position, at), falloff(*range, at, check));
            let direction = direction_of(*direction, at, check);
            let (inner, outer) = cone(*inner_angle, *outer_angle, at, check)?;
            Some(Punctual::Spot(SpotLight {
                position: position?,
                direction: direction?,
                inner,
                outer,
                intensity: intensity?,
                falloff: falloff?,
            }))
        }
    }
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
            .map(Falloff::Ranged),
        None => Some(Falloff::Square),
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

/// The limit on lights times spheres: beyond it the quadratic search for notes is left out.
const MAX_PAIRS: usize = 1_000_000;

/// Notes each light inside a sphere: with shadows the sphere hides it from everything outside.
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
            .position(|surface| holds(&surface.shape, light.position));
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

/// Whether a point lies inside a sphere; other shapes are not asked.
fn holds(shape: &ir::Shape, point: [f64; 3]) -> bool {
    let ir::Shape::Sphere(ir::Sphere {
        center,
        radius,
        texture_from_world: _,
    }) = shape
    else {
        return false;
    };
    Vec3::from_array(point).distance(Vec3::from_array(*center)) < *radius
}
