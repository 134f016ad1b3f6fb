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

/// A validated shape of one kind.
trait PrepareShape {
    /// Its type in a world.
    type Prepared;

    /// Prepares it; `None` if no ray hits it.
    fn prepared(&self, meshes: &PreparedMeshes) -> Option<Self::Prepared>;
}

/// Prepares each shape in its own way, or by the values of its row, in their order.
macro_rules! prepare {
    (
        all { $($(#[$doc:meta])* $Name:ident $name:ident $Store:ident $paths:tt;)* }
        derived { $($(#[$about:meta])* $Derived:ident $word:ident {
            $type:literal $($value:ident: $rule:ident $key:literal $($words:literal)?;)*
        })* }
    ) => {
        fn prepared(shape: &valid::Shape, meshes: &PreparedMeshes) -> Option<Shape> {
            Some(match shape {
                $(valid::Shape::$Name(shape) => Shape::$Name(shape.prepared(meshes)?.into()),)*
            })
        }

        $(impl PrepareShape for valid::$Derived {
            type Prepared = $Derived;

            fn prepared(&self, _: &PreparedMeshes) -> Option<$Derived> {
                Some($Derived::new($(self.$value.into()),*))
            }
        })*
    };
}

rtc_tables::shapes!(prepare);

impl PrepareShape for valid::Sphere {
    type Prepared = TexturedSphere;

    fn prepared(&self, _: &PreparedMeshes) -> Option<TexturedSphere> {
        let rows = self.texture_from_world.as_deref().copied();
        Some(TexturedSphere {
            sphere: sphere::Sphere {
                center: self.center,
                radius: self.radius.get(),
            },
            texture_from_world: rows.unwrap_or(Vec3::AXES),
        })
    }
}

impl PrepareShape for valid::Triangle {
    type Prepared = TexturedTriangle;

    /// `None` for a triangle whose area the arithmetic cannot distinguish from 0: no ray hits it.
    fn prepared(&self, _: &PreparedMeshes) -> Option<TexturedTriangle> {
        Some(TexturedTriangle {
            triangle: triangle::Triangle::new(self.vertices)?,
            uvs: self.uvs.as_deref().copied(),
        })
    }
}

impl PrepareShape for valid::Quad {
    type Prepared = Quad;

    fn prepared(&self, _: &PreparedMeshes) -> Option<Quad> {
        Some(Quad::new(self.vertices))
    }
}

impl PrepareShape for valid::Ellipsoid {
    type Prepared = Ellipsoid;

    fn prepared(&self, _: &PreparedMeshes) -> Option<Ellipsoid> {
        Some(Ellipsoid::new(self.center, self.axes))
    }
}

impl PrepareShape for valid::Csg {
    type Prepared = Csg;

    fn prepared(&self, meshes: &PreparedMeshes) -> Option<Csg> {
        let operands = self.operands.iter();
        let operands = operands.map(|operand| prepared(operand, meshes));
        let operands = operands.collect::<Option<_>>()?;
        Some(Csg::new(operands, self.steps.clone(), self.faces))
    }
}

impl PrepareShape for valid::Instance {
    type Prepared = Instance;

    fn prepared(&self, meshes: &PreparedMeshes) -> Option<Instance> {
        Some(Instance::new(&meshes[self.mesh], self.world_from_object))
    }
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
