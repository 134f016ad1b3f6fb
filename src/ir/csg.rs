//! CSG solids.

use super::shape::{
    Cone, Cylinder, Ellipsoid, HasBounds, InfiniteCylinder, Paraboloid, Plane, Shape, Sphere, Torus,
};
use arbitrary::Arbitrary;
use rtc_math::{SetStep, Vec3};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// An operand of a CSG solid: a shape with an inside.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema, Arbitrary)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
pub enum Solid {
    /// A sphere.
    Sphere(Sphere),
    /// The half-space behind a plane, away from its normal.
    Plane(Plane),
    /// A cylinder with two caps.
    Cylinder(Cylinder),
    /// A cone with a cap at its base.
    Cone(Cone),
    /// A paraboloid with a cap at its base.
    Paraboloid(Paraboloid),
    /// A torus.
    Torus(Torus),
    /// An ellipsoid.
    Ellipsoid(Ellipsoid),
    /// A cylinder without ends.
    InfiniteCylinder(InfiniteCylinder),
}

impl Solid {
    /// The solid that a shape is; `None` for one without an inside.
    #[must_use]
    pub fn of(shape: Shape) -> Option<Self> {
        match shape {
            Shape::Sphere(shape) => Some(Self::Sphere(shape)),
            Shape::Plane(shape) => Some(Self::Plane(shape)),
            Shape::Cylinder(shape) => Some(Self::Cylinder(shape)),
            Shape::Cone(shape) => Some(Self::Cone(shape)),
            Shape::Paraboloid(shape) => Some(Self::Paraboloid(shape)),
            Shape::Torus(shape) => Some(Self::Torus(shape)),
            Shape::Ellipsoid(shape) => Some(Self::Ellipsoid(shape)),
            Shape::InfiniteCylinder(shape) => Some(Self::InfiniteCylinder(shape)),
            Shape::Triangle(_)
            | Shape::Quad(_)
            | Shape::Disc(_)
            | Shape::Instance(_)
            | Shape::Csg(_) => None,
        }
    }

    /// The shape of its surface.
    #[must_use]
    pub fn shape(&self) -> Shape {
        match self.clone() {
            Self::Sphere(shape) => Shape::Sphere(shape),
            Self::Plane(shape) => Shape::Plane(shape),
            Self::Cylinder(shape) => Shape::Cylinder(shape),
            Self::Cone(shape) => Shape::Cone(shape),
            Self::Paraboloid(shape) => Shape::Paraboloid(shape),
            Self::Torus(shape) => Shape::Torus(shape),
            Self::Ellipsoid(shape) => Shape::Ellipsoid(shape),
            Self::InfiniteCylinder(shape) => Shape::InfiniteCylinder(shape),
        }
    }
}

/// A part of the boundary of a CSG solid: the part that lies on some of its operands. Parts of
/// different materials are separate surfaces that differ only in `faces`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema, Arbitrary)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
pub struct Csg {
    /// The operands, 1 to 64.
    pub operands: Vec<Solid>,
    /// The operations over them in postfix order; `operand` takes the next one.
    pub steps: Vec<SetStep>,
    /// The indices of the operands on which this part of the boundary lies.
    pub faces: Vec<u32>,
}

impl Csg {
    /// Whether both are parts of one solid.
    #[must_use]
    pub fn is_of_one_solid(&self, other: &Self) -> bool {
        self.operands == other.operands && self.steps == other.steps
    }
}

impl HasBounds for Csg {
    /// The bounds of its operands; infinite ones are empty.
    fn visit_bounds(&self, meshes: &[[Vec3; 2]], visit: &mut dyn FnMut(Vec3, f64)) {
        let Self {
            operands,
            steps: _,
            faces: _,
        } = self;
        for operand in operands {
            operand.shape().bounded().visit_bounds(meshes, visit);
        }
    }
}
