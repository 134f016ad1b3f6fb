//! The shapes, and the surfaces that clothe them.

use super::{MaterialId, MeshId};
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
    /// A quadrilateral.
    Quad(Quad),
    /// A disc.
    Disc(Disc),
    /// A cylinder with two caps.
    Cylinder(Cylinder),
    /// A cone with a cap at its base.
    Cone(Cone),
    /// A torus.
    Torus(Torus),
    /// A mesh, placed.
    Instance(Instance),
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
    /// The rows of the rotation that takes directions of the world to those of the texture, whose
    /// poles are ±z; none for the identity. u = φ/2π with φ = atan2(y, x) in [0, 2π), v = 1 −
    /// θ/π with θ = acos(z).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub texture_from_world: Option<[[f64; 3]; 3]>,
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
    /// The texture coordinates of the corners.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub uvs: Option<[[f64; 2]; 3]>,
}

/// A quadrilateral, seen from both sides: flat if its corners are in a plane, else the bilinear
/// patch between them.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema, Arbitrary)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
pub struct Quad {
    /// The corners in order around it, with uv (0, 0), (1, 0), (1, 1), (0, 1).
    pub vertices: [[f64; 3]; 4],
}

/// A disc, seen from both sides.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema, Arbitrary)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
pub struct Disc {
    /// Its centre.
    pub center: [f64; 3],
    /// Its normal, of any length but 0.
    pub normal: [f64; 3],
    /// Its radius, above 0.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub radius: f64,
}

/// A cylinder with two caps.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema, Arbitrary)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
pub struct Cylinder {
    /// The centre of its base.
    pub base: [f64; 3],
    /// The direction from the base to the top, of any length but 0.
    pub axis: [f64; 3],
    /// From base to top, above 0.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub height: f64,
    /// Its radius, above 0.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub radius: f64,
}

/// A cone with a cap at its base.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema, Arbitrary)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
pub struct Cone {
    /// The centre of its base.
    pub base: [f64; 3],
    /// From the centre of the base to the apex.
    pub up: [f64; 3],
    /// The radius of the base, above 0.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub radius: f64,
}

/// A torus.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema, Arbitrary)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
pub struct Torus {
    /// Its centre.
    pub center: [f64; 3],
    /// The direction of its axis, of any length but 0.
    pub axis: [f64; 3],
    /// From the centre to the middle of the tube, above 0.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub major: f64,
    /// The radius of the tube, above 0.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub minor: f64,
}

/// A mesh, placed in the world.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema, Arbitrary)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
pub struct Instance {
    /// Which mesh.
    pub mesh: MeshId,
    /// The columns of the affine map from object to world: the images of the three axes, and the
    /// origin's.
    pub world_from_object: [[f64; 3]; 4],
}
