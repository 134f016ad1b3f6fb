//! Preparation of each kind of shape from its validated form.

use crate::accel::simd::SimdLevel;
use crate::shape::Shape;
use crate::shape::baseline::BaselineShape;
use crate::shape::baseline::real::Real;
use crate::shape::basic::BasicShape;
use crate::shape::geometry::Intersect;
use crate::shape::kinds::*;
use crate::shape::mesh::{Attributes, BaselineMesh, PreparedMesh};
use crate::shape::sphere::{self, TexturedSphere};
use crate::shape::triangle::{self, TexturedTriangle};
use rtc_math::{IdTable, Vec3};
use rtc_valid as valid;
use std::sync::Arc;

/// A kind of shape that is prepared from validated ones.
pub trait Prepare: Intersect {
    /// A mesh prepared once for all its instances.
    type Mesh: Send + Sync;

    /// Prepares a mesh, for rays traced with the SIMD instructions of a level.
    #[must_use]
    fn prepare_mesh(mesh: &valid::Mesh, simd: SimdLevel) -> Self::Mesh;

    /// Prepares a shape; `None` for one that no ray hits.
    #[must_use]
    fn prepare(
        shape: &valid::Shape,
        meshes: &IdTable<valid::Mesh, Arc<Self::Mesh>>,
    ) -> Option<Self>;
}

impl Prepare for Shape {
    type Mesh = PreparedMesh;

    fn prepare_mesh(mesh: &valid::Mesh, simd: SimdLevel) -> PreparedMesh {
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
        PreparedMesh::new(positions, triangles, attributes, simd)
    }

    fn prepare(shape: &valid::Shape, meshes: &PreparedMeshes) -> Option<Self> {
        prepared(shape, meshes)
    }
}

/// The meshes of a scene, prepared.
type PreparedMeshes = IdTable<valid::Mesh, Arc<PreparedMesh>>;

fn prepared(shape: &valid::Shape, meshes: &PreparedMeshes) -> Option<Shape> {
    Some(match shape {
        valid::Shape::Sphere(s) => Shape::Sphere(textured_sphere(s)),
        valid::Shape::Plane(s) => Shape::Plane(Plane::new(s.center, s.normal)),
        valid::Shape::Triangle(s) => Shape::Triangle(textured_triangle(s)?),
        valid::Shape::Quad(s) => Shape::Quad(Quad::new(s.vertices).into()),
        valid::Shape::Disc(s) => Shape::Disc(Disc::new(s.center, s.normal, s.radius.get())),
        valid::Shape::Cylinder(s) => {
            let (height, radius) = (s.height.get(), s.radius.get());
            Shape::Cylinder(Cylinder::new(s.base, s.axis, height, radius))
        }
        valid::Shape::Cone(s) => Shape::Cone(Cone::new(s.base, s.up, s.radius.get())),
        valid::Shape::Paraboloid(s) => {
            Shape::Paraboloid(Paraboloid::new(s.base, s.up, s.radius.get()))
        }
        valid::Shape::Torus(s) => {
            let (major, minor) = (s.major.get(), s.minor.get());
            Shape::Torus(Torus::new(s.center, s.axis, major, minor))
        }
        valid::Shape::Instance(s) => {
            Shape::Instance(Instance::new(&meshes[s.mesh], s.world_from_object).into())
        }
        valid::Shape::Ellipsoid(s) => Shape::Ellipsoid(Ellipsoid::new(s.center, s.axes).into()),
        valid::Shape::InfiniteCylinder(s) => {
            let radius = s.radius.get();
            Shape::InfiniteCylinder(InfiniteCylinder::new(s.center, s.axis, radius))
        }
        valid::Shape::Csg(s) => {
            let operands = s.operands.iter();
            let operands = operands.map(|operand| prepared(operand, meshes));
            let operands = operands.collect::<Option<_>>()?;
            Shape::Csg(Csg::new(operands, s.steps.clone(), s.faces).into())
        }
    })
}

fn textured_sphere(sphere: &valid::Sphere) -> TexturedSphere {
    let rows = sphere.texture_from_world.as_deref().copied();
    TexturedSphere {
        sphere: sphere::Sphere {
            center: sphere.center,
            radius: sphere.radius.get(),
        },
        texture_from_world: rows.unwrap_or(Vec3::AXES),
    }
}

/// `None` for a triangle whose area the arithmetic cannot distinguish from 0: no ray hits it.
fn textured_triangle(triangle: &valid::Triangle) -> Option<TexturedTriangle> {
    Some(TexturedTriangle {
        triangle: triangle::Triangle::new(triangle.vertices)?,
        uvs: triangle.uvs.as_deref().copied(),
    })
}

impl Prepare for BasicShape {
    type Mesh = PreparedMesh;

    fn prepare_mesh(mesh: &valid::Mesh, simd: SimdLevel) -> PreparedMesh {
        Shape::prepare_mesh(mesh, simd)
    }

    fn prepare(shape: &valid::Shape, meshes: &PreparedMeshes) -> Option<Self> {
        let prepared = Shape::prepare(shape, meshes)?;
        if let Shape::Sphere(sphere) = prepared {
            Some(Self::Sphere(sphere))
        } else if let Shape::Plane(plane) = prepared {
            Some(Self::Plane(plane))
        } else if let Shape::Triangle(triangle) = prepared {
            Some(Self::Triangle(triangle))
        } else {
            None
        }
    }
}

impl<R: Real> Prepare for BaselineShape<R> {
    type Mesh = BaselineMesh<R>;

    fn prepare_mesh(mesh: &valid::Mesh, simd: SimdLevel) -> BaselineMesh<R> {
        BaselineMesh::new(Shape::prepare_mesh(mesh, simd))
    }

    fn prepare(
        shape: &valid::Shape,
        meshes: &IdTable<valid::Mesh, Arc<BaselineMesh<R>>>,
    ) -> Option<Self> {
        let robust = |mesh: &Arc<BaselineMesh<R>>| Arc::clone(&mesh.robust);
        let robust = Shape::prepare(shape, &meshes.iter().map(robust).collect())?;
        let mesh = if let valid::Shape::Instance(instance) = shape {
            Some(&meshes[instance.mesh])
        } else {
            None
        };
        Self::new(robust, mesh)
    }
}
