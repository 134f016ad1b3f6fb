//! The shapes of a world: how each kind is made of a proven one.

use crate::math::Vec3;
use crate::render::shape::Shape;
use crate::render::shape::basic::Basic;
use crate::render::shape::cone::Cone;
use crate::render::shape::cylinder::Cylinder;
use crate::render::shape::disc::Disc;
use crate::render::shape::geometry::Geometry;
use crate::render::shape::instance::Instance;
use crate::render::shape::mesh::{Attributes, PreparedMesh};
use crate::render::shape::plane::Plane;
use crate::render::shape::quad::Quad;
use crate::render::shape::sphere::Sphere;
use crate::render::shape::torus::Torus;
use crate::render::shape::triangle::Triangle;
use crate::valid;
use std::sync::Arc;

/// A kind of shape that is made of proven ones.
pub trait Prepare: Geometry {
    /// A mesh prepared once for all its instances.
    type Mesh: Send + Sync;

    /// Prepares a mesh.
    #[must_use]
    fn prepare_mesh(mesh: &valid::Mesh) -> Self::Mesh;

    /// Prepares a shape; `None` for one that no ray hits.
    #[must_use]
    fn prepare(shape: &valid::Shape, meshes: &[Arc<Self::Mesh>]) -> Option<Self>;
}

impl Prepare for Shape {
    type Mesh = PreparedMesh;

    fn prepare_mesh(mesh: &valid::Mesh) -> PreparedMesh {
        let valid::Mesh {
            positions,
            normals,
            uvs,
            second_uvs,
            tangents,
            colors,
            triangles,
        } = mesh;
        let attributes = Attributes {
            normals: normals.clone(),
            uvs: uvs.clone(),
            second_uvs: second_uvs.clone(),
            tangents: tangents.clone(),
            colors: colors.clone(),
        };
        PreparedMesh::new(positions, triangles, attributes)
    }

    /// `None` for a triangle whose area the arithmetic can't tell from 0: no ray hits it.
    fn prepare(shape: &valid::Shape, meshes: &[Arc<PreparedMesh>]) -> Option<Self> {
        Some(match shape {
            valid::Shape::Sphere(sphere) => Self::Sphere(
                Sphere {
                    center: sphere.center,
                    radius: sphere.radius.get(),
                },
                sphere.texture_from_world.as_deref().copied().unwrap_or([
                    Vec3::X,
                    Vec3::Y,
                    Vec3::Z,
                ]),
            ),
            valid::Shape::Plane(plane) => Self::Plane(Plane::new(plane.center, plane.normal)),
            valid::Shape::Triangle(triangle) => Self::Triangle(
                Triangle::new(triangle.vertices)?,
                triangle.uvs.as_deref().copied(),
            ),
            valid::Shape::Quad(quad) => Self::Quad(Box::new(Quad::new(quad.vertices))),
            valid::Shape::Disc(disc) => {
                Self::Disc(Disc::new(disc.center, disc.normal, disc.radius.get()))
            }
            valid::Shape::Cylinder(cylinder) => Self::Cylinder(Cylinder::new(
                cylinder.base,
                cylinder.axis,
                cylinder.height.get(),
                cylinder.radius.get(),
            )),
            valid::Shape::Cone(cone) => {
                Self::Cone(Cone::new(cone.base, cone.up, cone.radius.get()))
            }
            valid::Shape::Torus(torus) => Self::Torus(Torus::new(
                torus.center,
                torus.axis,
                torus.major.get(),
                torus.minor.get(),
            )),
            valid::Shape::Instance(instance) => Self::Instance(Box::new(Instance::new(
                &meshes[instance.mesh],
                instance.world_from_object,
            ))),
        })
    }
}

impl Prepare for Basic {
    type Mesh = PreparedMesh;

    fn prepare_mesh(mesh: &valid::Mesh) -> PreparedMesh {
        Shape::prepare_mesh(mesh)
    }

    fn prepare(shape: &valid::Shape, meshes: &[Arc<PreparedMesh>]) -> Option<Self> {
        match Shape::prepare(shape, meshes)? {
            Shape::Sphere(sphere, rows) => Some(Self::Sphere(sphere, rows)),
            Shape::Plane(plane) => Some(Self::Plane(plane)),
            Shape::Triangle(triangle, uvs) => Some(Self::Triangle(triangle, uvs)),
            Shape::Quad(_)
            | Shape::Disc(_)
            | Shape::Cylinder(_)
            | Shape::Cone(_)
            | Shape::Torus(_)
            | Shape::Instance(_) => None,
        }
    }
}
