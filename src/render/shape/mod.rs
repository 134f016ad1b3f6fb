//! A shape of any kind, ready to be hit.

pub(in crate::render) mod basic;
pub(in crate::render) mod cone;
pub(in crate::render) mod cylinder;
pub(in crate::render) mod disc;
pub(in crate::render) mod geometry;
pub(in crate::render) mod instance;
pub(in crate::render) mod interval;
pub(in crate::render) mod mesh;
pub(in crate::render) mod plain;
pub(in crate::render) mod plane;
pub(in crate::render) mod quad;
pub(in crate::render) mod sphere;
pub(in crate::render) mod tie;
pub(in crate::render) mod torus;
pub(in crate::render) mod triangle;

use crate::math::{Vec3, acos, atan2};
use crate::render::accel::bounds::Bounds;
use crate::render::ray::{Interaction, Ray};
use crate::render::shape::cone::Cone;
use crate::render::shape::cylinder::Cylinder;
use crate::render::shape::disc::Disc;
use crate::render::shape::geometry::Geometry;
use crate::render::shape::instance::{Asked, Details, Instance, interpolate};
use crate::render::shape::plane::Plane;
use crate::render::shape::quad::Quad;
use crate::render::shape::sphere::Sphere;
use crate::render::shape::torus::Torus;
use crate::render::shape::triangle::{Shear, Triangle};
use std::f64::consts::{PI, TAU};

/// A shape ready to be hit.
#[derive(Clone, Debug)]
pub enum Shape {
    /// A sphere, and the rows of the rotation to the directions of its texture.
    Sphere(Sphere, [Vec3; 3]),
    /// An infinite plane.
    Plane(Plane),
    /// A triangle, and the texture coordinates of its corners.
    Triangle(Triangle, Option<[[f64; 2]; 3]>),
    /// A quadrilateral.
    Quad(Box<Quad>),
    /// A disc.
    Disc(Disc),
    /// A cylinder.
    Cylinder(Cylinder),
    /// A cone.
    Cone(Cone),
    /// A torus.
    Torus(Torus),
    /// A mesh, placed.
    Instance(Box<Instance>),
}

impl Geometry for Shape {
    #[inline]
    fn intersect(&self, ray: &Ray, shear: &Shear, t_max: f64) -> Option<(f64, u32)> {
        let whole = |t: Option<f64>| t.map(|t| (t, 0));
        match self {
            Self::Sphere(sphere, _) => whole(sphere.intersect(ray)),
            Self::Plane(plane) => whole(plane.intersect(ray)),
            Self::Triangle(triangle, _) => whole(triangle.intersect(ray, shear)),
            Self::Quad(quad) => quad.intersect(ray, shear),
            Self::Disc(disc) => whole(disc.intersect(ray)),
            Self::Cylinder(cylinder) => whole(cylinder.intersect(ray)),
            Self::Cone(cone) => whole(cone.intersect(ray)),
            Self::Torus(torus) => whole(torus.intersect(ray)),
            Self::Instance(instance) => instance.intersect(ray, t_max),
        }
    }

    #[inline]
    fn closest_hit(&self, ray: &Ray, shear: &Shear, t_max: f64) -> Option<(f64, u32)> {
        if let Self::Instance(instance) = self {
            instance.closest_hit(ray, t_max)
        } else {
            self.intersect(ray, shear, t_max)
        }
    }

    fn visit_roots(&self, ray: &Ray, shear: &Shear, t_max: f64, visit: &mut dyn FnMut(f64, u32)) {
        if let Self::Instance(instance) = self {
            instance.visit_roots(ray, t_max, visit);
        } else if let Some((t, prim_id)) = self.intersect(ray, shear, t_max) {
            visit(t, prim_id);
        }
    }

    fn error(&self, ray: &Ray, t: f64, prim_id: u32) -> f64 {
        tie::error(ray, t, &self.interaction(ray, t, prim_id))
    }

    fn interaction(&self, ray: &Ray, t: f64, prim_id: u32) -> Interaction {
        match self {
            Self::Sphere(sphere, _) => sphere.interaction(ray, t),
            Self::Plane(plane) => plane.interaction(ray, t),
            Self::Triangle(triangle, _) => triangle.interaction(ray, t),
            Self::Quad(quad) => quad.interaction(ray, t, prim_id),
            Self::Disc(disc) => disc.interaction(ray, t),
            Self::Cylinder(cylinder) => cylinder.interaction(ray, t),
            Self::Cone(cone) => cone.interaction(ray, t),
            Self::Torus(torus) => torus.interaction(ray, t),
            Self::Instance(instance) => instance.interaction(ray, t, prim_id),
        }
    }

    fn has_uv(&self) -> bool {
        match self {
            Self::Sphere(..) | Self::Quad(_) => true,
            Self::Triangle(_, uvs) => uvs.is_some(),
            Self::Instance(instance) => instance.has_uv(),
            Self::Plane(_) | Self::Disc(_) | Self::Cylinder(_) | Self::Cone(_) | Self::Torus(_) => {
                false
            }
        }
    }

    fn has_shading_normals(&self) -> bool {
        match self {
            Self::Instance(instance) => instance.has_shading_normals(),
            Self::Sphere(..)
            | Self::Plane(_)
            | Self::Triangle(..)
            | Self::Quad(_)
            | Self::Disc(_)
            | Self::Cylinder(_)
            | Self::Cone(_)
            | Self::Torus(_) => false,
        }
    }

    fn details(&self, ray: &Ray, at: &Interaction, prim_id: u32, asked: Asked) -> Details {
        match self {
            Self::Sphere(_, rows) => sphere_details(*rows, at.normal),
            Self::Triangle(triangle, Some(uvs)) => triangle_details(triangle, *uvs, at),
            Self::Quad(quad) => {
                let [u, v] = quad.uv(ray, at.point, prim_id);
                Details {
                    uv: Some([u, v]),
                    tangent: quad.tangent(v),
                    ..Details::default()
                }
            }
            Self::Instance(instance) => instance.details(at.point, prim_id, asked),
            Self::Triangle(_, None)
            | Self::Plane(_)
            | Self::Disc(_)
            | Self::Cylinder(_)
            | Self::Cone(_)
            | Self::Torus(_) => Details::default(),
        }
    }

    fn triangles(&self) -> usize {
        match self {
            Self::Triangle(..) => 1,
            Self::Instance(instance) => instance.triangles(),
            Self::Sphere(..)
            | Self::Plane(_)
            | Self::Quad(_)
            | Self::Disc(_)
            | Self::Cylinder(_)
            | Self::Cone(_)
            | Self::Torus(_) => 0,
        }
    }

    fn corners(&self, prim_id: u32) -> Option<[Vec3; 3]> {
        match self {
            Self::Triangle(triangle, _) => Some(*triangle.vertices()),
            Self::Instance(instance) => Some(instance.corners(prim_id)),
            Self::Sphere(..)
            | Self::Plane(_)
            | Self::Quad(_)
            | Self::Disc(_)
            | Self::Cylinder(_)
            | Self::Cone(_)
            | Self::Torus(_) => None,
        }
    }

    fn error_bound(&self) -> f64 {
        if let Self::Instance(instance) = self {
            instance.error_bound()
        } else {
            0.0
        }
    }

    #[inline]
    fn intersect_prim(&self, ray: &Ray, prim_id: u32) -> Option<f64> {
        if let Self::Instance(instance) = self {
            instance.intersect_prim(ray, prim_id)
        } else {
            None
        }
    }

    fn bounds(&self) -> Option<Bounds> {
        match self {
            Self::Sphere(sphere, _) => Some(Bounds::around(sphere.center, sphere.radius)),
            Self::Plane(_) => None,
            Self::Triangle(triangle, _) => Some(Bounds::of(triangle.vertices())),
            Self::Quad(quad) => Some(quad.bounds()),
            Self::Disc(disc) => Some(disc.bounds()),
            Self::Cylinder(cylinder) => Some(cylinder.bounds()),
            Self::Cone(cone) => Some(cone.bounds()),
            Self::Torus(torus) => Some(torus.bounds()),
            Self::Instance(instance) => Some(instance.bounds()),
        }
    }
}

/// u = φ/2π and v = 1 − θ/π of the direction from the centre, turned by the rotation of the
/// texture.
pub(in crate::render) fn sphere_details([x, y, z]: [Vec3; 3], direction: Vec3) -> Details {
    let d = Vec3::new(x.dot(direction), y.dot(direction), z.dot(direction));
    let turns = atan2(d.y, d.x) / TAU;
    let u = if turns < 0.0 { turns + 1.0 } else { turns };
    let v = 1.0 - acos(d.z.clamp(-1.0, 1.0)) / PI;
    let tangent = (y * d.x - x * d.y).try_normalize();
    Details {
        uv: Some([u, v]),
        tangent,
        ..Details::default()
    }
}

/// uv between those of the corners.
pub(in crate::render) fn triangle_details(
    triangle: &Triangle,
    uvs: [[f64; 2]; 3],
    at: &Interaction,
) -> Details {
    let uv = Some(interpolate(uvs, triangle.weights(at.point)));
    Details {
        uv,
        tangent: triangle.tangent(uvs),
        ..Details::default()
    }
}
