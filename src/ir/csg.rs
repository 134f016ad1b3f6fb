//! CSG solids.

use super::shape::{
    Cone, Cylinder, Ellipsoid, HasBounds, InfiniteCylinder, Paraboloid, Plane, Shape, Sphere, Torus,
};
use arbitrary::Arbitrary;
use rtc_math::{SetStep, Vec3};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Declares the solids: the shapes that have an inside.
macro_rules! solids {
    ($($(#[$doc:meta])* $Name:ident)+) => {
        /// An operand of a CSG solid: a shape with an inside.
        #[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema, Arbitrary)]
        #[serde(rename_all = "camelCase", deny_unknown_fields)]
        pub enum Solid {
            $($(#[$doc])* $Name($Name),)+
        }

        impl Solid {
            /// The solid that a shape is; `None` for one without an inside.
            #[must_use]
            pub fn of(shape: Shape) -> Option<Self> {
                match shape {
                    $(Shape::$Name(shape) => Some(Self::$Name(shape)),)+
                    _ => None,
                }
            }

            /// The shape of its surface.
            #[must_use]
            pub fn shape(&self) -> Shape {
                match self {
                    $(Self::$Name(shape) => Shape::$Name(shape.clone()),)+
                }
            }
        }
    };
}

solids! {
    /// A sphere.
    Sphere
    /// The half-space behind a plane, away from its normal.
    Plane
    /// A cylinder with two caps.
    Cylinder
    /// A cone with a cap at its base.
    Cone
    /// A paraboloid with a cap at its base.
    Paraboloid
    /// A torus.
    Torus
    /// An ellipsoid.
    Ellipsoid
    /// A cylinder without ends.
    InfiniteCylinder
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
