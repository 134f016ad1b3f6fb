//! The lights.

use arbitrary::Arbitrary;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A light of any kind.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema, Arbitrary)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
pub enum Light {
    /// A point or sphere that shines equally in all directions, without falloff.
    Point(PointLight),
    /// A light in physical units.
    Punctual(Punctual),
}

impl Light {
    /// The light, if it is one of the course.
    #[must_use]
    pub fn point(&self) -> Option<&PointLight> {
        match self {
            Self::Point(light) => Some(light),
            Self::Punctual(_) => None,
        }
    }
}

/// A light without extent, in physical units.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema, Arbitrary)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
pub struct Punctual {
    /// How and from where it shines.
    pub emitter: Emitter,
    /// Linear Rec. 709: of a sun the irradiance on a surface that faces it, of the others the
    /// radiant intensity (power per steradian); each channel at least 0.
    #[schemars(inner(range(min = 0.0)))]
    pub intensity: [f64; 3],
}

/// How a light without extent shines.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema, Arbitrary)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
pub enum Emitter {
    /// From infinitely far away.
    Sun {
        /// The direction from the scene to it, of any length but 0.
        direction: [f64; 3],
    },
    /// From a point into all directions.
    #[serde(rename_all = "camelCase")]
    Point {
        /// Where it stands.
        position: [f64; 3],
        /// Beyond this distance it is dark, by the falloff of `KHR_lights_punctual`; none for
        /// infinite.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        range: Option<f64>,
    },
    /// From a point into a cone.
    #[serde(rename_all = "camelCase")]
    Spot {
        /// Where it stands.
        position: [f64; 3],
        /// Where it shines, of any length but 0.
        direction: [f64; 3],
        /// Within this angle from the direction it shines fully, in radians.
        inner_angle: f64,
        /// Beyond this angle it is dark, in radians, at most π/2.
        outer_angle: f64,
        /// As of a point.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        range: Option<f64>,
    },
}

/// A point light, or with a radius the sphere around it: then shadows have soft edges. It is no
/// surface, so no ray sees or hits it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema, Arbitrary)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
pub struct PointLight {
    /// Where it stands.
    pub position: [f64; 3],
    /// Its colour, each channel at least 0; more than 1 is allowed.
    #[schemars(inner(range(min = 0.0)))]
    pub color: [f64; 3],
    /// Its radius, at least 0; 0 is a point.
    #[serde(default, skip_serializing_if = "is_zero")]
    #[schemars(range(min = 0.0))]
    pub radius: f64,
}

#[expect(
    clippy::trivially_copy_pass_by_ref,
    reason = "serde hands over a reference"
)]
fn is_zero(radius: &f64) -> bool {
    radius.to_bits() == 0
}
