//! The formulas of the textbooks, in f64 or f32, beside the robust ones: what accuracy costs, and
//! what it saves.
//!
//! Hits within 1e-5 are taken for the surface a ray starts on, and rays start at the point itself.
//! What is not a question of arithmetic (texture coordinates, shading normals, boxes) is asked of
//! the robust shape.

pub(in crate::render) mod cone;
pub(in crate::render) mod cylinder;
pub(in crate::render) mod instance;
mod line;
pub(in crate::render) mod plane;
pub(in crate::render) mod quad;
pub(in crate::render) mod real;
mod roots;
pub(in crate::render) mod sphere;
pub(in crate::render) mod torus;
pub(in crate::render) mod triangle;

use crate::math::Vec3;
use crate::render::accel::bounds::Bounds;
use crate::render::ray::{Interaction, Ray};
use crate::render::shape::Shape;
use crate::render::shape::geometry::Geometry;
use crate::render::shape::instance::{Asked, Details};
use crate::render::shape::triangle::Shear;
use line::Line;
use real::{Real, Vector};

/// A shape of any kind, ready to be hit by the plain formulas in `R`.
#[derive(Clone, Debug)]
pub struct PlainShape<R> {
    pub(in crate::render) form: Form<R>,
    /// Answers what is not a question of arithmetic.
    pub(in crate::render) twin: Box<Shape>,
}

/// How rays meet it.
#[derive(Clone, Debug)]
pub(in crate::render) enum Form<R> {
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
