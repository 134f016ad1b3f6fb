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
}

/// A point light, or with a radius the sphere around it: then shadows have soft edges. It is no surface, so no ray
/// sees or hits it.
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

#[expect(clippy::trivially_copy_pass_by_ref, reason = "serde hands over a reference")]
fn is_zero(radius: &f64) -> bool {
    radius.to_bits() == 0
}
