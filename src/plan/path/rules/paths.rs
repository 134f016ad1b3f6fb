//! Rules on the length of paths and on the surfaces that they can hit.

use super::PathRule;
use crate::effect::Effect;
use crate::path::builder::{PathPlanBuilder, RemainingLight};
use crate::unseen::Unseen;
use rtc_ir::{EntityField, EntityKind, ValuePath};
use rtc_math::Vec3;
use rtc_valid::Standard;

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
        let unseen = Unseen::by_camera_rays(builder);
        builder.drop_surfaces(unseen)
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
        let unseen = Unseen::by_shadow_rays(builder);
        builder.drop_surfaces(unseen)
    },
};

/// Ends all paths at the first hit, if that is proven to be sufficient.
fn end_paths(builder: &mut PathPlanBuilder<'_>, is_enough: bool) -> Vec<ValuePath> {
    if !is_enough || builder.max_depth == 0 {
        return Vec::new();
    }
    builder.max_depth = 0;
    builder.last_ray = false;
    vec![depth()]
}
