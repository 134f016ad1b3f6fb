//! The status of each effect of path tracing, derived from the final [`PathPlanBuilder`].

use super::builder::{AppliedRule, PathPlanBuilder, material_requires};
use crate::effect::{Effect, EffectState, EffectStatus};
use rtc_ir::{EntityField, EntityKind, ValuePath};
use rtc_valid::{MaterialId, Standard};

/// The maximum number of facts of a status.
const MAX_FACTS: usize = 3;

/// The status of each effect that path tracing may have.
pub(super) fn statuses(
    requested: &PathPlanBuilder<'_>,
    reduced: &PathPlanBuilder<'_>,
    applied: &[AppliedRule],
) -> Vec<EffectStatus> {
    Effect::OF_PATHS
        .into_iter()
        .map(|effect| status(effect, requested, reduced, applied))
        .collect()
}

fn status(
    effect: Effect,
    requested: &PathPlanBuilder<'_>,
    reduced: &PathPlanBuilder<'_>,
    applied: &[AppliedRule],
) -> EffectStatus {
    // Needed if still required; pruned if a rule removed it; otherwise absent.
    let removed_effects = || {
        applied
            .iter()
            .find(|applied| applied.removed_effects.contains(&effect))
    };
    let (state, rule, reason, mut facts) = if reduced.requires(effect) {
        let (reason, places) = reduced.need(effect);
        (EffectState::Needed, None, reason, places)
    } else if let Some(AppliedRule {
        rule, item, places, ..
    }) = removed_effects().filter(|_| requested.requires(effect))
    {
        (
            EffectState::Pruned,
            Some(*rule),
            item.reason.to_owned(),
            places.clone(),
        )
    } else {
        (
            EffectState::Absent,
            None,
            absence(effect).to_owned(),
            Vec::new(),
        )
    };
    // Name only the first facts.
    facts.truncate(MAX_FACTS);
    EffectStatus {
        effect,
        of: None,
        state,
        rule,
        reason,
        facts,
    }
}

/// The reason why a scene does not require an effect.
fn absence(effect: Effect) -> &'static str {
    match effect {
        Effect::Surfaces => "the scene has none",
        Effect::Supersampling => "one path per pixel",
        Effect::Lens => "a pinhole camera: the lens radius is 0",
        Effect::Environment => "the scene has no environment",
        Effect::EnvironmentMap => "the environment has no image",
        Effect::Emission => "no material emits light",
        Effect::Unlit => "no material is unlit",
        Effect::Alpha => "all materials are opaque",
        Effect::Blend => "no material is a blend",
        Effect::DirectLight => "there is no light to sample",
        Effect::Shadows => "no light is sampled",
        Effect::Mis => "no light is found both by light sampling and by BSDF sampling",
        Effect::Caustics => "no smooth surface leads light of a sampled light to another",
        Effect::Depth => "no path continues after its first hit",
        Effect::Refraction => "no material transmits light",
        Effect::Volume => "no medium absorbs light",
        Effect::Media => "neither a surface nor the camera is in a medium",
        Effect::Dispersion => "no material disperses light",
        Effect::Microfacets => "no material has a microfacet lobe",
        Effect::Compensation => "there is no multiple scattering between microfacets",
        Effect::Layer(layer) => layer.absence(),
        Effect::Textures => "no material has a texture",
        Effect::NormalMapping => "no material has a normal map",
        Effect::NormalInterpolation => "no mesh has normals",
        Effect::VertexColors => "no mesh has vertex colours",
        Effect::MotionBlur => "nothing moves while the shutter is open",
        Effect::DepthBuffer
        | Effect::NormalBuffer
        | Effect::SoftLight
        | Effect::Highlight
        | Effect::Mirror
        | Effect::GlossyReflection => "path tracing does not have it",
    }
}

impl PathPlanBuilder<'_> {
    /// The reason why the picture needs an effect, and the scene values that require it.
    fn need(&self, effect: Effect) -> (String, Vec<ValuePath>) {
        let materials: Vec<_> = self.materials_with(effect).map(material).collect();
        if materials.is_empty() {
            self.need_of_scene(effect)
        } else {
            (counted(materials.len(), "material"), materials)
        }
    }

    /// Like [`Self::need`], for an effect that no single material requires.
    fn need_of_scene(&self, effect: Effect) -> (String, Vec<ValuePath>) {
        let at = |entity, field| vec![ValuePath::new(entity, 0, field)];
        let reason_at = |reason: &str, entity| (reason.to_owned(), at(entity, EntityField::Whole));
        // Tell what in the scene requires the effect.
        match effect {
            Effect::Surfaces => {
                let reduced = self
                    .surfaces
                    .iter()
                    .filter(|is_in_world| **is_in_world)
                    .count();
                let reason = format!("{reduced} of {} can be hit by a ray", self.surfaces.len());
                (reason, at(EntityKind::Surface, EntityField::Whole))
            }
            Effect::Supersampling => {
                let reason = counted(self.path.samples.get() as usize, "path") + " per pixel";
                (reason, at(EntityKind::Settings, EntityField::Mode))
            }
            Effect::Lens => {
                let reason = format!("a lens of radius {}", self.scene.camera().lens.radius.get());
                (reason, at(EntityKind::Camera, EntityField::LensRadius))
            }
            Effect::Depth => {
                let bounces = self.max_depth - u32::from(!self.last_ray);
                let reason = format!("at most {}", counted(bounces as usize, "bounce"));
                (reason, at(EntityKind::Settings, EntityField::MaxDepth))
            }
            Effect::Compensation => {
                let reason = "there is multiple scattering between microfacets";
                (
                    reason.to_owned(),
                    at(EntityKind::Settings, EntityField::Mode),
                )
            }
            Effect::Environment => reason_at(
                "paths that leave the scene hit the environment light",
                EntityKind::Environment,
            ),
            Effect::EnvironmentMap => {
                reason_at("the environment has an image", EntityKind::Environment)
            }
            Effect::DirectLight => reason_at(
                "a surface is illuminated by a light that can be sampled",
                EntityKind::Light,
            ),
            Effect::Shadows => {
                reason_at("a surface may shadow another or itself", EntityKind::Light)
            }
            Effect::Mis => reason_at(
                "light sampling and BSDF sampling find the same light",
                EntityKind::Light,
            ),
            Effect::Caustics => reason_at(
                "a smooth surface may lead light of a sampled light to another",
                EntityKind::Light,
            ),
            Effect::Media => reason_at("the camera is in a medium", EntityKind::Medium),
            Effect::NormalInterpolation => {
                reason_at("a mesh has vertex normals", EntityKind::Surface)
            }
            Effect::VertexColors => reason_at("a mesh has vertex colours", EntityKind::Surface),
            Effect::NormalMapping => ("a material has a normal map".to_owned(), self.with_maps()),
            Effect::Textures => ("a material has a texture".to_owned(), self.with_maps()),
            Effect::Emission
            | Effect::Unlit
            | Effect::Alpha
            | Effect::Blend
            | Effect::Microfacets
            | Effect::Refraction
            | Effect::Volume
            | Effect::Dispersion
            | Effect::Layer(_)
            | Effect::MotionBlur
            | Effect::DepthBuffer
            | Effect::NormalBuffer
            | Effect::SoftLight
            | Effect::Highlight
            | Effect::Mirror
            | Effect::GlossyReflection => reason_at("", EntityKind::Surface),
        }
    }

    /// The materials with maps.
    fn with_maps(&self) -> Vec<ValuePath> {
        let has_map = |(_, m): &(MaterialId, &Standard)| m.maps().next().is_some();
        let with_maps = self.used_materials().filter(has_map);
        with_maps.map(|(index, _)| material(index)).collect()
    }

    /// The materials that require an effect.
    fn materials_with(&self, effect: Effect) -> impl Iterator<Item = MaterialId> {
        let requires =
            move |(_, material): &(MaterialId, &Standard)| material_requires(material, effect);
        self.used_materials()
            .filter(requires)
            .map(|(index, _)| index)
    }
}

fn material(id: MaterialId) -> ValuePath {
    ValuePath::new(EntityKind::Material, id.index(), EntityField::Whole)
}

fn counted(count: usize, entity: &str) -> String {
    format!("{count} {entity}{}", if count == 1 { "" } else { "s" })
}
