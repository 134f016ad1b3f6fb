//! Punctual lights in physical units. They are delta lights, which BSDF sampling cannot hit.

use super::IncidentLight;
use crate::texture::sampled::{Map, UvSets};
use rtc_math::Vec3;
use rtc_profile::LightProfile;

/// A light without extent.
#[derive(Clone, Debug)]
pub(crate) enum Punctual {
    /// From infinitely far away.
    Directional(DirectionalLight),
    /// From a point.
    Point(PointLight),
}

/// A light infinitely far away.
#[derive(Clone, Copy, Debug)]
pub(crate) struct DirectionalLight {
    /// The unit vector to it.
    pub(crate) direction: Vec3,
    /// The irradiance of a surface that faces it.
    pub(crate) irradiance: Vec3,
}

/// A point light.
#[derive(Clone, Debug)]
pub(crate) struct PointLight {
    /// Its position.
    pub(crate) position: Vec3,
    /// The radiant intensity, by the factors of the profile.
    pub(crate) intensity: Vec3,
    pub(crate) profile: LightProfile,
    pub(crate) falloff: Falloff,
    pub(crate) projected: Option<Box<ProjectedTexture>>,
}

/// The texture that a light projects; black outside of its unit square.
#[derive(Clone, Debug)]
pub(crate) struct ProjectedTexture {
    pub(crate) map: Map,
    /// The rows that map a direction from the light to (u·w, v·w, w), with w above 0.
    pub(crate) uv_from_direction: [Vec3; 3],
    /// The axis, if the colours are the irradiance on a plane across it at the distance 1.
    pub(crate) irradiance_axis: Option<Vec3>,
}

/// The attenuation of light with distance.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Falloff {
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
            Self::Point(point) => point.power(disc),
        }
    }

    /// The position of the light, if its strength falls with the square of the distance.
    pub(super) fn place_of_falloff(&self) -> Option<Vec3> {
        match self {
            Self::Point(point) if !matches!(point.falloff, Falloff::None) => Some(point.position),
            Self::Point(_) | Self::Directional(_) => None,
        }
    }

    /// The light that a point receives, divided by the probability of choosing this light.
    pub(super) fn sample(&self, from: Vec3, probability: f64) -> Option<IncidentLight> {
        let (wi, place, intensity, strength) = match self {
            Self::Directional(sun) => (sun.direction, None, sun.irradiance, 1.0),
            Self::Point(point) => {
                let (wi, strength) = point.towards(from)?;
                let projected = point.projected.as_ref();
                let factor = projected.map_or(Vec3::ONE, |texture| texture.factor(-wi, from));
                (wi, Some(point.position), point.intensity * factor, strength)
            }
        };
        let radiance = intensity * (strength / probability);
        let is_lit = strength > 0.0 && radiance.max_element() > 0.0;
        (is_lit && radiance.is_finite()).then_some(IncidentLight {
            wi,
            radiance,
            pdf: None,
            place,
        })
    }
}

impl PointLight {
    /// The approximate power of the light.
    fn power(&self, disc: f64) -> f64 {
        let weight = match self.falloff {
            // Without attenuation, distance does not matter.
            Falloff::None => disc,
            Falloff::Square | Falloff::Ranged(_) => self.profile.solid_angle(),
        };
        self.intensity.max_element() * weight
    }

    /// The unit vector to the light, and the fraction of its intensity that arrives.
    fn towards(&self, from: Vec3) -> Option<(Vec3, f64)> {
        let wi = (self.position - from).try_normalize()?;
        let attenuation = self
            .falloff
            .attenuation(self.position.distance_squared(from));
        Some((wi, self.profile.factor(-wi) * attenuation))
    }
}

impl ProjectedTexture {
    /// The factor of the intensity in a direction from the light, a unit vector, to a point.
    fn factor(&self, direction: Vec3, point: Vec3) -> Vec3 {
        // Find the texture coordinates; behind the light and outside of the texture it is dark.
        let [u, v, w] = self.uv_from_direction.map(|row| row.dot(direction));
        let uv = [u / w, v / w];
        if w <= 0.0 || !uv.iter().all(|at| (0.0..=1.0).contains(at)) {
            return Vec3::ZERO;
        }
        let uvs = UvSets::new([Some(uv), None], point);
        let color = self.map.look_up(&uvs).unwrap_or([0.0; 4]);
        let color = Vec3::new(color[0], color[1], color[2]);
        // A plane across the axis has the irradiance I·cos³ at the distance 1.
        self.irradiance_axis.map_or(color, |axis| {
            let cosine = axis.dot(direction);
            color / (cosine * cosine * cosine)
        })
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
