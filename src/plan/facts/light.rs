//! Lights as each integrator sees them: those of the course by Whitted's, physical ones by paths.

use crate::valid::{CourseLight, Falloff, Light, PointLight, Punctual};
use std::f64::consts::PI;

/// The lights that Whitted's integrator sees: those of the course, in the order of the scene.
#[must_use]
pub fn course(lights: &[Light]) -> Vec<CourseLight> {
    let course = |light: &Light| match light {
        Light::Course(light) => Some(*light),
        Light::Punctual(_) => None,
    };
    lights.iter().filter_map(course).collect()
}

/// The lights that the path integrator sees: all, and of one of the course a white Lambert surface
/// that faces it has the radiance of its colour.
#[must_use]
pub fn punctual(lights: &[Light]) -> Vec<Punctual> {
    let physical = |light: &Light| match light {
        Light::Punctual(light) => *light,
        Light::Course(light) => Punctual::Point(PointLight {
            position: light.position,
            intensity: light.color * PI,
            falloff: Falloff::None,
        }),
    };
    lights.iter().map(physical).collect()
}
