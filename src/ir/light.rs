//! The lights.

use arbitrary::Arbitrary;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A light of any kind.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema, Arbitrary)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
pub enum Light {
    /// A point that shines equally in all directions, without falloff.
    Point(PointLight),
}

/// A point light.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema, Arbitrary)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
pub struct PointLight {
    /// Where it stands.
    pub position: [f64; 3],
    /// Its colour, each channel at least 0; more than 1 is allowed.
    #[schemars(inner(range(min = 0.0)))]
    pub color: [f64; 3],
}
