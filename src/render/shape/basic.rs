//! The shapes of most course scenes alone: an integrator of these holds no code of the others.

use crate::math::Vec3;
use crate::render::accel::bounds::Bounds;
use crate::render::ray::{Interaction, Ray};
use crate::render::shape::geometry::Geometry;
use crate::render::shape::instance::{Asked, Details};
use crate::render::shape::plane::Plane;
use crate::render::shape::sphere::Sphere;
use crate::render::shape::tie;
use crate::render::shape::triangle::{Shear, Triangle};
use crate::render::shape::{sphere_details, triangle_details};

/// A sphere, a plane or a triangle.
#[derive(Clone, Debug)]
pub enum Basic {
    /// See [`Shape::Sphere`](super::Shape::Sphere).
    Sphere(Sphere, [Vec3; 3]),
    /// See [`Shape::Plane`](super::Shape::Plane).
    Plane(Plane),
    /// See [`Shape::Triangle`](super::Shape::Triangle).
    Triangle(Triangle, Option<[[f64; 2]; 3]>),
}

impl Geometry for Basic {
    #[inline]
    fn intersect(&self, ray: &Ray, shear: &Shear, _t_max: f64) -> Option<(f64, u32)> {
        let t = match self {
            Self::Sphere(sphere, _) => sphere.intersect(ray),
            Self::Plane(plane) => plane.intersect(ray),
            Self::Triangle(triangle, _) => triangle.intersect(ray, shear),
        };
        t.map(|t| (t, 0))
    }

    fn error(&self, ray: &Ray, t: f64, prim_id: u32) -> f64 {
        tie::error(ray, t, &self.interaction(ray, t, prim_id))
    }

    fn interaction(&self, ray: &Ray, t: f64, _prim_id: u32) -> Interaction {
        match self {
            Self::Sphere(sphere, _) => sphere.interaction(ray, t),
            Self::Plane(plane) => plane.interaction(ray, t),
            Self::Triangle(triangle, _) => triangle.interaction(ray, t),
        }
    }

    fn has_uv(&self) -> bool {
        match self {
            Self::Sphere(..) => true,
            Self::Triangle(_, uvs) => uvs.is_some(),
            Self::Plane(_) => false,
        }
    }

    fn has_shading_normals(&self) -> bool {
        false
    }

    fn details(&self, _ray: &Ray, at: &Interaction, _prim_id: u32, _asked: Asked) -> Details {
        match self {
            Self::Sphere(_, rows) => sphere_details(*rows, at.normal),
            Self::Triangle(triangle, Some(uvs)) => triangle_details(triangle, *uvs, at),
            Self::Triangle(_, None) | Self::Plane(_) => Details::default(),
        }
    }

    fn triangles(&self) -> usize {
        usize::from(matches!(self, Self::Triangle(..)))
    }

    fn corners(&self, _prim_id: u32) -> Option<[Vec3; 3]> {
        if let Self::Triangle(triangle, _) = self {
            Some(*triangle.vertices())
        } else {
            None
        }
    }

    fn bounds(&self) -> Option<Bounds> {
        match self {
            Self::Sphere(sphere, _) => Some(Bounds::around(sphere.center, sphere.radius)),
            Self::Plane(_) => None,
            Self::Triangle(triangle, _) => Some(Bounds::of(triangle.vertices())),
        }
    }
}
