//! The shapes of most course scenes: an integrator over these contains no code for the others.

use super::kinds::{Plane, Sphere, Triangle};
use crate::accel::bounds::BoundingSphere;
use crate::ray::{Interaction, Ray};
use crate::shape::emitter::{Emitter, FaceEmitter};
use crate::shape::four::Shape4;
use crate::shape::geometry::{AttributeRequest, Intersect, LocalRay, ShadingAttributes};
use crate::shape::normal_field::NormalField;
use crate::shape::tie;
use crate::shape::triangle::WatertightRay;
use rtc_math::{Bounds, Vec3};

/// A sphere, a plane or a triangle.
#[derive(Clone, Debug)]
pub enum BasicShape {
    /// See [`Shape::Sphere`](super::Shape::Sphere).
    Sphere(Sphere),
    /// See [`Shape::Plane`](super::Shape::Plane).
    Plane(Plane),
    /// See [`Shape::Triangle`](super::Shape::Triangle).
    Triangle(Triangle),
}

dispatch!(BasicShape { Sphere Plane Triangle });
