//! The formulas of the textbooks, in f64 or f32, beside the robust ones: what accuracy costs, and
//! what it saves.
//!
//! Hits within 1e-5 are taken for the surface a ray starts on, and rays start at the point itself.
//! What is not a question of arithmetic (texture coordinates, shading normals, boxes) is asked of
//! the robust shape.

mod cone;
mod cylinder;
mod instance;
mod line;
mod plane;
mod quad;
mod real;
mod roots;
mod sphere;
mod torus;
mod triangle;

pub(in crate::render) use instance::Mesh;
pub use real::Real;

use crate::math::{Vec3, unit};
use crate::render::accel::bounds::Bounds;
use crate::render::ray::{Interaction, Ray};
use crate::render::shape::Shape;
use crate::render::shape::geometry::Geometry;
use crate::render::shape::instance::{Asked, Details, PreparedMesh};
use crate::render::shape::triangle::Shear;
use crate::valid;
use line::Line;
use real::Vector;
use std::sync::Arc;

/// A shape of any kind, ready to be hit by the plain formulas in `R`.
#[derive(Clone, Debug)]
pub struct PlainShape<R> {
    form: Form<R>,
    /// Answers what is not a question of arithmetic.
    twin: Box<Shape>,
}

#[derive(Clone, Debug)]
enum Form<R> {
    Sphere(sphere::Sphere<R>),
    Plane(plane::Plane<R>),
    Triangle(triangle::Triangle<R>),
    Quad(Box<quad::Quad<R>>),
    Disc(plane::Disc<R>),
    Cylinder(Box<cylinder::Cylinder<R>>),
    Cone(Box<cone::Cone<R>>),
    Torus(torus::Torus<R>),
    Instance(Box<instance::Instance<R>>),
}

impl<R: Real> Form<R> {
    fn new(shape: &valid::Shape, twin: &Shape, meshes: &[Arc<Mesh<R>>]) -> Option<Self> {
        Some(match (shape, twin) {
            (valid::Shape::Sphere(valid::Sphere { center, radius, .. }), _) => {
                Self::Sphere(sphere::Sphere {
                    center: Vector::of(*center),
                    radius: R::of(radius.get()),
                })
            }
            (valid::Shape::Plane(valid::Plane { center, .. }), Shape::Plane(twin)) => {
                Self::Plane(plane::Plane::new(*center, twin.normal()))
            }
            (valid::Shape::Triangle(valid::Triangle { vertices, .. }), _) => {
                Self::Triangle(triangle::Triangle::new(vertices))
            }
            (valid::Shape::Quad(shape), Shape::Quad(twin)) => {
                Self::Quad(Box::new(quad::Quad::new(twin, shape.vertices)))
            }
            (
                valid::Shape::Disc(valid::Disc {
                    center,
                    normal,
                    radius,
                }),
                _,
            ) => Self::Disc(plane::Disc::new(*center, unit(*normal)?, radius.get())),
            (
                valid::Shape::Cylinder(valid::Cylinder {
                    base,
                    axis,
                    height,
                    radius,
                }),
                _,
            ) => {
                let cylinder =
                    cylinder::Cylinder::new(*base, unit(*axis)?, height.get(), radius.get());
                Self::Cylinder(Box::new(cylinder))
            }
            (valid::Shape::Cone(valid::Cone { base, up, radius }), _) => {
                Self::Cone(Box::new(cone::Cone::new(*base, *up, radius.get())))
            }
            (
                valid::Shape::Torus(valid::Torus {
                    center,
                    axis,
                    major,
                    minor,
                }),
                _,
            ) => Self::Torus(torus::Torus {
                center: Vector::of(*center),
                axis: Vector::of(unit(*axis)?),
                major: R::of(major.get()),
                minor: R::of(minor.get()),
            }),
            (valid::Shape::Instance(shape), Shape::Instance(twin)) => {
                let origin = shape.world_from_object[3];
                Self::Instance(Box::new(instance::Instance::new(
                    &meshes[shape.mesh],
                    twin,
                    origin,
                )))
            }
            (valid::Shape::Plane(_) | valid::Shape::Quad(_) | valid::Shape::Instance(_), _) => {
                return None;
            }
        })
    }

    fn normal(&self, line: &Line<R>, point: Vector<R>, part: u32) -> Vector<R> {
        match self {
            Self::Sphere(sphere) => sphere.normal(point),
            Self::Plane(plane) => plane.normal,
            Self::Triangle(triangle) => triangle.normal(),
            Self::Quad(quad) => quad.normal(line, part),
            Self::Disc(disc) => disc.plane.normal,
            Self::Cylinder(cylinder) => cylinder.normal(point, part),
            Self::Cone(cone) => cone.normal(point, part),
            Self::Torus(torus) => torus.normal(point),
            Self::Instance(instance) => instance.normal(part),
        }
    }
}

impl<R: Real> Geometry for PlainShape<R> {
    type Mesh = Mesh<R>;

    fn prepare_mesh(mesh: &Arc<valid::Mesh>) -> Mesh<R> {
        Mesh::new(PreparedMesh::new(mesh))
    }

    fn prepare(shape: &valid::Shape, meshes: &[Arc<Mesh<R>>]) -> Option<Self> {
        let twin_mesh = |mesh: &Arc<Mesh<R>>| Arc::clone(&mesh.twin);
        let twin = Shape::prepare(shape, &meshes.iter().map(twin_mesh).collect::<Vec<_>>())?;
        Some(Self {
            form: Form::new(shape, &twin, meshes)?,
            twin: Box::new(twin),
        })
    }

    #[inline]
    fn intersect(&self, ray: &Ray, _shear: &Shear, t_max: f64) -> Option<(f64, u32)> {
        let line = Line::of(ray);
        let hit = match &self.form {
            Form::Sphere(sphere) => sphere.intersect(&line),
            Form::Plane(plane) => plane.intersect(&line),
            Form::Triangle(triangle) => triangle.intersect(&line).map(|t| (t, 0)),
            Form::Quad(quad) => quad.intersect(&line),
            Form::Disc(disc) => disc.intersect(&line),
            Form::Cylinder(cylinder) => cylinder.intersect(&line),
            Form::Cone(cone) => cone.intersect(&line),
            Form::Torus(torus) => torus.intersect(&line),
            Form::Instance(instance) => return instance.intersect(&line, t_max),
        };
        hit.map(|(t, part)| (t.wide(), part))
    }

    /// The point as the ray gives it; rays from there start at the point itself.
    fn interaction(&self, ray: &Ray, t: f64, part: u32) -> Interaction {
        let line = Line::<R>::of(ray);
        let point = line.at(R::of(t));
        let normal = self.form.normal(&line, point, part).wide();
        Interaction {
            point: point.wide(),
            normal,
            offset: 0.0,
            back: Vec3::ZERO,
        }
    }

    fn has_uv(&self) -> bool {
        self.twin.has_uv()
    }

    fn has_shading_normals(&self) -> bool {
        self.twin.has_shading_normals()
    }

    fn details(&self, ray: &Ray, at: &Interaction, part: u32, asked: Asked) -> Details {
        self.twin.details(ray, at, part, asked)
    }

    fn bounds(&self) -> Option<Bounds> {
        self.twin.bounds()
    }
}
