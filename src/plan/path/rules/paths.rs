//! Rules on the depth of paths, and on the surfaces they can meet.

use super::PathRule;
use crate::ir::{Field, Noun, Place};
use crate::plan::effect::Effect;
use crate::plan::path::draft::{Draft, LightLeft};
use crate::plan::rules::Rule;
use crate::plan::window::Shown;

fn depth() -> Place {
    Place::new(Noun::Settings, 0, Field::MaxDepth)
}

/// Whether a scattered ray may find light at a surface or in the environment.
fn finds_light(draft: &Draft<'_>) -> bool {
    let glows = |material: &crate::valid::Standard| {
        material.unlit || material.emissive != crate::math::Vec3::ZERO
    };
    draft.asks(Effect::Environment) || draft.used().any(|(_, material)| glows(material))
}

pub(super) const NO_LIGHT: PathRule = PathRule {
    rule: Rule::PathDark,
    name: "P-DARK",
    text: "Where nothing shines, neither a light nor a surface nor the environment, every path is \
           black after its first hit: none is followed.",
    because: "nothing shines",
    apply: |draft| {
        let is_lit = draft.lights.contains(&LightLeft::All) || finds_light(draft);
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
        let is_out =
            |surface: &usize| draft.surfaces[*surface] && draft.shown[*surface] == Shown::Nowhere;
        let out: Vec<_> = (0..draft.surfaces.len()).filter(is_out).collect();
        out.iter()
            .for_each(|surface| draft.surfaces[*surface] = false);
        let index = |surface: usize| draft.scene.surfaces()[surface].index;
        let place = |surface| Place::new(Noun::Surface, index(surface), Field::Whole);
        out.into_iter().map(place).collect()
    },
};

/// Ends all paths at their first hit, if that is proven to be sufficient.
fn end_paths(draft: &mut Draft<'_>, is_enough: bool) -> Vec<Place> {
    if !is_enough || draft.max_depth == 0 {
        return Vec::new();
    }
    draft.max_depth = 0;
    draft.last_ray = false;
    vec![depth()]
}
