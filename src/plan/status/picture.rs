//! The status of buffers, surfaces, maps, normals, the lens and supersampling.

use super::{camera, first_n, settings};
use crate::effect::{Effect, EffectStatus};
use crate::pixel_classes::PixelClassGrid;
use crate::rules::Rule;
use crate::summary::MapUse;
use crate::unseen::Unseen;
use crate::{MaterialSummary, RuleResults};
use rtc_ir::EntityField;
use rtc_valid::{Mode, Pattern};

/// Depth and normal buffers, and the surfaces in the world.
pub(super) fn buffers(
    findings: &RuleResults<'_>,
    pixel_classes: &PixelClassGrid,
) -> Vec<EffectStatus> {
    let buffer = |effect, is_shown: bool, reason: &str| {
        let facts = vec![settings(EntityField::Mode)];
        if is_shown {
            EffectStatus::needed(effect, reason, facts)
        } else {
            EffectStatus::absent(effect, "the mode is another", facts)
        }
    };
    let mode = findings.mode();
    let depth = "the picture is a depth buffer";
    let normal = "the picture is a normal buffer";
    vec![
        buffer(Effect::DepthBuffer, matches!(mode, Mode::Depth), depth),
        buffer(Effect::NormalBuffer, matches!(mode, Mode::Normal), normal),
        surfaces(findings, pixel_classes),
    ]
}

fn surfaces(findings: &RuleResults<'_>, pixel_classes: &PixelClassGrid) -> EffectStatus {
    // List the surfaces that no ray can hit.
    let count = findings.facts.surface_bounds.len();
    let out = Unseen::by_any_ray(findings);
    let places = first_n(
        out.iter()
            .map(|unseen| findings.surface(unseen.surface(), EntityField::Whole)),
    );
    let empty = pixel_classes.empty_fraction();
    // Absent without surfaces; pruned if no ray can hit any.
    if count == 0 {
        return EffectStatus::absent(Effect::Surfaces, "the scene has none", vec![]);
    }
    if out.len() == count {
        return EffectStatus::pruned(
            Effect::Surfaces,
            Rule::Cull,
            "no ray can hit any surface",
            places,
        );
    }
    // Needed otherwise, with the numbers of surfaces and of empty pixels.
    let seen = first_n(
        findings
            .visible()
            .map(|surface| findings.surface(surface, EntityField::Whole)),
    );
    let mut reason = format!("{} of {count} can be hit by a ray", count - out.len());
    if empty > 0.0 {
        reason += &format!(
            "; {:.0} % of the pixels are empty (E-SS-MISS)",
            100.0 * empty
        );
    }
    if !findings.facts.rules.contains(Rule::Cull) {
        return EffectStatus::needed(Effect::Surfaces, "all surfaces are kept", seen);
    }
    let status = EffectStatus::needed(Effect::Surfaces, reason, seen);
    if out.is_empty() {
        status
    } else {
        EffectStatus {
            facts: places,
            ..status
        }
        .by(Rule::Cull)
    }
}

/// Textures, normals of meshes, normal maps.
pub(super) fn maps(findings: &RuleResults<'_>) -> Vec<EffectStatus> {
    vec![
        textures(findings),
        interpolation(findings),
        mapping(findings),
    ]
}

fn textures(findings: &RuleResults<'_>) -> EffectStatus {
    let effect = Effect::Textures;
    // Needed if a visible surface depends on a texture.
    if let Some(surface) = findings.first(|summary| findings.shows_color_map(summary)) {
        let facts = vec![
            findings.material(surface, EntityField::ColorMap),
            findings.surface(surface, EntityField::Whole),
        ];
        return EffectStatus::needed(effect, "a texture gives the colour of a surface", facts);
    }
    if let Some(surface) = findings.first(|summary| findings.shows_specular_map(summary)) {
        let facts = vec![
            findings.material(surface, EntityField::SpecularMap),
            findings.surface(surface, EntityField::Whole),
        ];
        return EffectStatus::needed(effect, "a texture scales the ks of a surface", facts);
    }
    // Absent if no material has a texture.
    let has_map = |material: &&rtc_valid::Phong| {
        material
            .maps
            .as_deref()
            .is_some_and(|maps| maps.color.is_some() || maps.specular.is_some())
    };
    let materials = &findings.facts.materials;
    if !materials.iter().any(|material| has_map(&material)) {
        return EffectStatus::absent(effect, "no material has a texture", vec![]);
    }
    let varies = |summary: &MaterialSummary| {
        [summary.color_map, summary.specular_map].contains(&MapUse::Varying)
    };
    if let Some(status) = kept(findings, effect, varies) {
        return status;
    }
    // Pruned otherwise; find the rule: mode, constant, or unused.
    if let Some(status) = findings
        .by_mode(effect, true)
        .filter(|_| !findings.is_shaded())
    {
        return status;
    }
    let constant = |summary: &MaterialSummary| {
        [summary.color_map, summary.specular_map].contains(&MapUse::Constant)
    };
    if let Some(surface) = findings.first(constant) {
        let facts = vec![findings.material(surface, EntityField::ColorMap)];
        return EffectStatus::pruned(
            effect,
            Rule::TextureConstant,
            "all texels of each texture are equal",
            facts,
        );
    }
    let unseen = findings.first_unseen(MaterialSummary::has_map);
    let facts = first_n(
        unseen
            .iter()
            .map(|surface| findings.surface(*surface, EntityField::Whole)),
    );
    let reason = "all textures are on surfaces without uv, on invisible surfaces, or of weight 0";
    EffectStatus::pruned(effect, Rule::TextureUnseen, reason, facts)
}

/// The status of maps that change nothing, but are looked up: the rule may not be applied.
fn kept(
    findings: &RuleResults<'_>,
    effect: Effect,
    has_map: impl Fn(&MaterialSummary) -> bool,
) -> Option<EffectStatus> {
    let is_allowed = findings.facts.rules.contains(Rule::TextureUnseen);
    if is_allowed || matches!(findings.mode(), Mode::Depth) {
        return None;
    }
    let facts = vec![findings.surface(findings.first(has_map)?, EntityField::Whole)];
    Some(EffectStatus::needed(effect, "all maps are kept", facts))
}

fn interpolation(findings: &RuleResults<'_>) -> EffectStatus {
    let effect = Effect::NormalInterpolation;
    let is_even = |surface: usize| findings.facts.is_even(surface);
    let shows = |surface: &usize| {
        let summary = &findings.facts.summaries[*surface];
        summary.has_vertex_normals && findings.shows_normal(summary)
    };
    let mut has_vertex_normals = findings.visible().filter(shows);
    if let Some(surface) = has_vertex_normals.find(|surface| !is_even(*surface)) {
        let facts = vec![findings.surface(surface, EntityField::Whole)];
        return EffectStatus::needed(effect, "a mesh has vertex normals", facts);
    }
    let has_normals = |surface: &usize| findings.facts.summaries[*surface].has_vertex_normals;
    let Some(surface) = (0..findings.facts.summaries.len()).find(has_normals) else {
        return EffectStatus::absent(effect, "no mesh has normals", vec![]);
    };
    let facts = vec![findings.surface(surface, EntityField::Whole)];
    if matches!(findings.mode(), Mode::Depth) {
        return EffectStatus::pruned(
            effect,
            Rule::Mode,
            "a depth buffer has no normals",
            vec![settings(EntityField::Mode)],
        );
    }
    let reason = if findings.visible().any(|surface| shows(&surface)) {
        "the vertex normals of each triangle are equal"
    } else {
        "meshes with normals are invisible, or neither illuminated nor reflective"
    };
    EffectStatus::pruned(effect, Rule::NormalFlat, reason, facts)
}

fn mapping(findings: &RuleResults<'_>) -> EffectStatus {
    let effect = Effect::NormalMapping;
    if let Some(surface) =
        findings.first(|summary| summary.has_normal_map && findings.shows_normal(summary))
    {
        let facts = vec![
            findings.material(surface, EntityField::NormalMap),
            findings.surface(surface, EntityField::Whole),
        ];
        return EffectStatus::needed(effect, "a map changes the normals of a surface", facts);
    }
    let maps = |material: &rtc_valid::Phong| {
        material
            .maps
            .as_deref()
            .is_some_and(|maps| maps.normal.is_some() || maps.bump.is_some())
    };
    if !findings.facts.materials.iter().any(maps) {
        return EffectStatus::absent(effect, "no material has a normal map or a bump map", vec![]);
    }
    if matches!(findings.mode(), Mode::Depth) {
        return EffectStatus::pruned(
            effect,
            Rule::Mode,
            "a depth buffer has no normals",
            vec![settings(EntityField::Mode)],
        );
    }
    if let Some(status) = kept(findings, effect, |summary| summary.has_normal_map) {
        return status;
    }
    let reason = "all such maps are on surfaces that have no uv, are invisible, or are neither \
     illuminated nor reflective";
    EffectStatus::pruned(effect, Rule::TextureUnseen, reason, vec![])
}

/// Depth of field.
pub(super) fn lens(findings: &RuleResults<'_>) -> EffectStatus {
    let effect = Effect::Lens;
    // Absent if no lens is set; pruned if it is a pinhole.
    let lens = &findings.facts.scene.camera().lens;
    let (radius, samples) = (lens.radius.get(), lens.samples.get());
    let facts = vec![
        camera(EntityField::LensRadius),
        camera(EntityField::LensSamples),
    ];
    if radius == 0.0 && samples == 1 {
        return EffectStatus::absent(
            effect,
            "a pinhole camera: the lens is not set",
            vec![camera(EntityField::LensRadius)],
        )
        .by(Rule::Pinhole);
    }
    if radius == 0.0 {
        return EffectStatus::pruned(
            effect,
            Rule::Pinhole,
            "the lens radius is 0: a pinhole camera",
            facts,
        );
    }
    if samples == 1 {
        return EffectStatus::pruned(
            effect,
            Rule::Pinhole,
            "one lens sample is the centre of the lens",
            facts,
        );
    }
    // Pruned if the mode or the view does not need it.
    if matches!(findings.mode(), Mode::Depth) {
        let facts = vec![settings(EntityField::Mode)];
        return EffectStatus::pruned(
            effect,
            Rule::Mode,
            "a depth buffer has rays from the eye only",
            facts,
        );
    }
    if findings.visible().next().is_none() {
        return EffectStatus::pruned(effect, Rule::PixelMiss, "no surface is visible", facts);
    }
    // Needed otherwise.
    EffectStatus::needed(
        effect,
        format!("{samples} samples of a lens of radius {radius}"),
        facts,
    )
}

/// Samples per pixel.
pub(super) fn supersampling(
    findings: &RuleResults<'_>,
    pixel_classes: &PixelClassGrid,
) -> EffectStatus {
    let effect = Effect::Supersampling;
    let settings_of_scene = findings.facts.scene.settings();
    let factor = settings_of_scene.supersampling.get();
    let facts = vec![settings(EntityField::Supersampling)];
    // One sample per pixel needs no supersampling.
    if factor == 1 {
        let reason = if settings_of_scene.pattern == Pattern::Grid {
            "a factor of 1"
        } else {
            "a factor of 1, with a random sample position"
        };
        return EffectStatus::absent(effect, reason, facts).by(Rule::OneSample);
    }
    if matches!(findings.mode(), Mode::Depth) {
        let facts = vec![
            settings(EntityField::Mode),
            settings(EntityField::Supersampling),
        ];
        return EffectStatus::pruned(
            effect,
            Rule::Mode,
            "a depth buffer has one ray through the centre of each pixel",
            facts,
        );
    }
    // Without a visible surface, all samples are the background.
    if findings.visible().next().is_none() && findings.facts.rules.contains(Rule::PixelMiss) {
        return EffectStatus::pruned(effect, Rule::PixelMiss, "no surface is visible", facts);
    }
    // Otherwise each pixel has a grid of samples.
    let mut reason = format!(
        "a factor of {factor}: {} rays per pixel",
        u64::from(factor) * u64::from(factor)
    );
    if pixel_classes.has_flat_pixels() {
        reason += ", but one ray where one flat surface covers the pixel (E-SS-FLAT)";
    }
    EffectStatus::needed(effect, reason, facts)
}
