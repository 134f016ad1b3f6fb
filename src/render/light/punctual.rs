//! Punctual lights in physical units: delta lights, which BSDF sampling cannot find.

use super::Incident;
use crate::math::Vec3;
use std::f64::consts::PI;

/// A light without extent.
#[derive(Clone, Copy, Debug)]
pub(in crate::render) enum Punctual {
    /// From infinitely far away.
    Directional(DirectionalLight),
    /// From a point into all directions.
    Point(PointLight),
    /// From a point into a cone.
    Spot(SpotLight),
}

/// A light infinitely far away.
#[derive(Clone, Copy, Debug)]
pub(in crate::render) struct DirectionalLight {
    /// The unit vector to it.
    pub(in crate::render) direction: Vec3,
    /// The irradiance of a surface that faces it.
    pub(in crate::render) irradiance: Vec3,
}

/// A point light of equal intensity in all directions.
#[derive(Clone, Copy, Debug)]
pub(in crate::render) struct PointLight {
    /// Where it stands.
    pub(in crate::render) position: Vec3,
    /// The radiant intensity.
    pub(in crate::render) intensity: Vec3,
    pub(in crate::render) falloff: Falloff,
}

/// A point light with a cone.
#[derive(Clone, Copy, Debug)]
pub(in crate::render) struct SpotLight {
    /// The light on the axis of the cone.
    pub(in crate::render) point: PointLight,
    /// The unit axis of the cone, away from the light.
    pub(in crate::render) direction: Vec3,
    /// The cosine of the inner angle: full intensity within it.
    pub(in crate::render) inner: f64,
    /// The cosine of the outer angle: dark beyond it.
    pub(in crate::render) outer: f64,
}

/// The attenuation of light with distance.
#[derive(Clone, Copy, Debug)]
pub(in crate::render) enum Falloff {
    /// No attenuation, as in the course.
    None,
    /// The inverse square of the distance.
    Square,
    /// The inverse square of the distance, windowed to 0 at the range; this is its square.
    Ranged(f64),
}

impl Punctual {
    /// The approximate power that the light sends to a scene whose cross section is `disc`.
    pub(super) fn power(&self, disc: f64) -> f64 {
        match self {
            Self::Directional(sun) => sun.irradiance.max_element() * disc,
            Self::Point(point) => point.power(disc, 4.0 * PI),
            Self::Spot(spot) => spot.point.power(disc, 2.0 * PI * (1.0 - spot.outer)),
        }
    }

    /// The light that a point receives, divided by the probability of choosing this light.
    pub(super) fn sample(&self, from: Vec3, probability: f64) -> Option<Incident> {
        let (wi, place, intensity, strength) = match self {
            Self::Directional(sun) => (sun.direction, None, sun.irradiance, 1.0),
            Self::Point(point) => {
                let (wi, strength) = point.towards(from)?;
                (wi, Some(point.position), point.intensity, strength)
            }
            Self::Spot(SpotLight {
                point,
                direction,
                inner,
                outer,
            }) => {
                let (wi, strength) = point.towards(from)?;
                // KHR_lights_punctual: the square of a ramp between the cosines.
                let ramp = ((-wi.dot(*direction) - outer) / (inner - outer)).clamp(0.0, 1.0);
                let strength = ramp * ramp * strength;
                (wi, Some(point.position), point.intensity, strength)
            }
        };
        let radiance = intensity * (strength / probability);
        (strength > 0.0 && radiance.is_finite()).then_some(Incident {
            wi,
            radiance,
            pdf: None,
            place,
        })
    }
}

impl PointLight {
    /// The approximate power of the light, emitted into a solid angle.
    fn power(&self, disc: f64, solid_angle: f64) -> f64 {
        let weight = match self.falloff {
            // Without attenuation, distance does not matter.
            Falloff::None => disc,
            Falloff::Square | Falloff::Ranged(_) => solid_angle,
        };
        self.intensity.max_element() * weight
    }

    /// The unit vector to the light, and its attenuation.
    fn towards(&self, from: Vec3) -> Option<(Vec3, f64)> {
        let wi = (self.position - from).try_normalize()?;
        Some((
            wi,
            self.falloff
                .attenuation(self.position.distance_squared(from)),
        ))
    }
}

impl Falloff {
    /// The attenuation at a squared distance; the window of a range is that of
    /// `KHR_lights_punctual`.
    fn attenuation(self, distance_squared: f64) -> f64 {
        match self {
            Self::None => 1.0,
            Self::Square => 1.0 / distance_squared,
            Self::Ranged(range_squared) => {
                let fraction = distance_squared / range_squared;
                (1.0 - fraction * fraction).clamp(0.0, 1.0) / distance_squared
            }
        }
    }
}
