//! The shapes, and the surfaces that clothe them.

use super::MaterialId;
use arbitrary::Arbitrary;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A shape with a material.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema, Arbitrary)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
pub struct Surface {
    /// Its form and place.
    pub shape: Shape,
    /// What it is made of.
    pub material: MaterialId,
}

/// A shape of any kind, in world coordinates.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema, Arbitrary)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
pub enum Shape {
    /// A sphere.
    Sphere(Sphere),
    /// An infinite plane.
    Plane(Plane),
    /// A triangle.
    Triangle(Triangle),
}

/// A sphere.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema, Arbitrary)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
pub struct Sphere {
    /// Its centre.
    pub center: [f64; 3],
    /// Its radius, above 0.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub radius: f64,
}

/// An infinite plane.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema, Arbitrary)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
pub struct Plane {
    /// A point of the plane.
    pub center: [f64; 3],
    /// Its normal, of any length but 0.
    pub normal: [f64; 3],
}

/// A triangle, seen from both sides.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema, Arbitrary)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
pub struct Triangle {
    /// The corners v0, v1, v2; the normal is (v1 − v0) × (v2 − v0).
    pub vertices: [[f64; 3]; 3],
}
