//! The proof of the shapes: radii above 0, directions of nonzero length, faces with an area.

mod area;
mod check;

pub(super) use area::has_area;
pub(super) use check::surface;

use rtc_math::{Positive, Vec3, is_flat};

/// A shape and the index of its material.
#[derive(Clone, Debug)]
pub struct Surface {
    /// The shape.
    pub shape: Shape,
    /// An index into [`super::ValidScene::materials`], in range.
    pub material: usize,
    /// Whether it hides lights from other surfaces and from itself, where shadows are asked for.
    pub casts_shadow: bool,
    /// Its index in the IR. The IR also has the triangles without an area.
    pub index: usize,
}

/// What an enum holds of a shape that is small.
type Inline<T> = T;

/// Declares the proven shapes: those whose values are `derived` in full, of the others the variant.
macro_rules! declare {
    ($($(#[$doc:meta])* $Name:ident $word:ident $Store:ident $how:ident $values:tt)*) => {
        /// A shape of any kind.
        #[derive(Clone, Debug)]
        pub enum Shape {
            $($(#[$doc])* $Name($Store<$Name>),)*
        }

        $(proven!($(#[$doc])* $Name $how $values);)*
    };
}

/// Declares a proven shape.
macro_rules! proven {
    ($(#[$doc:meta])* $Name:ident custom $values:tt) => {};
    ($(#[$doc:meta])* $Name:ident derived {
        $type:literal $($value:ident: $rule:ident $key:literal $($words:literal)?;)*
    }) => {
        $(#[$doc])*
        #[derive(Clone, Copy, Debug)]
        pub struct $Name {
            $(
                #[doc = proven_type!(doc $rule $Name $value)]
                pub $value: proven_type!($rule),
            )*
        }
    };
}

/// The type of a value that is proven by a rule, and its description.
macro_rules! proven_type {
    (point) => { Vec3 };
    (direction) => { Vec3 };
    (step) => { Vec3 };
    (length) => { Positive };
    (doc direction $Name:ident $value:ident) => {
        concat!(proven_type!(doc point $Name $value), ", with its largest component in [1, 2)")
    };
    (doc $rule:ident $Name:ident $value:ident) => {
        concat!("[`", stringify!($value), "`](rtc_ir::", stringify!($Name), "::", stringify!($value), ")")
    };
}

rtc_tables::shapes!(declare);

/// A sphere.
#[derive(Clone, Debug)]
pub struct Sphere {
    /// Its centre.
    pub center: Vec3,
    /// Its radius.
    pub radius: Positive,
    /// The rows of the rotation from directions of the world to those of the texture; none for the
    /// identity.
    pub texture_from_world: Option<Box<[Vec3; 3]>>,
}

/// A triangle whose corners are not in line.
#[derive(Clone, Debug)]
pub struct Triangle {
    /// The corners; the normal is (v1 − v0) × (v2 − v0).
    pub vertices: [Vec3; 3],
    /// The texture coordinates of the corners.
    pub uvs: Option<Box<[[f64; 2]; 3]>>,
}

/// A quadrilateral.
#[derive(Clone, Copy, Debug)]
pub struct Quad {
    /// The corners in order around it.
    pub vertices: [Vec3; 4],
}

impl Quad {
    /// Whether all corners lie in one plane, to within 64 units of rounding.
    #[must_use]
    pub fn is_flat(&self) -> bool {
        is_flat(self.vertices)
    }
}

/// A mesh, placed in the world.
#[derive(Clone, Copy, Debug)]
pub struct Instance {
    /// An index into [`super::ValidScene::meshes`], in range.
    pub mesh: usize,
    /// The images of the three axes, linearly independent, and of the origin.
    pub world_from_object: [Vec3; 4],
}
