//! Rules on the length of paths and on the surfaces that they can hit.

use super::PathRule;
use crate::MAX_PAIRS;
use crate::effect::Effect;
use crate::margin::BoxMargins;
use crate::path::builder::{PathPlanBuilder, RemainingLight};
use crate::projection::ScreenRect;
use rtc_ir::{EntityField, EntityKind, ValuePath};
use rtc_math::{Bounds, Vec3};
use rtc_valid::{Falloff, Punctual, Standard};

fn depth() -> ValuePath {
    ValuePath::new(EntityKind::Settings, 0, EntityField::MaxDepth)
}

/// Whether a scattered ray may hit an emissive surface or an environment that is not black.
fn may_hit_emitter(builder: &PathPlanBuilder<'_>) -> bool {
    let is_emissive = |material: &Standard| material.unlit || material.emissive != Vec3::ZERO;
    builder.requires(Effect::Environment)
        || builder
            .used_materials()
            .any(|(_, material)| is_emissive(material))
}

pub(crate) const NO_EMISSION: PathRule = PathRule {
    name: "P-DARK",
    text: "If no light, no surface and no environment emits light, every path is black after its \
           first hit: none is continued.",
    reason: "there is no light",
    apply: |builder| {
        let has_light = builder.lights.contains(&RemainingLight::All) || may_hit_emitter(builder);
        end_paths(builder, !has_light)
    },
};

pub(crate) const UNLIT_ONLY: PathRule = PathRule {
    name: "P-UNLIT",
    text: "A path ends on an unlit surface. If all surfaces are unlit, and there are no media, a \
           path is one ray.",
    reason: "all surfaces are unlit",
    apply: |builder| {
        let all_unlit = builder.used_materials().all(|(_, material)| material.unlit);
        end_paths(builder, all_unlit && !builder.has_media())
    },
};

pub(crate) const LAST_RAY: PathRule = PathRule {
    name: "P-LAST",
    text: "After its last bounce a path adds only the emission at the next hit. If neither a \
           surface nor the environment emits light, the last ray is not traced.",
    reason: "a ray after the last bounce cannot hit an emitter",
    apply: |builder| {
        if !builder.last_ray || builder.max_depth == 0 || may_hit_emitter(builder) {
            return Vec::new();
        }
        builder.last_ray = false;
        vec![depth()]
    },
};

pub(crate) const CULL: PathRule = PathRule {
    name: "P-CULL",
    text: "If no path continues and there are no shadow rays, no ray hits a surface outside the \
           view of the camera.",
    reason: "no camera ray hits it",
    apply: |builder| {
        if builder.bounces() || builder.requires(Effect::Shadows) {
            return Vec::new();
        }
        let (_, unseen) = split(builder);
        remove_surfaces(builder, unseen)
    },
};

pub(crate) const CULL_SHADOW: PathRule = PathRule {
    name: "P-CULL-SHADOW",
    text: "If no path continues and no light has an extent, rays go from the camera to the \
           visible surfaces, and from these to the lights. No ray hits a surface that is outside \
           the view and outside the convex hull of each visible surface and each light. The rule \
           does not apply if the sampling probabilities of lights depend on the size of the \
           scene, to which the surface belongs, nor in media.",
    reason: "no camera ray hits it, and it is not between a visible surface and a light",
    apply: |builder| {
        // A path may continue to any light with an extent.
        let is_scattered = builder.bounces() || builder.has_media();
        if is_scattered || !builder.requires(Effect::Shadows) || depends_on_scene_size(builder) {
            return Vec::new();
        }
        let missed = missed_by_shadow_rays(builder).unwrap_or_default();
        remove_surfaces(builder, missed)
    },
};

/// Whether the sampling probabilities of punctual lights depend on the size of the scene.
fn depends_on_scene_size(builder: &PathPlanBuilder<'_>) -> bool {
    let is_chosen =
        |(_, light_use): &(&Punctual, &RemainingLight)| **light_use != RemainingLight::Nothing;
    let chosen = || {
        builder
            .punctual
            .iter()
            .zip(&builder.lights)
            .filter(is_chosen)
    };
    let depends_on_size = |(light, _): (&Punctual, &RemainingLight)| match light {
        Punctual::Directional(_) => true,
        Punctual::Point(light) => matches!(light.falloff, Falloff::None),
    };
    chosen().count() > 1 && chosen().any(depends_on_size)
}

/// The surfaces outside the view that certainly no shadow ray of a visible surface hits; `None` if
/// that is unknown.
fn missed_by_shadow_rays(builder: &PathPlanBuilder<'_>) -> Option<Vec<usize>> {
    let (seen, unseen) = split(builder);
    let is_in_world =
        |(_, light_use): &(&Punctual, &RemainingLight)| **light_use == RemainingLight::All;
    let lights = || {
        builder
            .punctual
            .iter()
            .zip(&builder.lights)
            .filter(is_in_world)
    };
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
            lights().any(|(light, _)| start.segment_may_hit(&end(light, start, other), other))
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
    let light_use = (0..builder.surfaces.len()).filter(|surface| builder.surfaces[*surface]);
    light_use.partition(|surface| builder.screen_rects[*surface] != ScreenRect::Outside)
}

/// Removes surfaces from the world; returns their paths.
fn remove_surfaces(builder: &mut PathPlanBuilder<'_>, surfaces: Vec<usize>) -> Vec<ValuePath> {
    surfaces
        .iter()
        .for_each(|surface| builder.surfaces[*surface] = false);
    let index = |surface: usize| builder.scene.surfaces()[surface].index;
    let place = |surface| ValuePath::new(EntityKind::Surface, index(surface), EntityField::Whole);
    surfaces.into_iter().map(place).collect()
}

/// Ends all paths at the first hit, if that is proven to be sufficient.
fn end_paths(builder: &mut PathPlanBuilder<'_>, is_enough: bool) -> Vec<ValuePath> {
    if !is_enough || builder.max_depth == 0 {
        return Vec::new();
    }
    builder.max_depth = 0;
    builder.last_ray = false;
    vec![depth()]
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
