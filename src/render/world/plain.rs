//! The plain twins of the shapes of a world: how each kind is made of a proven one.

use super::shape::Prepare;
use crate::math::unit;
use crate::render::shape::Shape;
use crate::render::shape::plain::cone::Cone;
use crate::render::shape::plain::cylinder::Cylinder;
use crate::render::shape::plain::instance::{Instance, Mesh};
use crate::render::shape::plain::plane::{Disc, Plane};
use crate::render::shape::plain::quad::Quad;
use crate::render::shape::plain::real::{Real, Vector};
use crate::render::shape::plain::sphere::Sphere;
use crate::render::shape::plain::torus::Torus;
use crate::render::shape::plain::triangle::Triangle;
use crate::render::shape::plain::{PlainForm, PlainShape};
use crate::valid;
use std::sync::Arc;

impl<R: Real> Prepare for PlainShape<R> {
    type Mesh = Mesh<R>;

    fn prepare_mesh(mesh: &valid::Mesh) -> Mesh<R> {
        Mesh::new(Shape::prepare_mesh(mesh))
    }

    fn prepare(shape: &valid::Shape, meshes: &[Arc<Mesh<R>>]) -> Option<Self> {
        let robust_mesh = |mesh: &Arc<Mesh<R>>| Arc::clone(&mesh.robust);
        let robust = Shape::prepare(shape, &meshes.iter().map(robust_mesh).collect::<Vec<_>>())?;
        Some(Self {
            form: form(shape, &robust, meshes)?,
            robust: Box::new(robust),
        })
    }
}

fn form<R: Real>(
    shape: &valid::Shape,
    robust: &Shape,
    meshes: &[Arc<Mesh<R>>],
) -> Option<PlainForm<R>> {
    Some(match (shape, robust) {
        (valid::Shape::Sphere(sphere), _) => PlainForm::Sphere(Sphere {
            center: Vector::of(sphere.center),
            radius: R::of(sphere.radius.get()),
        }),
        (valid::Shape::Plane(plane), Shape::Plane(robust)) => {
            PlainForm::Plane(Plane::new(plane.center, robust.normal()))
        }
        (valid::Shape::Triangle(triangle), _) => {
            PlainForm::Triangle(Triangle::new(&triangle.vertices))
        }
        (valid::Shape::Quad(quad), Shape::Quad(robust)) => {
            PlainForm::Quad(Box::new(Quad::new(robust, quad.vertices)))
        }
        (valid::Shape::Disc(disc), _) => {
            let normal = unit(disc.normal)?;
            PlainForm::Disc(Disc::new(disc.center, normal, disc.radius.get()))
        }
        (valid::Shape::Cylinder(cylinder), _) => {
            let (height, radius) = (cylinder.height.get(), cylinder.radius.get());
            let axis = unit(cylinder.axis)?;
            PlainForm::Cylinder(Box::new(Cylinder::new(cylinder.base, axis, height, radius)))
        }
        (valid::Shape::Cone(cone), _) => {
            PlainForm::Cone(Box::new(Cone::new(cone.base, cone.up, cone.radius.get())))
        }
        (valid::Shape::Torus(torus), _) => PlainForm::Torus(Torus {
            center: Vector::of(torus.center),
            axis: Vector::of(unit(torus.axis)?),
            major: R::of(torus.major.get()),
            minor: R::of(torus.minor.get()),
        }),
        (valid::Shape::Instance(instance), Shape::Instance(robust)) => {
            let (mesh, origin) = (&meshes[instance.mesh], instance.world_from_object[3]);
            PlainForm::Instance(Box::new(Instance::new(mesh, robust, origin)))
        }
        (valid::Shape::Plane(_) | valid::Shape::Quad(_) | valid::Shape::Instance(_), _) => {
            return None;
        }
    })
}
