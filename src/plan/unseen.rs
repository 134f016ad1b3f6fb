//! The surfaces that no ray of any pixel meets, by their bounds: what is not among them may be
//! hidden too, but what is among them is never seen.

use super::body::{Body, Extent, bodies};
use super::findings::is_pinhole;
use super::window::{Shown, Window};
use super::{Plan, Rules};
use rtc_valid::{Material, Mode, Projection, ValidScene};

/// The maximum number of pairs of a surface outside the picture and any other, for which shadows
/// and mirrors are looked at.
const MAX_PAIRS: usize = 20_000;

/// The surfaces that no ray of any pixel meets, by their indices in the IR, in ascending order.
///
/// Traced paths may meet anything, and for an orthographic camera nothing is proven.
#[must_use]
pub fn unseen(scene: &ValidScene) -> Vec<usize> {
    let is_perspective = matches!(scene.camera().projection, Projection::Perspective);
    if matches!(scene.settings().mode, Mode::Path(_)) || !is_perspective {
        return Vec::new();
    }
    let window = Window::new(scene.camera(), is_pinhole(scene));
    let is_outside = |body: &Body| match &body.extent {
        Extent::Plane(plane) => window.is_behind(plane),
        Extent::Within(_) | Extent::Anywhere => window.shown(body) == Shown::Nowhere,
    };
    let bodies = bodies(scene);
    let mut outside: Vec<usize> = (0..bodies.len())
        .filter(|surface| is_outside(&bodies[*surface]))
        .collect();
    if !outside.is_empty() && has_secondary_rays(scene) {
        if outside.len().saturating_mul(bodies.len()) > MAX_PAIRS {
            return Vec::new();
        }
        let plan = Plan::new(scene, Rules::ALL);
        outside.retain(|surface| !plan.surfaces[*surface]);
    }
    let index = |surface: usize| scene.surfaces()[surface].index;
    outside.into_iter().map(index).collect()
}

/// Whether rays start on surfaces: to lights, or into mirrors and glass.
fn has_secondary_rays(scene: &ValidScene) -> bool {
    let settings = scene.settings();
    let bounces = |material: &Material| match material {
        Material::Phong(phong) => phong.ks.get() + phong.kt.get() > 0.0,
        Material::Standard(_) => true,
    };
    let is_phong = matches!(settings.mode, Mode::Phong);
    let casts = settings.shadows && !scene.lights().is_empty();
    is_phong && (casts || (settings.max_depth > 0 && scene.materials().iter().any(bounces)))
}
