//! Shapes.
//!
//! Each shape is one row of [`shapes!`](crate::shapes), from which the enums here, the types of the
//! validator and the constructors of the library come. The other stages match the enums. Code that
//! concerns one shape only is in the file of that shape, or in one `impl`.

use super::bounds::box_corners;
use super::csg::Csg;
use super::standard::is_default;
use super::{MaterialId, MeshId};
use arbitrary::Arbitrary;
use glam::DAffine3;
use rtc_math::{Bounds, Vec3, unit};
use rtc_tables::camel_case;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Calls a macro with the table of shapes; all types and constructors follow its order.
///
/// A row holds the type, its name in snake case (the key in the IR is that in camel case), how
/// enums store it, and its values in one of two ways:
/// - `derived { value: rule "words"; … }`: a rule defines how each value is validated. The rules
///   are `point`; `direction`, of any length but 0; `step`, a direction with a length; `length`,
///   above 0. The words name the value in a diagnostic.
/// - `custom { "value" … }`: the paths to the values in the IR; the validator has an `impl` for the
///   shape.
///
/// The macro is given all rows, with the paths to their values, and once more the `derived` ones:
/// `all { Type name Store ["value", …]; … } derived { Type name { value: …; … } … }`.
#[macro_export]
macro_rules! shapes {
    (@sorted $stage:ident [$($all:tt)*] [$($derived:tt)*]) => {
        $stage! { all { $($all)* } derived { $($derived)* } }
    };
    (@sorted $stage:ident [$($all:tt)*] [$($derived:tt)*]
        $(#[$doc:meta])* $Name:ident $name:ident $Store:ident custom { $($value:literal)* }
        $($rows:tt)*
    ) => {
        $crate::shapes! { @sorted $stage
            [$($all)* $(#[$doc])* $Name $name $Store [$($value),*];] [$($derived)*] $($rows)*
        }
    };
    (@sorted $stage:ident [$($all:tt)*] [$($derived:tt)*]
        $(#[$doc:meta])* $Name:ident $name:ident $Store:ident derived {
            $($value:ident: $rule:ident $($words:literal)?;)*
        }
        $($rows:tt)*
    ) => {
        $crate::shapes! { @sorted $stage
            [$($all)* $(#[$doc])* $Name $name $Store [$(stringify!($value)),*];]
            [$($derived)* $(#[$doc])* $Name $name {
                $($value: $rule $($words)?;)*
            }]
            $($rows)*
        }
    };
    ($stage:ident) => {
        $crate::shapes! { @sorted $stage [] []
            /// A sphere.
            Sphere sphere Inline custom { "center" "radius" }
            /// An infinite plane.
            Plane plane Inline derived {
                center: point;
                normal: direction "normal of a plane";
            }
            /// A triangle.
            Triangle triangle Inline custom { "vertices/0" "vertices/1" "vertices/2" }
            /// A quadrilateral.
            Quad quad Box custom { "vertices/0" "vertices/1" "vertices/2" "vertices/3" }
            /// A disc.
            Disc disc Inline derived {
                center: point;
                normal: direction "normal of a disc";
                radius: length "radius";
            }
            /// A cylinder with two caps.
            Cylinder cylinder Inline derived {
                base: point;
                axis: direction "axis of a cylinder";
                height: length "height";
                radius: length "radius";
            }
            /// A cone with a cap at its base.
            Cone cone Inline derived {
                base: point;
                up: step "height of a cone";
                radius: length "radius";
            }
            /// A paraboloid with a cap at its base.
            Paraboloid paraboloid Inline derived {
                base: point;
                up: step "height of a paraboloid";
                radius: length "radius";
            }
            /// A torus.
            Torus torus Inline derived {
                center: point;
                axis: direction "axis of a torus";
                major: length "radius";
                minor: length "radius of the tube";
            }
            /// A mesh, placed.
            Instance instance Box custom { "mesh" "worldFromObject" }
            /// An ellipsoid.
            Ellipsoid ellipsoid Box custom { "center" "axes" }
            /// A cylinder without ends.
            InfiniteCylinder infinite_cylinder Inline derived {
                center: point;
                axis: direction "axis of a cylinder";
                radius: length "radius";
            }
            /// A CSG solid.
            Csg csg Box custom { "operands" }
        }
    };
}

/// Declares the shapes of the IR.
macro_rules! declare {
    (
        all { $($(#[$doc:meta])* $Name:ident $name:ident $Store:ident [$($path:expr),*];)* }
        derived $derived:tt
    ) => {
        /// A shape of any kind, in world coordinates.
        #[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema, Arbitrary)]
        #[serde(rename_all = "camelCase", deny_unknown_fields)]
        pub enum Shape {
            $($(#[$doc])* $Name($Name),)*
        }

        /// The kind of a shape.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
        pub enum ShapeKind {
            $($(#[$doc])* $Name,)*
        }

        impl ShapeKind {
            /// Its key in the IR.
            pub fn name(self) -> &'static str {
                match self {
                    $(Self::$Name => camel_case!($name),)*
                }
            }

            /// The paths of its values in the IR, relative to the shape.
            pub(super) fn values(self) -> &'static [&'static str] {
                match self {
                    $(Self::$Name => &[$($path),*],)*
                }
            }
        }

        impl Shape {
            /// The kind of the shape.
            #[must_use]
            pub fn kind(&self) -> ShapeKind {
                match self {
                    $(Self::$Name(_) => ShapeKind::$Name,)*
                }
            }

            /// The shape as something with bounds.
            pub(super) fn bounded(&self) -> &dyn HasBounds {
                match self {
                    $(Self::$Name(shape) => shape,)*
                }
            }
        }
    };
}

shapes!(declare);

/// A shape with bounds.
pub(super) trait HasBounds {
    /// Visits cubes, each by centre and half side, whose convex hull contains the shape; visits
    /// none if the shape is infinite. `meshes` holds the bounding box of each mesh of the scene.
    fn visit_bounds(&self, meshes: &[[Vec3; 2]], visit: &mut dyn FnMut(Vec3, f64));
}

/// A shape with a material.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema, Arbitrary)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
pub struct Surface {
    /// The geometry, in world coordinates.
    pub shape: Shape,
    /// Its material.
    pub material: MaterialId,
    /// Whether the surface blocks no light. It stays visible and can receive shadows. Path tracing
    /// ignores this flag: there every surface casts a shadow.
    #[serde(default, skip_serializing_if = "is_default")]
    pub casts_no_shadow: bool,
    /// How far it moves per second, in the world: at the time 0 it is where its shape says.
    #[serde(default, skip_serializing_if = "Velocity::is_zero")]
    pub velocity: Velocity,
}

/// How far something moves per second. It takes 8 bytes where nothing moves: a scene may have a
/// million surfaces.
#[derive(Clone, Debug, Default, Serialize, Deserialize, JsonSchema, Arbitrary)]
#[serde(from = "[f64; 3]", into = "[f64; 3]")]
#[schemars(inline, with = "[f64; 3]")]
pub struct Velocity(Option<Box<[f64; 3]>>);

impl Velocity {
    /// Its coordinates.
    #[must_use]
    pub fn get(&self) -> [f64; 3] {
        self.0.as_deref().copied().unwrap_or_default()
    }

    /// Whether all bits are 0.
    #[must_use]
    pub fn is_zero(&self) -> bool {
        self.get().map(f64::to_bits) == [0; 3]
    }
}

impl From<[f64; 3]> for Velocity {
    fn from(velocity: [f64; 3]) -> Self {
        Self((velocity.map(f64::to_bits) != [0; 3]).then(|| Box::new(velocity)))
    }
}

impl From<Velocity> for [f64; 3] {
    fn from(velocity: Velocity) -> Self {
        velocity.get()
    }
}

impl PartialEq for Velocity {
    fn eq(&self, other: &Self) -> bool {
        self.get() == other.get()
    }
}

impl Surface {
    /// A surface that casts a shadow and does not move.
    #[must_use]
    pub fn new(shape: Shape, material: MaterialId) -> Self {
        Self {
            shape,
            material,
            casts_no_shadow: false,
            velocity: Velocity::default(),
        }
    }
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
    /// The rows of the rotation from world directions to those of the texture, whose poles are ±z;
    /// absent for the identity. u = φ/2π with φ = atan2(y, x) in [0, 2π), v = 1 − θ/π with θ =
    /// acos(z).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub texture_from_world: Option<[[f64; 3]; 3]>,
}

impl HasBounds for Sphere {
    fn visit_bounds(&self, _: &[[Vec3; 2]], visit: &mut dyn FnMut(Vec3, f64)) {
        let Self {
            center,
            radius,
            texture_from_world: _,
        } = self;
        visit(Vec3::from_array(*center), *radius);
    }
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

impl HasBounds for Plane {
    fn visit_bounds(&self, _: &[[Vec3; 2]], _: &mut dyn FnMut(Vec3, f64)) {
        let Self {
            center: _,
            normal: _,
        } = self;
    }
}

/// A two-sided triangle.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema, Arbitrary)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
pub struct Triangle {
    /// The corners v0, v1, v2; the normal is (v1 − v0) × (v2 − v0).
    pub vertices: [[f64; 3]; 3],
    /// The texture coordinates of the corners.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub uvs: Option<[[f64; 2]; 3]>,
}

impl HasBounds for Triangle {
    fn visit_bounds(&self, _: &[[Vec3; 2]], visit: &mut dyn FnMut(Vec3, f64)) {
        let Self { vertices, uvs: _ } = self;
        vertices
            .iter()
            .for_each(|v| visit(Vec3::from_array(*v), 0.0));
    }
}

/// A two-sided quadrilateral: flat if its corners are coplanar, else a bilinear patch.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema, Arbitrary)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
pub struct Quad {
    /// The corners in order around it, with uv (0, 0), (1, 0), (1, 1), (0, 1).
    pub vertices: [[f64; 3]; 4],
}

impl Quad {
    /// Whether the corners are visibly not coplanar: the height of their tetrahedron exceeds a
    /// thousandth of the longest side or diagonal.
    #[must_use]
    pub fn is_bent(&self) -> bool {
        const SEEN: f64 = 1e-3;
        let [a, b, c, d] = self.vertices.map(Vec3::from_array);
        let sides = [b - a, c - a, d - a, c - b, d - b, d - c];
        let longest = sides
            .iter()
            .fold(0.0_f64, |most, side| most.max(side.abs().max_element()));
        let [ab, ac, ad, bc, bd, _] = sides.map(|side| side / longest);
        // The height of the tetrahedron over its largest face.
        let faces = [ab.cross(ac), ab.cross(ad), ac.cross(ad), bc.cross(bd)];
        let largest = faces
            .iter()
            .fold(0.0_f64, |most, face| most.max(face.length()));
        longest.is_finite() && faces[0].dot(ad).abs() > SEEN * largest
    }
}

impl HasBounds for Quad {
    fn visit_bounds(&self, _: &[[Vec3; 2]], visit: &mut dyn FnMut(Vec3, f64)) {
        let Self { vertices } = self;
        vertices
            .iter()
            .for_each(|v| visit(Vec3::from_array(*v), 0.0));
    }
}

/// A two-sided disc.
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

impl HasBounds for Disc {
    fn visit_bounds(&self, _: &[[Vec3; 2]], visit: &mut dyn FnMut(Vec3, f64)) {
        let Self {
            center,
            normal: _,
            radius,
        } = self;
        visit(Vec3::from_array(*center), *radius);
    }
}

/// A cylinder with two caps.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema, Arbitrary)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
pub struct Cylinder {
    /// The centre of its base.
    pub base: [f64; 3],
    /// The direction from the base to the top, of any length but 0.
    pub axis: [f64; 3],
    /// The distance from base to top, above 0.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub height: f64,
    /// Its radius, above 0.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub radius: f64,
}

impl HasBounds for Cylinder {
    fn visit_bounds(&self, _: &[[Vec3; 2]], visit: &mut dyn FnMut(Vec3, f64)) {
        let Self {
            base,
            axis,
            height,
            radius,
        } = self;
        let base = Vec3::from_array(*base);
        let axis = unit(Vec3::from_array(*axis)).unwrap_or(Vec3::ZERO);
        visit(base, *radius);
        visit(base + axis * *height, *radius);
    }
}

/// A cone with a cap at its base.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema, Arbitrary)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
pub struct Cone {
    /// The centre of its base.
    pub base: [f64; 3],
    /// The vector from the centre of the base to the apex.
    pub up: [f64; 3],
    /// The radius of the base, above 0.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub radius: f64,
}

impl HasBounds for Cone {
    fn visit_bounds(&self, _: &[[Vec3; 2]], visit: &mut dyn FnMut(Vec3, f64)) {
        let Self { base, up, radius } = self;
        let base = Vec3::from_array(*base);
        visit(base, *radius);
        visit(base + Vec3::from_array(*up), 0.0);
    }
}

/// A paraboloid with a cap at its base.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema, Arbitrary)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
pub struct Paraboloid {
    /// The centre of its base.
    pub base: [f64; 3],
    /// The vector from the centre of the base to the vertex.
    pub up: [f64; 3],
    /// The radius of the base, above 0.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub radius: f64,
}

impl HasBounds for Paraboloid {
    /// The profile lies in the convex hull of the base circle and a disc of half the radius at the
    /// vertex.
    fn visit_bounds(&self, _: &[[Vec3; 2]], visit: &mut dyn FnMut(Vec3, f64)) {
        let Self { base, up, radius } = self;
        let base = Vec3::from_array(*base);
        visit(base, *radius);
        visit(base + Vec3::from_array(*up), 0.5 * *radius);
    }
}

/// A torus.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema, Arbitrary)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
pub struct Torus {
    /// Its centre.
    pub center: [f64; 3],
    /// The direction of its axis, of any length but 0.
    pub axis: [f64; 3],
    /// The distance from the centre to the middle of the tube, above 0.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub major: f64,
    /// The radius of the tube, above 0.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub minor: f64,
}

impl HasBounds for Torus {
    fn visit_bounds(&self, _: &[[Vec3; 2]], visit: &mut dyn FnMut(Vec3, f64)) {
        let Self {
            center,
            axis: _,
            major,
            minor,
        } = self;
        visit(Vec3::from_array(*center), major + minor);
    }
}

/// A mesh placed in the world.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema, Arbitrary)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
pub struct Instance {
    /// The mesh.
    pub mesh: MeshId,
    /// The columns of the affine map from object to world coordinates: the images of the three
    /// axes, then of the origin.
    pub world_from_object: [[f64; 3]; 4],
}

impl HasBounds for Instance {
    fn visit_bounds(&self, meshes: &[[Vec3; 2]], visit: &mut dyn FnMut(Vec3, f64)) {
        let Self {
            mesh,
            world_from_object,
        } = self;
        let bounds = meshes.get(mesh.0 as usize);
        let Some(bounds) = bounds.filter(|[low, _]| low.is_finite()) else {
            return;
        };
        let world = DAffine3::from_cols_array_2d(world_from_object);
        let placed = box_corners(*bounds).map(|corner| world.transform_point3(corner));
        placed.into_iter().for_each(|corner| visit(corner, 0.0));
    }
}

/// An ellipsoid: the image of the unit sphere.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema, Arbitrary)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
pub struct Ellipsoid {
    /// Its centre.
    pub center: [f64; 3],
    /// The images of the three axes, which span space: the semi-axes, if they are perpendicular.
    pub axes: [[f64; 3]; 3],
}

impl HasBounds for Ellipsoid {
    fn visit_bounds(&self, _: &[[Vec3; 2]], visit: &mut dyn FnMut(Vec3, f64)) {
        let Self { center, axes } = self;
        let axes = axes.map(Vec3::from_array);
        let Bounds { min, max } = Bounds::around_ellipsoid(Vec3::from_array(*center), axes);
        box_corners([min, max])
            .into_iter()
            .for_each(|corner| visit(corner, 0.0));
    }
}

/// A cylinder without ends.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema, Arbitrary)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
pub struct InfiniteCylinder {
    /// A point of its axis.
    pub center: [f64; 3],
    /// The direction of its axis, of any length but 0.
    pub axis: [f64; 3],
    /// Its radius, above 0.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub radius: f64,
}

impl HasBounds for InfiniteCylinder {
    fn visit_bounds(&self, _: &[[Vec3; 2]], _: &mut dyn FnMut(Vec3, f64)) {
        let Self {
            center: _,
            axis: _,
            radius: _,
        } = self;
    }
}
