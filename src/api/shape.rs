//! Shapes and transforms of scenes that are built in code.

use super::MeshId;
use rtc_ir as ir;
use rtc_math::{SetStep, Vec3, cos, rotated_about, rotated_to_z, sin, to_u32, unit};

/// A shape in world coordinates, of any kind that scenes have. Lengths are in scene units and above
/// 0, directions have any length but 0.
///
/// ```
/// use rtc::Shape;
///
/// let torus = Shape::torus([0.0; 3], [0.0, 1.0, 0.0], 2.0, 0.5);
/// assert_eq!(torus.kind(), "torus");
/// assert_eq!(torus.value("minor"), Some(vec![0.5]));
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Shape(pub(super) ir::Shape);

/// The type of an argument of each rule of the table of shapes.
#[expect(non_camel_case_types, reason = "the words of the table")]
mod argument {
    pub(super) type point = [f64; 3];
    pub(super) type direction = [f64; 3];
    pub(super) type step = [f64; 3];
    pub(super) type length = f64;
}

/// Declares the constructors of the shapes whose rows name their values; those of others follow by
/// hand.
macro_rules! constructors {
    (all $all:tt derived { $($(#[$doc:meta])* $Name:ident $name:ident {
        $($value:ident: $rule:ident $($words:literal)?;)*
    })* }) => {
        /// Constructors. An `axis`, `up` or `normal` is a direction; `up` has the height as length.
        impl Shape {
            $(
                $(#[$doc])*
                #[must_use]
                pub fn $name($($value: argument::$rule),*) -> Self {
                    Self(ir::Shape::$Name(ir::$Name { $($value),* }))
                }
            )*
        }
    };
}

ir::shapes!(constructors);

impl Shape {
    /// A sphere.
    #[must_use]
    pub fn sphere(center: [f64; 3], radius: f64) -> Self {
        Self(ir::Shape::Sphere(ir::Sphere {
            center,
            radius,
            texture_from_world: None,
        }))
    }

    /// A two-sided triangle; its normal is (v1 − v0) × (v2 − v0).
    #[must_use]
    pub fn triangle(vertices: [[f64; 3]; 3]) -> Self {
        Self(ir::Shape::Triangle(ir::Triangle {
            vertices,
            uvs: None,
        }))
    }

    /// A two-sided quadrilateral, flat or bent; its corners in order around it have the texture
    /// coordinates (0, 0), (1, 0), (1, 1), (0, 1).
    #[must_use]
    pub fn quad(vertices: [[f64; 3]; 4]) -> Self {
        Self(ir::Shape::Quad(ir::Quad { vertices }))
    }

    /// An ellipsoid: the image of the unit sphere, by the images of its three axes.
    #[must_use]
    pub fn ellipsoid(center: [f64; 3], axes: [[f64; 3]; 3]) -> Self {
        Self(ir::Shape::Ellipsoid(ir::Ellipsoid { center, axes }))
    }

    /// A mesh of the scene, placed.
    #[must_use]
    pub fn instance(mesh: MeshId, transform: Transform) -> Self {
        Self(ir::Shape::Instance(ir::Instance {
            mesh,
            world_from_object: transform.0,
        }))
    }

    /// The union of these solids. The operands of this, of an intersection and of a difference are
    /// 1 to 64 shapes with an inside: of a plane that is the side away from its normal; triangles,
    /// quads, discs and instances have none.
    #[must_use]
    pub fn union(operands: impl IntoIterator<Item = Self>) -> Self {
        Self::solid(operands, SetStep::Union)
    }

    /// The intersection of these solids.
    #[must_use]
    pub fn intersection(operands: impl IntoIterator<Item = Self>) -> Self {
        Self::solid(operands, SetStep::Intersection)
    }

    /// The first of these solids without the others.
    #[must_use]
    pub fn difference(operands: impl IntoIterator<Item = Self>) -> Self {
        Self::solid(operands, SetStep::Difference)
    }

    fn solid(operands: impl IntoIterator<Item = Self>, operation: SetStep) -> Self {
        let mut csg = ir::Csg {
            operands: Vec::new(),
            steps: Vec::new(),
            faces: Vec::new(),
        };
        for (index, Self(operand)) in operands.into_iter().enumerate() {
            if let ir::Shape::Csg(part) = operand {
                csg.operands.extend(part.operands);
                csg.steps.extend(part.steps);
            } else {
                // One that is no solid leaves an expression without operand, which is invalid.
                csg.operands.extend(ir::Solid::of(operand));
                csg.steps.push(SetStep::Operand);
            }
            csg.steps.extend((index > 0).then_some(operation));
        }
        csg.faces = (0..to_u32(csg.operands.len())).collect();
        Self(ir::Shape::Csg(csg))
    }

    /// Selects the part of a union, intersection or difference that lies on these operands,
    /// numbered from 0. Parts with other materials are separate objects; other shapes are
    /// unchanged.
    #[must_use]
    pub fn part(mut self, solids: &[u32]) -> Self {
        if let ir::Shape::Csg(csg) = &mut self.0 {
            csg.faces = solids.to_vec();
        }
        self
    }

    /// Sets the texture coordinates of the corners of a triangle; other shapes keep theirs.
    #[must_use]
    pub fn uvs(mut self, uvs: [[f64; 2]; 3]) -> Self {
        if let ir::Shape::Triangle(triangle) = &mut self.0 {
            triangle.uvs = Some(uvs);
        }
        self
    }

    /// Turns the texture of a sphere: its pole to the unit vector `axis`, then by `angle` degrees;
    /// other shapes keep theirs.
    #[must_use]
    pub fn pole(mut self, axis: [f64; 3], angle: f64) -> Self {
        if let ir::Shape::Sphere(sphere) = &mut self.0 {
            let axis = unit(Vec3::from_array(axis)).unwrap_or(Vec3::Z);
            sphere.texture_from_world = rotated_to_z(axis, angle);
        }
        self
    }

    /// The kind of the shape, as scenes in the IR name it, for example `sphere`.
    #[must_use]
    pub fn kind(&self) -> &'static str {
        self.0.kind().name()
    }

    /// The numbers of a value of the shape, by its name in the IR, for example `radius`; `None` if
    /// the shape has no such numbers.
    ///
    /// # Panics
    /// Never: every shape can be written.
    #[must_use]
    pub fn value(&self, name: &str) -> Option<Vec<f64>> {
        let json = serde_json::to_value(&self.0).expect("every shape can be written");
        let value = json.get(self.kind())?.get(name)?;
        let mut numbers = Vec::new();
        flatten(value, &mut numbers);
        (!numbers.is_empty()).then_some(numbers)
    }

    /// The mesh of an instance.
    #[must_use]
    pub fn mesh(&self) -> Option<MeshId> {
        if let ir::Shape::Instance(instance) = &self.0 {
            Some(instance.mesh)
        } else {
            None
        }
    }
}

/// The numbers of a value, in order.
fn flatten(value: &serde_json::Value, numbers: &mut Vec<f64>) {
    match value.as_array() {
        Some(list) => list.iter().for_each(|item| flatten(item, numbers)),
        None => numbers.extend(value.as_f64()),
    }
}

/// An affine map from the coordinates of a mesh to the world. Each step is applied after those
/// before it.
///
/// ```
/// use rtc::Transform;
///
/// let quarter = std::f64::consts::FRAC_PI_2;
/// let turned = Transform::new().scale([2.0; 3]).rotate([0.0, 1.0, 0.0], quarter);
/// let [x, y, z] = turned.translate([0.0, 5.0, 0.0]).apply([1.0, 0.0, 0.0]);
/// assert!(x.abs() < 1e-15 && y == 5.0 && z == -2.0);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Transform([[f64; 3]; 4]);

impl Default for Transform {
    fn default() -> Self {
        Self([Vec3::X, Vec3::Y, Vec3::Z, Vec3::ZERO].map(|column| column.to_array()))
    }
}

impl Transform {
    /// The identity.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// The map with these columns: the images of the three axes, then of the origin.
    #[must_use]
    pub fn from_columns(columns: [[f64; 3]; 4]) -> Self {
        Self(columns)
    }

    /// Scales along the axes of the world, about its origin.
    #[must_use]
    pub fn scale(self, factors: [f64; 3]) -> Self {
        self.map(|column| column * Vec3::from_array(factors))
    }

    /// Rotates about an axis through the origin, by an angle in radians, counterclockwise as seen
    /// against the axis; a zero axis is ignored.
    #[must_use]
    pub fn rotate(self, axis: [f64; 3], angle: f64) -> Self {
        match unit(Vec3::from_array(axis)) {
            Some(axis) => self.map(|column| rotated_about(column, axis, [sin(angle), cos(angle)])),
            None => self,
        }
    }

    /// Moves by a vector.
    #[must_use]
    pub fn translate(mut self, by: [f64; 3]) -> Self {
        let [.., origin] = &mut self.0;
        *origin = (Vec3::from_array(*origin) + Vec3::from_array(by)).to_array();
        self
    }

    /// The image of a point.
    #[must_use]
    pub fn apply(&self, point: [f64; 3]) -> [f64; 3] {
        let [x, y, z, origin] = self.0.map(Vec3::from_array);
        (x * point[0] + y * point[1] + z * point[2] + origin).to_array()
    }

    fn map(self, linear: impl Fn(Vec3) -> Vec3) -> Self {
        Self(
            self.0
                .map(|column| linear(Vec3::from_array(column)).to_array()),
        )
    }
}
