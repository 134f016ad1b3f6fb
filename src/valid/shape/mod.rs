//! The proof of the shapes: radii above 0, directions of nonzero length, faces with an area.

mod area;
mod check;

pub(super) use area::has_area;
pub(super) use check::surface;

use crate::math::{Positive, Vec3, is_flat};

/// A shape and the index of its material.
#[derive(Clone, Debug)]
pub struct Surface {
    /// The shape.
    pub shape: Shape,
    /// An index into [`super::Proof::materials`], in range.
    pub material: usize,
    /// Its index in the IR. The IR also has the triangles without an area.
    pub index: usize,
}

/// A shape of any kind.
#[derive(Clone, Debug)]
pub enum Shape {
    /// A sphere.
    Sphere(Sphere),
    /// An infinite plane.
    Plane(Plane),
    /// A triangle with an area.
    Triangle(Triangle),
    /// A quadrilateral with an area.
    Quad(Box<Quad>),
    /// A disc.
    Disc(Disc),
    /// A cylinder.
    Cylinder(Cylinder),
    /// A cone.
    Cone(Cone),
    /// A torus.
    Torus(Torus),
    /// An instance of a mesh.
    Instance(Box<Instance>),
}

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

/// An infinite plane.
#[derive(Clone, Copy, Debug)]
pub struct Plane {
    /// A point of it.
    pub center: Vec3,
    /// Its normal, with its largest component in [1, 2).
    pub normal: Vec3,
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

/// A disc.
#[derive(Clone, Copy, Debug)]
pub struct Disc {
    /// Its centre.
    pub center: Vec3,
    /// Its normal, with its largest component in [1, 2).
    pub normal: Vec3,
    /// Its radius.
    pub radius: Positive,
}

/// A cylinder with two caps.
#[derive(Clone, Copy, Debug)]
pub struct Cylinder {
    /// The centre of its base.
    pub base: Vec3,
    /// The direction to the top, with its largest component in [1, 2).
    pub axis: Vec3,
    /// The distance from base to top.
    pub height: Positive,
    /// Its radius.
    pub radius: Positive,
}

/// A cone with a cap at its base.
#[derive(Clone, Copy, Debug)]
pub struct Cone {
    /// The centre of its base.
    pub base: Vec3,
    /// The vector from there to the apex; not zero.
    pub up: Vec3,
    /// The radius of its base.
    pub radius: Positive,
}

/// A torus.
#[derive(Clone, Copy, Debug)]
pub struct Torus {
    /// Its centre.
    pub center: Vec3,
    /// The direction of its axis, with its largest component in [1, 2).
    pub axis: Vec3,
    /// The distance from the centre to the middle of the tube.
    pub major: Positive,
    /// The radius of the tube.
    pub minor: Positive,
}

/// A mesh with its place in the world.
#[derive(Clone, Copy, Debug)]
pub struct Instance {
    /// An index into [`super::Proof::meshes`], in range.
    pub mesh: usize,
    /// The images of the three axes, linearly independent, and of the origin.
    pub world_from_object: [Vec3; 4],
}
