//! Validates the lights.

use super::check::{Checker, EntityCounts};
use super::texture::{self, Map};
use rtc_diag::Diagnostic;
use rtc_diag::codes;
use rtc_ir::{self as ir, EntityField, EntityKind, ValuePath};
use rtc_math::{Id, NonNegative, Positive, Vec3, unit};
use rtc_profile::LightProfile;

/// The id of a physical light, in the order of the scene.
pub type PunctualId = Id<Punctual>;

/// The id of a light of the course among those of a [`ValidScene`](crate::ValidScene).
pub type CourseLightId = Id<CourseLight>;

/// A light of any kind.
#[derive(Clone, Debug)]
pub enum Light {
    /// A light of the course, in display values.
    Course(CourseLight),
    /// A light in physical units.
    Punctual(Punctual),
}

/// A point light without falloff, equal in all directions; a spherical light if it has a radius.
#[derive(Clone, Copy, Debug)]
pub struct CourseLight {
    /// The position.
    pub position: Vec3,
    /// The intensity, linear RGB, each channel at least 0.
    pub color: Vec3,
    /// The radius; 0 for a point.
    pub radius: NonNegative,
}

/// A light without extent, in physical units.
#[derive(Clone, Debug)]
pub enum Punctual {
    /// A directional light.
    Directional(DirectionalLight),
    /// A point light.
    Point(PointLight),
}

/// A light infinitely far away.
#[derive(Clone, Copy, Debug)]
pub struct DirectionalLight {
    /// The unit vector to the light.
    pub direction: Vec3,
    /// The irradiance on a surface that faces it, each channel at least 0.
    pub irradiance: Vec3,
}

/// A point light with an angular distribution.
#[derive(Clone, Debug)]
pub struct PointLight {
    /// The position.
    pub position: Vec3,
    /// The radiant intensity, each channel at least 0; the profile multiplies it.
    pub intensity: Vec3,
    /// The angular distribution of the intensity.
    pub profile: LightProfile,
    /// The falloff.
    pub falloff: Falloff,
    /// The texture that it projects.
    pub projected: Option<Box<ProjectedTexture>>,
}

/// The texture that a light projects; black outside of its unit square.
#[derive(Clone, Debug)]
pub struct ProjectedTexture {
    /// The texture.
    pub map: Map,
    /// The rows that map a direction from the light to (u·w, v·w, w), with w above 0.
    pub uv_from_direction: [Vec3; 3],
    /// The unit vector of the axis, if the colours are the irradiance on a plane across it at the
    /// distance 1, and not factors of the intensity.
    pub irradiance_axis: Option<Vec3>,
}

/// The falloff of the irradiance with the distance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Falloff {
    /// Not at all, as in the course.
    None,
    /// It falls with the square of the distance.
    Square,
    /// It falls with the square of the distance, and to zero at a range.
    Ranged(Positive),
}

pub(super) fn light(
    light: &ir::Light,
    index: usize,
    counts: &EntityCounts,
    check: &mut Checker<'_>,
) -> Option<Light> {
    match light {
        ir::Light::Point(light) => course(light, index, check).map(Light::Course),
        ir::Light::Punctual(light) => punctual(light, index, counts, check).map(Light::Punctual),
    }
}

fn course(light: &ir::PointLight, index: usize, check: &mut Checker<'_>) -> Option<CourseLight> {
    let ir::PointLight {
        position,
        color,
        radius,
    } = light;
    let at = |field| ValuePath::new(EntityKind::Light, index, field);
    let position = check.vector(*position, at(EntityField::Position));
    let color = check.color(*color, at(EntityField::Color));
    let radius = check.non_negative(*radius, "radius", at(EntityField::LightRadius));
    Some(CourseLight {
        position: position?,
        color: color?,
        radius: radius?,
    })
}

fn punctual(
    light: &ir::Punctual,
    index: usize,
    counts: &EntityCounts,
    check: &mut Checker<'_>,
) -> Option<Punctual> {
    let at = ValuePath::new(EntityKind::Light, index, EntityField::Whole);
    let ir::Punctual {
        emitter,
        intensity,
        projected,
    } = light;
    let of_intensity = ValuePath::new(EntityKind::Light, index, EntityField::Intensity);
    let intensity = check.color(*intensity, of_intensity);
    let projected = check.optional(projected.as_deref(), |check, projected| {
        projected_texture(projected, counts, at, check)
    });
    let located = emitter.position().map(|position| {
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
    let Some((position, falloff)) = located else {
        return Some(Punctual::Directional(DirectionalLight {
            direction: direction??,
            irradiance: intensity?,
        }));
    };
    let reject = |find_error| check.report(at, "", Diagnostic::new(&codes::BAD_LIGHT, find_error));
    let profile = emitter.profile().map_err(reject).ok();
    Some(Punctual::Point(PointLight {
        position: position?,
        intensity: intensity?,
        profile: profile?,
        falloff: falloff?,
        projected: projected?.map(Box::new),
    }))
}

fn projected_texture(
    projected: &ir::ProjectedTexture,
    counts: &EntityCounts,
    at: ValuePath,
    check: &mut Checker<'_>,
) -> Option<ProjectedTexture> {
    let ir::ProjectedTexture {
        map,
        uv_from_direction,
        is_irradiance,
    } = projected;
    let map = texture::map(map, counts, at, check);
    let [u, v, w] = uv_from_direction.map(|row| check.vector(row, at));
    let axis = w.and_then(unit);
    if w.is_some() && axis.is_none() {
        let message = "the texture of a light is projected in no direction";
        check.report(at, "", Diagnostic::new(&codes::BAD_LIGHT, message));
    }
    Some(ProjectedTexture {
        map: map?,
        uv_from_direction: [u?, v?, w?],
        irradiance_axis: Some(axis?).filter(|_| *is_irradiance),
    })
}

fn falloff(range: Option<f64>, at: ValuePath, check: &mut Checker<'_>) -> Option<Falloff> {
    match range {
        Some(range) => check
            .length(range, at, &codes::BAD_LIGHT, "range")
            .map(Falloff::Ranged),
        None => Some(Falloff::Square),
    }
}
