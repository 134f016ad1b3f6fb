//! Validates the shapes: radii above 0, directions of nonzero length, faces with an area.

mod area;
mod check;

pub(super) use area::has_area;
pub(super) use check::surface;

use crate::material::MaterialId;
use crate::mesh::MeshId;
use check::{SurfaceCheck, Validate};
use rtc_ir as ir;
use rtc_math::{Positive, SetStep, Vec3, is_flat};

/// A shape and the index of its material.
#[derive(Clone, Debug)]
pub struct Surface {
    /// The shape.
    pub shape: Shape,
    /// Its material.
    pub material: MaterialId,
    /// Whether it casts shadows on other surfaces and on itself, if shadows are on.
    pub casts_shadow: bool,
    /// Its index in the IR, which also has the faces without an area.
    pub index: usize,
    /// How far it moves while the shutter is open, at a constant velocity. The shape is where it is
    /// when the shutter opens.
    pub sweep: Vec3,
}

/// The storage of a small shape in an enum.
type Inline<T> = T;

/// The type of a valid value of each rule of the table, and how such a value changes when the shape
/// is moved.
#[expect(non_camel_case_types, reason = "the words of the table")]
mod rule {
    use rtc_math::{Positive, Vec3};

    pub(super) type point = Vec3;
    /// Its largest component is in [1, 2).
    pub(super) type direction = Vec3;
    pub(super) type step = Vec3;
    pub(super) type length = Positive;

    pub(super) fn point(value: &mut Vec3, by: Vec3) {
        *value += by;
    }

    pub(super) fn direction(_: &mut Vec3, _: Vec3) {}

    pub(super) fn step(_: &mut Vec3, _: Vec3) {}

    pub(super) fn length(_: &mut Positive, _: Vec3) {}
}

/// Declares the valid shapes: the struct of those with `derived` values, and the enum of all. Each
/// is validated by its own `impl`, or by the rules of its row; all values are checked, even after
/// an error.
macro_rules! declare {
    (
        all { $($(#[$doc:meta])* $Name:ident $name:ident $Store:ident $paths:tt;)* }
        derived { $($(#[$about:meta])* $Derived:ident $word:ident {
            $($value:ident: $rule:ident $($words:literal)?;)*
        })* }
    ) => {
        /// A shape of any kind.
        #[derive(Clone, Debug)]
        pub enum Shape {
            $($(#[$doc])* $Name($Store<$Name>),)*
        }

        impl Shape {
            /// The shape, moved by a vector.
            #[must_use]
            pub fn moved(mut self, by: Vec3) -> Self {
                // A sum with 0 would change the sign of a 0.
                if by == Vec3::ZERO {
                    return self;
                }
                match &mut self {
                    $(Self::$Name(shape) => shape.translate(by),)*
                }
                self
            }
        }

        impl Validate for ir::Shape {
            fn validate(&self, surface_check: &mut SurfaceCheck<'_, '_>) -> Option<Option<Shape>> {
                match self {
                    $(Self::$Name(shape) => shape.validate(surface_check),)*
                }
            }
        }

        $(impl $Derived {
            fn translate(&mut self, by: Vec3) {
                $(rule::$rule(&mut self.$value, by);)*
            }
        }

        impl Validate for ir::$Derived {
            fn validate(&self, surface_check: &mut SurfaceCheck<'_, '_>) -> Option<Option<Shape>> {
                let Self { $($value),* } = *self;
                $(let $value =
                    surface_check.$rule($value, stringify!($value), concat!($($words)?));)*
                Some(Some(Shape::$Derived($Derived { $($value: $value?),* })))
            }
        })*

        $(
            $(#[$about])*
            #[derive(Clone, Copy, Debug)]
            pub struct $Derived {
                $(
                    #[doc = concat!("[`", stringify!($value), "`](rtc_ir::", stringify!($Derived), "::",
                        stringify!($value), ")")]
                    pub $value: rule::$rule,
                )*
            }
        )*
    };
}

ir::shapes!(declare);

/// A sphere.
#[derive(Clone, Debug)]
pub struct Sphere {
    /// Its centre.
    pub center: Vec3,
    /// Its radius.
    pub radius: Positive,
    /// The rows of the rotation from world directions to texture directions; `None` for the
    /// identity.
    pub texture_from_world: Option<Box<[Vec3; 3]>>,
}

impl Sphere {
    fn translate(&mut self, by: Vec3) {
        self.center += by;
    }
}

/// A triangle whose corners are not collinear.
#[derive(Clone, Debug)]
pub struct Triangle {
    /// The corners; the normal is (v1 − v0) × (v2 − v0).
    pub vertices: [Vec3; 3],
    /// The texture coordinates of the corners.
    pub uvs: Option<Box<[[f64; 2]; 3]>>,
}

impl Triangle {
    fn translate(&mut self, by: Vec3) {
        self.vertices = self.vertices.map(|vertex| vertex + by);
    }
}

/// A quadrilateral.
#[derive(Clone, Copy, Debug)]
pub struct Quad {
    /// The corners in order around it.
    pub vertices: [Vec3; 4],
}

impl Quad {
    /// Whether all corners are coplanar, to within 64 rounding errors.
    #[must_use]
    pub fn is_flat(&self) -> bool {
        is_flat(self.vertices)
    }

    fn translate(&mut self, by: Vec3) {
        self.vertices = self.vertices.map(|vertex| vertex + by);
    }
}

/// An ellipsoid.
#[derive(Clone, Copy, Debug)]
pub struct Ellipsoid {
    /// Its centre.
    pub center: Vec3,
    /// The images of the axes of the unit sphere, linearly independent.
    pub axes: [Vec3; 3],
}

impl Ellipsoid {
    fn translate(&mut self, by: Vec3) {
        self.center += by;
    }
}

/// A part of the boundary of a CSG solid.
#[derive(Clone, Debug)]
pub struct Csg {
    /// The operands, at most 64, each a solid.
    pub operands: Vec<Shape>,
    /// An expression of them.
    pub steps: Vec<SetStep>,
    /// A bit for each operand whose surface contains this part.
    pub faces: u64,
}

impl Csg {
    fn translate(&mut self, by: Vec3) {
        let operands = std::mem::take(&mut self.operands);
        self.operands = operands
            .into_iter()
            .map(|operand| operand.moved(by))
            .collect();
    }
}

/// A mesh placed in the world.
#[derive(Clone, Copy, Debug)]
pub struct Instance {
    /// The mesh.
    pub mesh: MeshId,
    /// The images of the three axes, linearly independent, and of the origin.
    pub world_from_object: [Vec3; 4],
}

impl Instance {
    fn translate(&mut self, by: Vec3) {
        self.world_from_object[3] += by;
    }
}
