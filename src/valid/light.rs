//! The proof of the lights.

use super::check::{Check, place};
use rtc_diag::Diagnostic;
use rtc_diag::codes;
use rtc_ir::{self as ir, EntityKind, Field, ValuePath};
use rtc_math::{NonNegative, Positive, Vec3, unit};
use rtc_profile::Profile;

/// A light of any kind.
#[derive(Clone, Debug)]
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
#[derive(Clone, Debug)]
pub enum Punctual {
    /// From infinitely far away.
    Directional(DirectionalLight),
    /// From a point.
    Point(PointLight),
}

/// A light infinitely far away.
#[derive(Clone, Copy, Debug)]
pub struct DirectionalLight {
    /// The unit vector to it.
    pub direction: Vec3,
    /// The irradiance on a surface that faces it, each channel at least 0.
    pub irradiance: Vec3,
}

/// A point that shines.
#[derive(Clone, Debug)]
pub struct PointLight {
    /// Where it stands.
    pub position: Vec3,
    /// The radiant intensity, each channel at least 0, by how much of it goes in a direction.
    pub intensity: Vec3,
    /// How much of the intensity goes in which direction.
    pub profile: Profile,
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
    let at = |field| place(EntityKind::Light, index, field);
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
    let at = place(EntityKind::Light, index, Field::Whole);
    let ir::Punctual { emitter, intensity } = light;
    let intensity = check.color(*intensity, at);
    let place = emitter.position().map(|position| {
        (
            check.vector(position, at),
            falloff(emitter.range(), at, check),
        )
    });
    let direction = emitter.direction().map(|direction| {
        check
            .direction(direction, "direction of a light", at)
            .and_then(unit)
    });
    if direction == Some(None) {
        return None;
    }
    let Some((position, falloff)) = place else {
        return Some(Punctual::Directional(DirectionalLight {
            direction: direction??,
            irradiance: intensity?,
        }));
    };
    let refuse = |fault| check.report(at, "", Diagnostic::new(&codes::BAD_LIGHT, fault));
    let profile = emitter.profile().map_err(refuse).ok();
    Some(Punctual::Point(PointLight {
        position: position?,
        intensity: intensity?,
        profile: profile?,
        falloff: falloff?,
    }))
}

fn falloff(range: Option<f64>, at: ValuePath, check: &mut Check<'_>) -> Option<Falloff> {
    match range {
        Some(range) => check
            .length(range, at, &codes::BAD_LIGHT, "range")
            .map(Falloff::Ranged),
        None => Some(Falloff::Square),
    }
}
