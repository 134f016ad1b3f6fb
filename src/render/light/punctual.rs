//! Lights without extent, in physical units: nothing but aiming finds them.

use super::Incident;
use crate::math::Vec3;
use std::f64::consts::PI;

/// A light without extent.
#[derive(Clone, Copy, Debug)]
pub(in crate::render) enum Punctual {
    /// From infinitely far away.
    Sun(SunLight),
    /// From a point into all directions.
    Point(PointLight),
    /// From a point into a cone.
    Spot(SpotLight),
}

/// A light infinitely far away.
#[derive(Clone, Copy, Debug)]
pub(in crate::render) struct SunLight {
    /// The unit vector to it.
    pub(in crate::render) direction: Vec3,
    /// On a surface that faces it.
    pub(in crate::render) irradiance: Vec3,
}

/// A point that shines equally in all directions.
#[derive(Clone, Copy, Debug)]
pub(in crate::render) struct PointLight {
    /// Where it stands.
    pub(in crate::render) position: Vec3,
    /// The radiant intensity.
    pub(in crate::render) intensity: Vec3,
    pub(in crate::render) falloff: Falloff,
}

/// A point that shines into a cone.
#[derive(Clone, Copy, Debug)]
pub(in crate::render) struct SpotLight {
    /// As if it shone equally in all directions.
    pub(in crate::render) point: PointLight,
    /// The unit vector to where it shines.
    pub(in crate::render) direction: Vec3,
    /// Within this cosine it shines fully.
    pub(in crate::render) inner: f64,
    /// Beyond this cosine it is dark.
    pub(in crate::render) outer: f64,
}

/// How light fades with distance.
#[derive(Clone, Copy, Debug)]
pub(in crate::render) enum Falloff {
    /// Not at all, as in the course.
    None,
    /// With the square of the distance.
    Square,
    /// With the square of the distance, and to nothing at the range whose square this is.
    Ranged(f64),
}

impl Punctual {
    /// About the power it sends to a scene whose silhouette is `disc`.
    pub(super) fn power(&self, disc: f64) -> f64 {
        match self {
            Self::Sun(sun) => sun.irradiance.max_element() * disc,
            Self::Point(point) => point.power(disc, 4.0 * PI),
            Self::Spot(spot) => spot.point.power(disc, 2.0 * PI * (1.0 - spot.outer)),
        }
    }

    /// What a point receives, if the light is chosen with the probability given.
    pub(super) fn sample(&self, from: Vec3, probability: f64) -> Option<Incident> {
        let (wi, place, intensity, strength) = match self {
            Self::Sun(sun) => (sun.direction, None, sun.irradiance, 1.0),
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
    /// About the power it sends, if it shines into a solid angle.
    fn power(&self, disc: f64, solid_angle: f64) -> f64 {
        let weight = match self.falloff {
            // Without falloff it is as strong everywhere.
            Falloff::None => disc,
            Falloff::Square | Falloff::Ranged(_) => solid_angle,
        };
        self.intensity.max_element() * weight
    }

    /// The unit vector to it, and how much of it is left.
    fn towards(&self, from: Vec3) -> Option<(Vec3, f64)> {
        let wi = (self.position - from).try_normalize()?;
        Some((wi, self.falloff.left(self.position.distance_squared(from))))
    }
}

impl Falloff {
    /// What is left of light, by the square of the distance; with a range as `KHR_lights_punctual`
    /// recommends.
    fn left(self, distance_squared: f64) -> f64 {
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
