//! Rules on the depth of paths, and on the surfaces they can meet.

use super::PathRule;
use crate::MAX_PAIRS;
use crate::effect::Effect;
use crate::path::draft::{Draft, LightUse};
use crate::rules::Rule;
use crate::space::Margins;
use crate::window::Shown;
use rtc_ir::{EntityKind, Field, ValuePath};
use rtc_math::{Bounds, Vec3};
use rtc_valid::{Falloff, Punctual, Standard};

fn depth() -> ValuePath {
    ValuePath::new(EntityKind::Settings, 0, Field::MaxDepth)
}

/// Whether a scattered ray may find light at a surface or in the environment.
fn finds_light(draft: &Draft<'_>) -> bool {
    let glows = |material: &Standard| material.unlit || material.emissive != Vec3::ZERO;
    draft.asks(Effect::Environment) || draft.used().any(|(_, material)| glows(material))
}

pub(super) const NO_LIGHT: PathRule = PathRule {
    rule: Rule::PathDark,
    name: "P-DARK",
    text: "Where nothing shines, neither a light nor a surface nor the environment, every path is \
           black after its first hit: none is followed.",
    because: "nothing shines",
    apply: |draft| {
        let is_lit = draft.lights.contains(&LightUse::All) || finds_light(draft);
        end_paths(draft, !is_lit)
    },
};

pub(super) const UNLIT_ONLY: PathRule = PathRule {
    rule: Rule::PathUnlit,
    name: "P-UNLIT",
    text: "A path ends on an unlit surface. Where all are unlit it is one ray.",
    because: "all surfaces are unlit",
    apply: |draft| {
        let all_unlit = draft.used().all(|(_, material)| material.unlit);
        end_paths(draft, all_unlit)
    },
};

pub(super) const LAST: PathRule = PathRule {
    rule: Rule::PathLast,
    name: "P-LAST",
    text: "After its last bounce a path adds only what it finds there shining. Where neither a surface \
           nor the environment shines, the last ray finds nothing: it is not traced.",
    because: "a ray after the last bounce would find nothing that shines",
    apply: |draft| {
        if !draft.last_ray || draft.max_depth == 0 || finds_light(draft) {
            return Vec::new();
        }
        draft.last_ray = false;
        vec![depth()]
    },
};

pub(super) const CULL: PathRule = PathRule {
    rule: Rule::PathCull,
    name: "P-CULL",
    text: "Where no path goes on and no light is looked for, a surface outside the view of the camera \
           is met by no ray.",
    because: "no ray of the camera meets it",
    apply: |draft| {
        if draft.bounces() || draft.asks(Effect::Shadows) {
            return Vec::new();
        }
        let (_, unseen) = split(draft);
        leave_out(draft, unseen)
    },
};

pub(super) const CULL_SHADOW: PathRule = PathRule {
    rule: Rule::PathCullShadow,
    name: "P-CULL-SHADOW",
    text: "Where no path goes on and no light has an extent, rays go from the camera to the surfaces in \
           view, and from these to the lights. A surface outside the view, and outside the convex hull \
           of each surface in view and each light, is met by no ray. Not where lights are chosen by \
           what they send to the whole scene, of which the surface is a part.",
    because: "no ray of the camera meets it, and it is not between a surface in view and a light",
    apply: |draft| {
        // A path goes on to each light with an extent.
        if draft.bounces() || !draft.asks(Effect::Shadows) || is_choice_by_size(draft) {
            return Vec::new();
        }
        let unmet = unmet_by_shadow_rays(draft).unwrap_or_default();
        leave_out(draft, unmet)
    },
};

/// Whether the choice between lights without extent depends on the size of the scene.
fn is_choice_by_size(draft: &Draft<'_>) -> bool {
    let is_chosen = |(_, left): &(&Punctual, &LightUse)| **left != LightUse::Nothing;
    let chosen = || draft.punctual.iter().zip(&draft.lights).filter(is_chosen);
    let is_by_size = |(light, _): (&Punctual, &LightUse)| match light {
        Punctual::Directional(_) => true,
        Punctual::Point(light) => matches!(light.falloff, Falloff::None),
    };
    chosen().count() > 1 && chosen().any(is_by_size)
}

/// The surfaces outside the view that surely no ray from one in view to a light meets; `None` where
/// that is not known.
fn unmet_by_shadow_rays(draft: &Draft<'_>) -> Option<Vec<usize>> {
    let (seen, unseen) = split(draft);
    let is_left = |(_, left): &(&Punctual, &LightUse)| **left == LightUse::All;
    let lights = || draft.punctual.iter().zip(&draft.lights).filter(is_left);
    if lights()
        .count()
        .saturating_mul(seen.len())
        .saturating_mul(unseen.len())
        > MAX_PAIRS
    {
        return None;
    }
    let space = |surface: &usize| draft.bodies[*surface].space().copied();
    let starts = seen.iter().map(space).collect::<Option<Vec<_>>>()?;
    let is_met = |other: &Bounds| {
        let meets = |start: &Bounds| {
            lights().any(|(light, _)| start.may_see_through(&end(light, start, other), other))
        };
        starts.iter().any(meets)
    };
    let is_unmet = |surface: &usize| space(surface).is_some_and(|space| !is_met(&space));
    Some(unseen.into_iter().filter(is_unmet).collect())
}

/// Where the rays to a light that start in a box end; for a sun, beyond another box.
fn end(light: &Punctual, start: &Bounds, other: &Bounds) -> Bounds {
    match light {
        Punctual::Directional(sun) => {
            // Points of the two are at most √3 times the sum of their sizes apart.
            let step = sun.direction * (2.0 * (start.reach() + other.reach()));
            Bounds {
                min: start.min + step,
                max: start.max + step,
            }
        }
        Punctual::Point(light) => Bounds::about(light.position, Vec3::ZERO),
    }
}

/// The surfaces of the world that a ray of the camera may meet, and the others.
fn split(draft: &Draft<'_>) -> (Vec<usize>, Vec<usize>) {
    let left = (0..draft.surfaces.len()).filter(|surface| draft.surfaces[*surface]);
    left.partition(|surface| draft.shown[*surface] != Shown::Nowhere)
}

/// Leaves surfaces out of the world; returns their places.
fn leave_out(draft: &mut Draft<'_>, surfaces: Vec<usize>) -> Vec<ValuePath> {
    surfaces
        .iter()
        .for_each(|surface| draft.surfaces[*surface] = false);
    let index = |surface: usize| draft.scene.surfaces()[surface].index;
    let place = |surface| ValuePath::new(EntityKind::Surface, index(surface), Field::Whole);
    surfaces.into_iter().map(place).collect()
}

/// Ends all paths at their first hit, if that is proven to be sufficient.
fn end_paths(draft: &mut Draft<'_>, is_enough: bool) -> Vec<ValuePath> {
    if !is_enough || draft.max_depth == 0 {
        return Vec::new();
    }
    draft.max_depth = 0;
    draft.last_ray = false;
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
        // Twice the largest coordinates of both, 1.5 and 3.25.
        let beyond = Bounds::about(Vec3::new(10.5, 0.5, 0.0), Vec3::splat(0.5));
        assert_eq!(end(&sun, &start, &other), beyond);
    }
}
