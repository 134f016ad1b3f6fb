//! The shapes. Each file has the robust intersection of one shape and its textbook baseline.
//!
//! - [`geometry`]: the trait [`geometry::Intersect`] that every shape implements.
//! - [`tie`]: the choice between hits that coincide within their rounding errors.
//! - [`interval`]: convex regions as intervals of t, for capped solids.
//! - [`baseline`]: the textbook formulas in f64 and f32. [`four`]: four rays at once.
//!
//! A robust intersection bounds its rounding error. If the error leaves a decision in doubt, it
//! repeats the computation in double-double arithmetic.

/// Forwards the methods of an enum of shapes to its shape.
macro_rules! dispatch {
    ($Enum:ident { $($Name:ident)* }) => {
        impl Intersect for $Enum {
            const HAS_SHAPE4: bool = true;

            #[inline]
            fn intersect(
                &self,
                ray: &Ray,
                watertight: &WatertightRay,
                t_max: f64,
            ) -> Option<(f64, u32)> {
                match self {
                    $(Self::$Name(shape) => <$Name as Intersect>::intersect(shape, ray, watertight, t_max),)*
                }
            }

            fn uses_watertight_ray(&self) -> bool {
                match self {
                    $(Self::$Name(shape) => <$Name as Intersect>::uses_watertight_ray(shape),)*
                }
            }

            #[inline]
            fn closest_hit(
                &self,
                ray: &Ray,
                watertight: &WatertightRay,
                t_max: f64,
            ) -> Option<(f64, u32)> {
                match self {
                    $(Self::$Name(shape) => <$Name as Intersect>::closest_hit(shape, ray, watertight, t_max),)*
                }
            }

            fn visit_roots(
                &self,
                ray: &Ray,
                watertight: &WatertightRay,
                t_max: f64,
                visit: &mut dyn FnMut(f64, u32),
            ) {
                match self {
                    $(Self::$Name(shape) => <$Name as Intersect>::visit_roots(shape, ray, watertight, t_max, visit),)*
                }
            }

            fn visit_crossings(
                &self,
                ray: &Ray,
                visit: &mut dyn FnMut($crate::shape::geometry::SolidCrossing),
            ) {
                match self {
                    $(Self::$Name(shape) => <$Name as Intersect>::visit_crossings(shape, ray, visit),)*
                }
            }

            fn interaction_on(&self, ray: &Ray, t: f64, part: u32) -> Interaction {
                match self {
                    $(Self::$Name(shape) => <$Name as Intersect>::interaction_on(shape, ray, t, part),)*
                }
            }

            fn error(&self, ray: &Ray, t: f64, prim_id: u32) -> f64 {
                tie::error(ray, t, &self.interaction(ray, t, prim_id))
            }

            #[inline]
            fn interaction(&self, ray: &Ray, t: f64, prim_id: u32) -> Interaction {
                match self {
                    $(Self::$Name(shape) => <$Name as Intersect>::interaction(shape, ray, t, prim_id),)*
                }
            }

            fn has_shading_normals(&self) -> bool {
                match self {
                    $(Self::$Name(shape) => <$Name as Intersect>::has_shading_normals(shape),)*
                }
            }

            fn shading_attributes(
                &self,
                ray: &Ray,
                at: &Interaction,
                prim_id: u32,
                request: AttributeRequest,
            ) -> ShadingAttributes {
                match self {
                    $(Self::$Name(shape) => {
                        <$Name as Intersect>::shading_attributes(shape, ray, at, prim_id, request)
                    })*
                }
            }

            fn uv_derivatives(
                &self,
                ray: &Ray,
                at: &Interaction,
                prim_id: u32,
                set: usize,
            ) -> Option<[Vec3; 2]> {
                match self {
                    $(Self::$Name(shape) => {
                        <$Name as Intersect>::uv_derivatives(shape, ray, at, prim_id, set)
                    })*
                }
            }

            fn triangles(&self) -> usize {
                match self {
                    $(Self::$Name(shape) => <$Name as Intersect>::triangles(shape),)*
                }
            }

            fn corners(&self, prim_id: u32) -> Option<[Vec3; 3]> {
                match self {
                    $(Self::$Name(shape) => <$Name as Intersect>::corners(shape, prim_id),)*
                }
            }

            fn emitter(&self) -> Option<Emitter> {
                match self {
                    $(Self::$Name(shape) => <$Name as Intersect>::emitter(shape),)*
                }
            }

            fn face_emitters(&self) -> Vec<FaceEmitter> {
                match self {
                    $(Self::$Name(shape) => <$Name as Intersect>::face_emitters(shape),)*
                }
            }

            fn face(&self, prim_id: u32, normal: Vec3) -> (u32, Vec3) {
                match self {
                    $(Self::$Name(shape) => <$Name as Intersect>::face(shape, prim_id, normal),)*
                }
            }

            fn normal_field(&self) -> Option<NormalField<'_>> {
                match self {
                    $(Self::$Name(shape) => <$Name as Intersect>::normal_field(shape),)*
                }
            }

            fn error_bound(&self) -> f64 {
                match self {
                    $(Self::$Name(shape) => <$Name as Intersect>::error_bound(shape),)*
                }
            }

            #[inline]
            fn local(&self, ray: &Ray) -> LocalRay {
                match self {
                    $(Self::$Name(shape) => <$Name as Intersect>::local(shape, ray),)*
                }
            }

            #[inline]
            fn intersect_prim(&self, ray: &LocalRay, prim_id: u32) -> Option<f64> {
                match self {
                    $(Self::$Name(shape) => <$Name as Intersect>::intersect_prim(shape, ray, prim_id),)*
                }
            }

            #[inline]
            fn intersect_prim_before(
                &self,
                ray: &LocalRay,
                prim_id: u32,
                t_max: f64,
            ) -> Option<f64> {
                match self {
                    $(Self::$Name(shape) => <$Name as Intersect>::intersect_prim_before(shape, ray, prim_id, t_max),)*
                }
            }

            fn is_in_place(&self) -> bool {
                match self {
                    $(Self::$Name(shape) => <$Name as Intersect>::is_in_place(shape),)*
                }
            }

            fn bounds(&self) -> Option<Bounds> {
                match self {
                    $(Self::$Name(shape) => <$Name as Intersect>::bounds(shape),)*
                }
            }

            #[inline(always)]
            fn shape4(&self) -> Option<Shape4<'_>> {
                match self {
                    $(Self::$Name(shape) => <$Name as Intersect>::shape4(shape),)*
                }
            }

            fn ball(&self) -> Option<BoundingSphere> {
                match self {
                    $(Self::$Name(shape) => <$Name as Intersect>::ball(shape),)*
                }
            }
        }
    };
}

/// The shapes of plain arithmetic. Studies alone compare arithmetics, and a page has none, so it
/// downloads the robust shapes only.
#[cfg(not(target_family = "wasm"))]
pub(crate) type PlainShape = baseline::BaselineShape<f64>;
#[cfg(target_family = "wasm")]
pub(crate) type PlainShape = Shape;

/// The same in f32.
#[cfg(not(target_family = "wasm"))]
pub(crate) type PlainShapeF32 = baseline::BaselineShape<f32>;
#[cfg(target_family = "wasm")]
pub(crate) type PlainShapeF32 = Shape;

pub(crate) mod baseline;
pub(crate) mod basic;
pub(crate) mod cone;
mod corners;
pub(crate) mod csg;
pub(crate) mod cylinder;
pub(crate) mod disc;
pub(crate) mod ellipsoid;
pub(crate) mod emitter;
#[cfg_attr(
    not(target_arch = "x86_64"),
    allow(dead_code, reason = "lanes gain with AVX-512 alone")
)]
pub(crate) mod four;
pub(crate) mod geometry;
pub(crate) mod instance;
pub(crate) mod interval;
pub(crate) mod mesh;
pub(crate) mod normal_field;
pub(crate) mod paraboloid;
pub(crate) mod plane;
pub(crate) mod quad;
pub(crate) mod sphere;
#[cfg(test)]
mod surface_eyes;
pub(crate) mod tie;
pub(crate) mod torus;
pub(crate) mod triangle;

/// The type of each kind of shape, by the name of the kind.
pub(crate) mod kinds {
    pub(crate) use super::cone::Cone;
    pub(crate) use super::csg::Csg;
    pub(crate) use super::cylinder::{Cylinder, InfiniteCylinder};
    pub(crate) use super::disc::Disc;
    pub(crate) use super::ellipsoid::Ellipsoid;
    pub(crate) use super::instance::Instance;
    pub(crate) use super::paraboloid::Paraboloid;
    pub(crate) use super::plane::Plane;
    pub(crate) use super::quad::Quad;
    pub(crate) use super::sphere::TexturedSphere as Sphere;
    pub(crate) use super::torus::Torus;
    pub(crate) use super::triangle::TexturedTriangle as Triangle;
}

use crate::accel::bounds::BoundingSphere;
use crate::ray::{Interaction, Ray};
use crate::shape::baseline::ray::BaselineRay;
use crate::shape::baseline::real::Real;
use crate::shape::baseline::{Baseline, HasBaseline, baselines};
use crate::shape::emitter::{Emitter, FaceEmitter};
use crate::shape::four::Shape4;
use crate::shape::geometry::{AttributeRequest, Intersect, LocalRay, ShadingAttributes};
use crate::shape::mesh::BaselineMesh;
use crate::shape::normal_field::NormalField;
use crate::shape::triangle::WatertightRay;
use kinds::*;
use rtc_math::{Bounds, Vec3, Vector};
use std::sync::Arc;

/// A shape ready to be hit.
#[derive(Clone, Debug)]
pub enum Shape {
    /// A sphere.
    Sphere(Sphere),
    /// An infinite plane.
    Plane(Plane),
    /// A triangle.
    Triangle(Triangle),
    /// A quadrilateral.
    Quad(Box<Quad>),
    /// A disc.
    Disc(Disc),
    /// A cylinder with two caps.
    Cylinder(Cylinder),
    /// A cone with a cap at its base.
    Cone(Cone),
    /// A paraboloid with a cap at its base.
    Paraboloid(Paraboloid),
    /// A torus.
    Torus(Torus),
    /// A mesh, placed.
    Instance(Box<Instance>),
    /// An ellipsoid.
    Ellipsoid(Box<Ellipsoid>),
    /// A cylinder without ends.
    InfiniteCylinder(InfiniteCylinder),
    /// A CSG solid.
    Csg(Box<Csg>),
}

dispatch!(Shape {
    Sphere Plane Triangle Quad Disc Cylinder Cone Paraboloid Torus Instance Ellipsoid
    InfiniteCylinder Csg
});

baselines! {
    Sphere Plane Triangle Quad Disc Cylinder Cone Paraboloid Torus Instance Ellipsoid
    InfiniteCylinder Csg
}

const _: () = assert!(size_of::<Shape>() == 192, "memory is what rays wait for");
