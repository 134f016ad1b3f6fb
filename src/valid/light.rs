//! The proof of the lights.

use super::check::{Check, place};
use crate::diag::Diagnostic;
use crate::diag::codes;
use crate::ir::{self, Field, Noun};
use crate::math::{NonNegative, Vec3};

/// A point light, or with a radius a soft one.
#[derive(Clone, Copy, Debug)]
pub struct Light {
    /// Where it stands.
    pub position: Vec3,
    /// Its colour, each channel at least 0.
    pub color: Vec3,
    /// Its radius; 0 for a point.
    pub radius: NonNegative,
}

pub(super) fn light(light: &ir::Light, index: usize, check: &mut Check<'_>) -> Option<Light> {
    let ir::Light::Point(ir::PointLight { position, color, radius }) = light;
    let position = check.vector(*position, place(Noun::Light, index, Field::Position));
    let color = check.color(*color, place(Noun::Light, index, Field::Color));
    let radius = check.non_negative(*radius, "radius", place(Noun::Light, index, Field::LightRadius));
    Some(Light { position: position?, color: color?, radius: radius? })
}

/// No more notes than this: a file of many lights and spheres is not worth a quadratic search for advice.
const MAX_PAIRS: usize = 1_000_000;

/// Notes each light that stands inside a sphere, where shadows hide it from all outside.
pub(super) fn lights_inside_spheres(scene: &ir::Scene, check: &mut Check<'_>) {
    if !scene.settings.shadows || scene.lights.len().saturating_mul(scene.surfaces.len()) > MAX_PAIRS {
        return;
    }
    for (index, ir::Light::Point(light)) in scene.lights.iter().enumerate() {
        let inside = scene.surfaces.iter().position(|surface| match &surface.shape {
            ir::Shape::Sphere(ir::Sphere { center, radius, texture_from_world: _ }) => {
                Vec3::from_array(light.position).distance(Vec3::from_array(*center)) < *radius
            }
            ir::Shape::Plane(_)
            | ir::Shape::Triangle(_)
            | ir::Shape::Quad(_)
            | ir::Shape::Disc(_)
            | ir::Shape::Cylinder(_)
            | ir::Shape::Cone(_)
            | ir::Shape::Torus(_)
            | ir::Shape::Instance(_) => false,
        });
        if let Some(sphere) = inside {
            let finding = Diagnostic::new(&codes::LIGHT_IN_SPHERE, "a light stands inside a sphere");
            let finding = finding.also(check.span(place(Noun::Surface, sphere, Field::Whole)), "this sphere");
            check.report(
                place(Noun::Light, index, Field::Position),
                "with shadows on, nothing outside the sphere sees this light",
                finding,
            );
        }
    }
}
