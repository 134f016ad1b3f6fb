//! The shapes of most course scenes alone: an integrator of these holds no code of the others.

use super::kinds::{Plane, Sphere, Triangle};
use crate::math::{Bounds, Vec3};
use crate::render::accel::bounds::Ball;
use crate::render::ray::{Interaction, Ray};
use crate::render::shape::four::InLanes;
use crate::render::shape::geometry::{Asked, Details, Geometry, LocalRay};
use crate::render::shape::tie;
use crate::render::shape::triangle::Shear;

/// A sphere, a plane or a triangle.
#[derive(Clone, Debug)]
pub enum Basic {
    /// See [`Shape::Sphere`](super::Shape::Sphere).
    Sphere(Sphere),
    /// See [`Shape::Plane`](super::Shape::Plane).
    Plane(Plane),
    /// See [`Shape::Triangle`](super::Shape::Triangle).
    Triangle(Triangle),
}

dispatch!(Basic { Sphere Plane Triangle });
