//! The surfaces that certainly no ray hits, found from their bounds. The set is conservative: other
//! surfaces may be invisible, too.

use super::findings::is_pinhole;
use super::projection::{ScreenProjection, ScreenRect};
use super::surface_bounds::{SurfaceBounds, SurfaceExtent, surface_bounds};
use super::{Plan, RuleSet};
use rtc_valid::{Material, Mode, Projection, ValidScene};

/// The maximum number of pairs of a surface outside the picture and any other surface for which
/// shadows and reflections are tested.
const MAX_PAIRS: usize = 20_000;

/// The surfaces that certainly no ray hits, as IR indices in ascending order.
///
/// Path tracing may hit any surface, and nothing is proven for an orthographic camera.
#[must_use]
pub fn invisible_surfaces(scene: &ValidScene) -> Vec<usize> {
    let is_perspective = matches!(scene.camera().projection, Projection::Perspective);
    if matches!(scene.settings().mode, Mode::Path(_)) || !is_perspective {
        return Vec::new();
    }
    let projection = ScreenProjection::new(scene.camera(), is_pinhole(scene), 0.0);
    let is_outside = |bounds: &SurfaceBounds| match &bounds.extent {
        SurfaceExtent::Plane(plane) => projection.is_behind(plane),
        SurfaceExtent::Within(_) | SurfaceExtent::Anywhere => {
            projection.screen_rect(bounds) == ScreenRect::Outside
        }
    };
    let surface_bounds = surface_bounds(scene);
    let mut outside: Vec<usize> = (0..surface_bounds.len())
        .filter(|surface| is_outside(&surface_bounds[*surface]))
        .collect();
    if !outside.is_empty() && has_secondary_rays(scene) {
        if outside.len().saturating_mul(surface_bounds.len()) > MAX_PAIRS {
            return Vec::new();
        }
        let plan = Plan::new(scene, RuleSet::ALL);
        outside.retain(|surface| !plan.surfaces[*surface]);
    }
    let index = |surface: usize| scene.surfaces()[surface].index;
    outside.into_iter().map(index).collect()
}

/// Whether rays start on surfaces: shadow, reflected or refracted rays.
fn has_secondary_rays(scene: &ValidScene) -> bool {
    let settings = scene.settings();
    let bounces = |material: &Material| match material {
        Material::Phong(phong) => phong.most_mirror_weight() + phong.kt.get() > 0.0,
        Material::Standard(_) => true,
    };
    let is_phong = matches!(settings.mode, Mode::Phong);
    let occludes = settings.shadows && !scene.lights().is_empty();
    is_phong && (occludes || (settings.max_depth > 0 && scene.materials().iter().any(bounces)))
}
