//! Where a scene is: a ball around all of it that has an end. Its middle is what cameras without a
//! target look at.

use super::{
    Column, Cone, Cylinder, Disc, Instance, Plane, Quad, Scene, Shape, Sphere, Torus, Triangle,
};
use crate::math::{Vec3, unit};
use glam::DAffine3;

/// A ball.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ball {
    /// The middle.
    pub center: Vec3,
    /// The radius, above 0.
    pub radius: f64,
}

impl Scene {
    /// A ball around all shapes but planes: its middle is that of the box around them. `None` if
    /// there is nothing that has an end, and an extent.
    #[must_use]
    pub fn ball(&self) -> Option<Ball> {
        let boxes: Vec<[Vec3; 2]> = self
            .meshes
            .iter()
            .map(|mesh| around(&mesh.positions))
            .collect();
        let each = |visit: &mut dyn FnMut(Vec3)| {
            self.surfaces
                .iter()
                .for_each(|surface| corners(&surface.shape, &boxes, visit));
        };
        let (mut low, mut high) = (Vec3::INFINITY, Vec3::NEG_INFINITY);
        each(&mut |corner| (low, high) = (low.min(corner), high.max(corner)));
        let center = low + (high - low) / 2.0;
        let mut square = 0.0_f64;
        each(&mut |corner| square = square.max(corner.distance_squared(center)));
        let ball = Ball {
            center,
            radius: square.sqrt(),
        };
        (center.is_finite() && ball.radius.is_finite() && ball.radius > 0.0).then_some(ball)
    }
}

/// The box around some points, empty if there are none.
fn around(points: &Column<3>) -> [Vec3; 2] {
    let points = || points.iter().map(Vec3::from_array);
    [
        points().fold(Vec3::INFINITY, Vec3::min),
        points().fold(Vec3::NEG_INFINITY, Vec3::max),
    ]
}

/// Visits points whose hull holds the shape; none for a plane or an empty mesh.
fn corners(shape: &Shape, boxes: &[[Vec3; 2]], visit: &mut dyn FnMut(Vec3)) {
    let mut cube = |center: [f64; 3], half: f64| {
        let center = Vec3::from_array(center);
        box_corners([center - half, center + half])
            .into_iter()
            .for_each(&mut *visit);
    };
    match shape {
        Shape::Plane(Plane {
            center: _,
            normal: _,
        }) => {}
        Shape::Sphere(Sphere {
            center,
            radius,
            texture_from_world: _,
        }) => cube(*center, *radius),
        Shape::Disc(Disc {
            center,
            normal: _,
            radius,
        }) => cube(*center, *radius),
        Shape::Torus(Torus {
            center,
            axis: _,
            major,
            minor,
        }) => cube(*center, major + minor),
        Shape::Triangle(Triangle { vertices, uvs: _ }) => {
            vertices.iter().for_each(|v| visit(Vec3::from_array(*v)))
        }
        Shape::Quad(Quad { vertices }) => vertices.iter().for_each(|v| visit(Vec3::from_array(*v))),
        Shape::Cylinder(Cylinder {
            base,
            axis,
            height,
            radius,
        }) => {
            let top = Vec3::from_array(*base)
                + unit(Vec3::from_array(*axis)).unwrap_or(Vec3::ZERO) * *height;
            cube(*base, *radius);
            cube(top.to_array(), *radius);
        }
        Shape::Cone(Cone { base, up, radius }) => {
            cube(*base, *radius);
            visit(Vec3::from_array(*base) + Vec3::from_array(*up));
        }
        Shape::Instance(instance) => placed_corners(instance, boxes)
            .into_iter()
            .flatten()
            .for_each(visit),
    }
}

/// The corners of the box around the mesh of an instance, in the world; none if it is empty.
fn placed_corners(instance: &Instance, boxes: &[[Vec3; 2]]) -> Option<[Vec3; 8]> {
    let Instance {
        mesh,
        world_from_object,
    } = instance;
    let around = boxes
        .get(mesh.0 as usize)
        .filter(|[low, _]| low.is_finite())?;
    let world = DAffine3::from_cols_array_2d(world_from_object);
    Some(box_corners(*around).map(|corner| world.transform_point3(corner)))
}

fn box_corners([low, high]: [Vec3; 2]) -> [Vec3; 8] {
    std::array::from_fn(|corner| {
        let pick = |bit: usize| {
            if corner >> bit & 1 == 0 {
                low[bit]
            } else {
                high[bit]
            }
        };
        Vec3::new(pick(0), pick(1), pick(2))
    })
}
