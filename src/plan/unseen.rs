//! The surfaces that certainly no ray hits, and the world without them.
//!
//! Only the proofs in this module make an [`Unseen`], without which no surface is dropped.

use super::MAX_PAIRS;
use super::effect::Effect;
use super::findings::RuleResults;
use super::margin::BoxMargins;
use super::path::{PathPlanBuilder, RemainingLight};
use super::projection::ScreenRect;
use super::rules::Rule;
use rtc_math::{Bounds, Vec3};
use rtc_valid::{Falloff, Punctual};
use std::ops::Deref;

/// For each surface of a scene, whether it is in the world.
#[derive(Clone)]
pub(crate) struct WorldSurfaces(Vec<bool>);

impl WorldSurfaces {
    /// The world with all surfaces of a scene.
    pub(crate) fn all(count: usize) -> Self {
        Self(vec![true; count])
    }

    /// Drops a surface.
    pub(crate) fn drop_surface(&mut self, unseen: Unseen) {
        self.0[unseen.surface] = false;
    }
}

impl Deref for WorldSurfaces {
    type Target = Vec<bool>;

    fn deref(&self) -> &Vec<bool> {
        &self.0
    }
}

/// The proof that no ray hits a surface.
pub(crate) struct Unseen {
    surface: usize,
}

impl Unseen {
    /// The index of the surface in the scene.
    pub(crate) fn surface(&self) -> usize {
        self.surface
    }

    /// The surfaces that no camera, shadow, reflected or refracted ray of the Whitted integrator
    /// hits, if the rule may be applied.
    pub(crate) fn by_any_ray(findings: &RuleResults<'_>) -> Vec<Self> {
        let (visible, occludes) = (&findings.visibility.visible, &findings.lights.occludes);
        let is_allowed = findings.facts.rules.contains(Rule::Cull);
        (0..visible.len())
            .filter(|surface| is_allowed && !visible[*surface] && !occludes[*surface])
            .map(|surface| Self { surface })
            .collect()
    }

    /// The surfaces outside the view, if paths have camera rays only.
    pub(crate) fn by_camera_rays(builder: &PathPlanBuilder<'_>) -> Vec<Self> {
        if builder.bounces() || builder.requires(Effect::Shadows) {
            return Vec::new();
        }
        let (_, unseen) = split(builder);
        unseen.into_iter().map(|surface| Self { surface }).collect()
    }

    /// The surfaces outside the view that no shadow ray of a visible surface hits, if paths have no
    /// other rays.
    pub(crate) fn by_shadow_rays(builder: &PathPlanBuilder<'_>) -> Vec<Self> {
        // A path may continue to any light with an extent.
        let is_scattered = builder.bounces() || builder.has_media();
        if is_scattered || !builder.requires(Effect::Shadows) || depends_on_scene_size(builder) {
            return Vec::new();
        }
        let missed = missed_by_shadow_rays(builder).unwrap_or_default();
        missed.into_iter().map(|surface| Self { surface }).collect()
    }
}

/// Whether the sampling probabilities of punctual lights depend on the size of the scene.
fn depends_on_scene_size(builder: &PathPlanBuilder<'_>) -> bool {
    let chosen = || builder.lights_left(|rest| rest != RemainingLight::Nothing);
    let depends_on_size = |light: &Punctual| match light {
        Punctual::Directional(_) => true,
        Punctual::Point(light) => matches!(light.falloff, Falloff::None),
    };
    chosen().count() > 1 && chosen().any(depends_on_size)
}

/// The surfaces outside the view that certainly no shadow ray of a visible surface hits; `None` if
/// that is unknown.
fn missed_by_shadow_rays(builder: &PathPlanBuilder<'_>) -> Option<Vec<usize>> {
    let (seen, unseen) = split(builder);
    let lights = || builder.lights_left(|rest| rest == RemainingLight::All);
    if lights()
        .count()
        .saturating_mul(seen.len())
        .saturating_mul(unseen.len())
        > MAX_PAIRS
    {
        return None;
    }
    let aabb = |surface: &usize| builder.surface_bounds[*surface].aabb().copied();
    let starts = seen.iter().map(aabb).collect::<Option<Vec<_>>>()?;
    let may_be_hit = |other: &Bounds| {
        let meets = |start: &Bounds| {
            lights().any(|light| start.segment_may_hit(&end(light, start, other), other))
        };
        starts.iter().any(meets)
    };
    let is_missed = |surface: &usize| aabb(surface).is_some_and(|aabb| !may_be_hit(&aabb));
    Some(unseen.into_iter().filter(is_missed).collect())
}

/// The bounds of the end points of shadow rays that start in a box; for a directional light, beyond
/// another box.
fn end(light: &Punctual, start: &Bounds, other: &Bounds) -> Bounds {
    match light {
        Punctual::Directional(sun) => {
            // The distance of two points of the boxes is at most √3 times the sum of their sizes.
            let step = sun.direction * (2.0 * (start.reach() + other.reach()));
            Bounds {
                min: start.min + step,
                max: start.max + step,
            }
        }
        Punctual::Point(light) => Bounds::about(light.position, Vec3::ZERO),
    }
}

/// The surfaces of the world that a camera ray may hit, and the others.
fn split(builder: &PathPlanBuilder<'_>) -> (Vec<usize>, Vec<usize>) {
    let left = (0..builder.surfaces.len()).filter(|surface| builder.surfaces[*surface]);
    left.partition(|surface| builder.screen_rects[*surface] != ScreenRect::Outside)
}

#[cfg(test)]
mod tests {
    use super::*;
    use rtc_valid::DirectionalLight;

    #[test]
    fn a_ray_to_a_sun_is_followed_to_beyond_the_other_box() {
        let sun = Punctual::Directional(DirectionalLight {
            direction: Vec3::X,
            irradiance: Vec3::ONE,
        });
        let start = Bounds::about(Vec3::new(1.0, 0.5, 0.0), Vec3::splat(0.5));
        let other = Bounds::about(Vec3::new(3.0, 0.5, 0.0), Vec3::splat(0.25));
        // The step is twice the sum of the largest coordinates, 1.5 and 3.25.
        let beyond = Bounds::about(Vec3::new(10.5, 0.5, 0.0), Vec3::splat(0.5));
        assert_eq!(end(&sun, &start, &other), beyond);
    }
}
