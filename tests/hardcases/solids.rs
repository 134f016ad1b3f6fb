//! Shapes of every kind at any scale and place, ready to be hit, and what is known of rays that
//! leave them.

use super::mesh::Mesh;
use super::random::Random;
use rtc::internals::math::Vec3;
use rtc::internals::render::{
    Attributes, Cone, Cylinder, Disc, Instance, Interaction, Intersect, Paraboloid, Plane,
    PreparedMesh, Quad, Ray, Shape, SimdLevel, Sphere, TexturedSphere, TexturedTriangle, Torus,
    Triangle, WatertightRay,
};
use std::sync::Arc;

/// The kinds of shape.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Kind {
    Sphere,
    Plane,
    Triangle,
    Quad,
    Patch,
    Disc,
    Cylinder,
    Cone,
    Paraboloid,
    Torus,
    Mesh,
}

pub(crate) const KINDS: [(Kind, &str); 11] = [
    (Kind::Sphere, "sphere"),
    (Kind::Plane, "plane"),
    (Kind::Triangle, "triangle"),
    (Kind::Quad, "quad"),
    (Kind::Patch, "bilinear quad"),
    (Kind::Disc, "disc"),
    (Kind::Cylinder, "cylinder"),
    (Kind::Cone, "cone"),
    (Kind::Paraboloid, "paraboloid"),
    (Kind::Torus, "torus"),
    (Kind::Mesh, "mesh instance"),
];

impl Kind {
    /// Whether rays that leave it outward never meet it again.
    pub(crate) fn is_convex(self) -> bool {
        !matches!(self, Self::Patch | Self::Torus)
    }

    /// Whether it has an inside.
    pub(crate) fn is_solid(self) -> bool {
        matches!(
            self,
            Self::Sphere
                | Self::Cylinder
                | Self::Cone
                | Self::Paraboloid
                | Self::Torus
                | Self::Mesh
        )
    }
}

/// A shape of some kind as numbers, about `size` large and about `center`.
pub(crate) struct Form {
    pub(crate) kind: Kind,
    pub(crate) center: Vec3,
    /// A unit vector.
    pub(crate) axis: Vec3,
    /// Two sides of a face.
    sides: [Vec3; 2],
    pub(crate) radius: f64,
    pub(crate) height: f64,
    pub(crate) minor: f64,
    mesh: Arc<PreparedMesh>,
}

/// An icosphere of 80 triangles for all instances.
pub(crate) fn icosphere() -> Arc<PreparedMesh> {
    let Mesh {
        vertices,
        triangles,
    } = Mesh::icosphere(1);
    let index = |corner: usize| u32::try_from(corner).unwrap();
    let positions = vertices.iter().map(|vertex| vertex.to_array()).collect();
    let triangles = triangles
        .iter()
        .map(|triangle| triangle.map(index))
        .collect();
    Arc::new(PreparedMesh::new(
        &positions,
        &triangles,
        Attributes::default(),
        SimdLevel::best(),
    ))
}

impl Form {
    pub(crate) fn random(
        kind: Kind,
        random: &mut Random,
        size: f64,
        center: Vec3,
        mesh: &Arc<PreparedMesh>,
    ) -> Self {
        let axis = random.direction();
        let side = axis
            .cross(random.direction())
            .normalize_or(axis.any_orthonormal_vector());
        let other = axis.cross(side) + side * random.between(-0.5, 0.5);
        let radius = size * random.between(0.5, 1.0);
        Self {
            kind,
            center,
            axis,
            sides: [side * radius, other * (size * random.between(0.5, 1.0))],
            radius,
            height: size * random.between(0.5, 2.0),
            minor: radius * random.between(0.05, 0.6),
            mesh: Arc::clone(mesh),
        }
    }

    /// The same form `gap` further inside, or behind.
    pub(crate) fn inner(&self, gap: f64) -> Self {
        let mut inner = Self {
            mesh: Arc::clone(&self.mesh),
            ..*self
        };
        match self.kind {
            Kind::Sphere => inner.radius -= gap,
            Kind::Plane | Kind::Triangle | Kind::Quad | Kind::Patch | Kind::Disc => {
                inner.center -= self.axis * gap
            }
            Kind::Cylinder => {
                inner.center += self.axis * gap;
                inner.height -= 2.0 * gap;
                inner.radius -= gap;
            }
            Kind::Cone => {
                let slant = (self.height * self.height + self.radius * self.radius).sqrt();
                inner.center += self.axis * gap;
                inner.height -= gap * (1.0 + slant / self.radius);
                inner.radius *= inner.height / self.height;
            }
            Kind::Paraboloid => {
                let scale = 1.0 - 1.5 * gap / self.height.min(self.radius);
                inner.center += self.axis * gap;
                inner.height *= scale;
                inner.radius *= scale;
            }
            Kind::Torus => inner.minor -= gap,
            Kind::Mesh => {
                inner.radius *= 1.0 - gap / self.radius;
            }
        }
        inner
    }

    pub(crate) fn shape(&self) -> Shape {
        let Self {
            center,
            axis,
            sides: [side, other],
            radius,
            ..
        } = *self;
        let face = [center, center + side, center + side + other, center + other];
        match self.kind {
            Kind::Sphere => Shape::Sphere(TexturedSphere {
                sphere: Sphere { center, radius },
                texture_from_world: Vec3::AXES,
            }),
            Kind::Plane => Shape::Plane(Plane::new(center, axis)),
            Kind::Triangle => Shape::Triangle(TexturedTriangle {
                triangle: Triangle::new([face[0], face[1], face[3]]).unwrap(),
                uvs: None,
            }),
            Kind::Quad => Shape::Quad(Box::new(Quad::new(face))),
            Kind::Patch => {
                let [a, b, c, d] = face;
                Shape::Quad(Box::new(Quad::new([a, b, c + axis * (0.3 * radius), d])))
            }
            Kind::Disc => Shape::Disc(Disc::new(center, axis, radius)),
            Kind::Cylinder => Shape::Cylinder(Cylinder::new(center, axis, self.height, radius)),
            Kind::Cone => Shape::Cone(Cone::new(center, axis * self.height, radius)),
            Kind::Paraboloid => {
                Shape::Paraboloid(Paraboloid::new(center, axis * self.height, radius))
            }
            Kind::Torus => Shape::Torus(Torus::new(center, axis, radius, self.minor)),
            Kind::Mesh => {
                let axes = [side, other, axis * self.height].map(|v| v * (radius / side.length()));
                Shape::Instance(Box::new(Instance::new(
                    &self.mesh,
                    [axes[0], axes[1], axes[2], center],
                )))
            }
        }
    }

    /// A point in the midst of it, at which rays aim.
    pub(crate) fn target(&self, random: &mut Random) -> Vec3 {
        let [side, other] = self.sides;
        match self.kind {
            Kind::Triangle | Kind::Quad | Kind::Patch => {
                let end = if self.kind == Kind::Triangle {
                    0.48
                } else {
                    0.98
                };
                self.center + side * random.between(0.02, end) + other * random.between(0.02, end)
            }
            Kind::Cylinder | Kind::Cone | Kind::Paraboloid => {
                self.center
                    + self.axis * (self.height * random.uniform())
                    + random.cube() * self.radius
            }
            Kind::Torus => {
                let around = self
                    .axis
                    .cross(random.direction())
                    .normalize_or(side.normalize());
                self.center + around * self.radius + random.cube() * self.minor
            }
            Kind::Sphere | Kind::Plane | Kind::Disc | Kind::Mesh => {
                self.center + random.cube() * self.radius
            }
        }
    }
}

/// The first hit of a ray on one shape, with its normal outward for a solid: a mesh knows no
/// inside.
pub(crate) fn first(form: &Form, shape: &Shape, ray: &Ray) -> Option<Interaction> {
    let (t, part) = hit(shape, ray)?;
    let mut at = shape.interaction(ray, t, part);
    if form.kind == Kind::Mesh && at.normal.dot(at.point - form.center) < 0.0 {
        at.normal = -at.normal;
    }
    Some(at)
}

/// The first hit of a ray on one shape.
pub(crate) fn hit(shape: &Shape, ray: &Ray) -> Option<(f64, u32)> {
    shape.intersect(ray, &WatertightRay::new(ray), f64::INFINITY)
}
