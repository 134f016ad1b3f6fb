//! The formulas of the textbooks, in f64 or f32, beside the robust ones: they show the cost and the
//! benefit of accuracy.
//!
//! Hits nearer than 1e-5 are ignored: they are taken for the start of the ray, and rays start at
//! the point itself. The robust shape answers all questions that do not depend on the arithmetic
//! (texture coordinates, shading normals, boxes).

pub(in crate::render) mod cone;
pub(in crate::render) mod cylinder;
pub(in crate::render) mod instance;
pub(in crate::render) mod plane;
pub(in crate::render) mod quad;
mod ray;
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
use ray::PlainRay;
use real::{Real, Vector};

/// A shape of any kind, ready to be hit by the plain formulas in `R`.
#[derive(Clone, Debug)]
pub struct PlainShape<R> {
    pub(in crate::render) form: PlainForm<R>,
    /// Answers all that does not depend on the arithmetic.
    pub(in crate::render) robust: Box<Shape>,
}

/// The form by the plain arithmetic.
#[derive(Clone, Debug)]
pub(in crate::render) enum PlainForm<R> {
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

impl<R: Real> PlainForm<R> {
    fn normal(&self, ray: &PlainRay<R>, point: Vector<R>, prim_id: u32) -> Vector<R> {
        match self {
            Self::Sphere(sphere) => sphere.normal(point),
            Self::Plane(plane) => plane.normal,
            Self::Triangle(triangle) => triangle.normal(),
            Self::Quad(quad) => quad.normal(ray, prim_id),
            Self::Disc(disc) => disc.plane.normal,
            Self::Cylinder(cylinder) => cylinder.normal(point, prim_id),
            Self::Cone(cone) => cone.normal(point, prim_id),
            Self::Torus(torus) => torus.normal(point),
            Self::Instance(instance) => instance.normal(prim_id),
        }
    }
}

impl<R: Real> Geometry for PlainShape<R> {
    const FLATTENS: bool = false;

    #[inline]
    fn intersect(&self, ray: &Ray, _shear: &Shear, t_max: f64) -> Option<(f64, u32)> {
        let ray = PlainRay::of(ray);
        let hit = match &self.form {
            PlainForm::Sphere(sphere) => sphere.intersect(&ray),
            PlainForm::Plane(plane) => plane.intersect(&ray),
            PlainForm::Triangle(triangle) => triangle.intersect(&ray).map(|t| (t, 0)),
            PlainForm::Quad(quad) => quad.intersect(&ray),
            PlainForm::Disc(disc) => disc.intersect(&ray),
            PlainForm::Cylinder(cylinder) => cylinder.intersect(&ray),
            PlainForm::Cone(cone) => cone.intersect(&ray),
            PlainForm::Torus(torus) => torus.intersect(&ray),
            PlainForm::Instance(instance) => return instance.intersect(&ray, t_max),
        };
        hit.map(|(t, prim_id)| (t.wide(), prim_id))
    }

    /// The point on the ray; new rays start at the point itself.
    fn interaction(&self, ray: &Ray, t: f64, prim_id: u32) -> Interaction {
        let ray = PlainRay::<R>::of(ray);
        let point = ray.at(R::of(t));
        let normal = self.form.normal(&ray, point, prim_id).wide();
        Interaction {
            point: point.wide(),
            normal,
            offset: 0.0,
            back: Vec3::ZERO,
        }
    }

    fn has_uv(&self) -> bool {
        self.robust.has_uv()
    }

    fn has_shading_normals(&self) -> bool {
        self.robust.has_shading_normals()
    }

    fn details(&self, ray: &Ray, at: &Interaction, prim_id: u32, asked: Asked) -> Details {
        self.robust.details(ray, at, prim_id, asked)
    }

    fn bounds(&self) -> Option<Bounds> {
        self.robust.bounds()
    }
}
