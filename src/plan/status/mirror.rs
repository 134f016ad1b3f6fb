//! The status of bounces: reflection, glossy lobes, refraction, depth.

use super::{MAX_DETAILS, first_n, settings};
use crate::effect::{Effect, EffectStatus};
use crate::rules::Rule;
use crate::{MaterialSummary, RuleResults};
use rtc_ir::{EntityField, ValuePath};
use rtc_valid::Phong;
use std::collections::BTreeSet;

pub(super) fn statuses(findings: &RuleResults<'_>) -> Vec<EffectStatus> {
    let mut all = vec![depth(findings), mirror(findings)];
    all.extend(materials_without_mirror(findings).take(MAX_DETAILS));
    all.push(glossy(findings));
    all.push(refraction(findings));
    all
}

/// The status of an effect of bounces if no bounce contributes; `requires` is whether a material
/// requires the effect.
fn no_bounce(
    findings: &RuleResults<'_>,
    effect: Effect,
    requires: impl Fn(&Phong) -> bool,
) -> Option<EffectStatus> {
    let requested = findings.facts.materials.iter().any(&requires);
    if let Some(status) = findings.by_mode(effect, requested) {
        return Some(status);
    }
    if findings.max_depth > 0 {
        return None;
    }
    let facts = vec![settings(EntityField::MaxDepth)];
    if findings.facts.scene.settings().max_depth == 0 {
        let reason = "the scene allows no bounce";
        return Some(if requested {
            EffectStatus::pruned(effect, Rule::MirrorDepth, reason, facts)
        } else {
            EffectStatus::absent(effect, reason, facts).by(Rule::MirrorDepth)
        });
    }
    if findings.any(MaterialSummary::has_bounce) && findings.visibility.depth > 0 {
        return Some(EffectStatus::pruned(
            effect,
            Rule::Cut,
            "the contribution of bounces is below half a level of 8 bits",
            facts,
        ));
    }
    Some(no_visible_reflection(findings, effect, requested))
}

/// The status if reflections contribute nothing, although bounces are allowed.
fn no_visible_reflection(
    findings: &RuleResults<'_>,
    effect: Effect,
    requested: bool,
) -> EffectStatus {
    // Visible reflective surfaces, but their reflections are black.
    if let Some(mirror) = findings.first(MaterialSummary::has_bounce) {
        let facts = vec![
            findings.surface(mirror, EntityField::Whole),
            mirror_weight(findings, mirror).1,
        ];
        let is_alone = findings.facts.surface_bounds.len() == 1;
        let (rule, reason) = if is_alone {
            (
                Rule::MirrorConvex,
                "the visible reflections are black: the only surface is convex",
            )
        } else {
            (Rule::MirrorUnreached, "the visible reflections are black")
        };
        return EffectStatus::pruned(effect, rule, reason, facts);
    }
    // Reflective surfaces, but all invisible.
    if requested && let Some(mirror) = findings.first_unseen(MaterialSummary::has_bounce) {
        let facts = vec![findings.surface(mirror, EntityField::Whole)];
        return EffectStatus::pruned(
            effect,
            Rule::Cull,
            "no reflective surface is visible",
            facts,
        );
    }
    // No reflective surface.
    let facts = first_n(
        findings
            .visible()
            .map(|surface| mirror_weight(findings, surface).1),
    );
    no_mirror(findings, effect, facts)
}

/// The status where no visible surface reflects.
fn no_mirror(findings: &RuleResults<'_>, effect: Effect, facts: Vec<ValuePath>) -> EffectStatus {
    let keys = findings
        .visible()
        .map(|surface| mirror_weight(findings, surface).0)
        .collect::<BTreeSet<_>>();
    let reason = match keys.contains("kr") {
        true => "the weight of the reflected ray, kr or else ks, is 0 on all visible surfaces",
        false => "ks is 0 on all visible surfaces",
    };
    EffectStatus::pruned(effect, Rule::MirrorKs, reason, facts)
}

/// The key of the weight of the reflected ray of a surface, and its value in the scene.
fn mirror_weight(findings: &RuleResults<'_>, surface: usize) -> (&'static str, ValuePath) {
    let (key, field) = match findings.phong(surface).kr {
        Some(_) => ("kr", EntityField::Kr),
        None => ("ks", EntityField::Ks),
    };
    (key, findings.material(surface, field))
}

/// The number of bounces after the first hit.
fn depth(findings: &RuleResults<'_>) -> EffectStatus {
    let effect = Effect::Depth;
    if let Some(status) = no_bounce(findings, effect, |material| {
        material.most_mirror_weight() + material.kt.get() > 0.0
    }) {
        return status;
    }
    let mut facts = vec![settings(EntityField::MaxDepth)];
    facts.extend(
        findings
            .first(MaterialSummary::has_bounce)
            .map(|mirror| findings.surface(mirror, EntityField::Whole)),
    );
    let (planned, requested) = (findings.max_depth, findings.requested);
    let rest = requested - planned.min(requested);
    let bounces = if planned == 1 { "bounce" } else { "bounces" };
    let reason = match (rest, findings.visibility.capped) {
        (0, true) => format!("{planned} {bounces}; too many reflective surfaces to test all pairs"),
        (0, false) => format!("{planned} {bounces}: reflective surfaces are visible in each other"),
        _ => format!("{planned} {bounces} of {requested}: no chain of reflections is longer"),
    };
    let status = EffectStatus::needed(effect, reason, facts);
    match rest {
        0 => status,
        _ if findings.visibility.depth > planned => status.by(Rule::Cut),
        _ => status.by(Rule::MirrorUnreached),
    }
}

fn mirror(findings: &RuleResults<'_>) -> EffectStatus {
    let effect = Effect::Mirror;
    if let Some(status) = no_bounce(findings, effect, |material| {
        material.most_mirror_weight() > 0.0
    }) {
        return status;
    }
    match findings.first(MaterialSummary::has_bounce) {
        Some(surface) => {
            let (key, weight) = mirror_weight(findings, surface);
            let facts = vec![weight, findings.surface(surface, EntityField::Whole)];
            let reason = if findings.facts.summaries[surface].mirrors {
                format!("{key} > 0 on a visible surface")
            } else {
                "total internal reflection is possible".to_owned()
            };
            EffectStatus::needed(effect, reason, facts)
        }
        None => no_mirror(findings, effect, vec![]),
    }
}

/// The visible materials without reflection, if others have it.
fn materials_without_mirror(findings: &RuleResults<'_>) -> impl Iterator<Item = EffectStatus> {
    let is_needed = findings.max_depth > 0 && findings.any(MaterialSummary::has_bounce);
    let surfaces = findings
        .materials_without(MaterialSummary::has_bounce)
        .filter(move |_| is_needed);
    surfaces.map(|surface| {
        let (key, weight) = mirror_weight(findings, surface);
        let reason = format!("its {key} is 0");
        let status = EffectStatus::pruned(Effect::Mirror, Rule::MirrorKs, reason, vec![weight]);
        status.of(findings.material(surface, EntityField::Whole))
    })
}

fn glossy(findings: &RuleResults<'_>) -> EffectStatus {
    let effect = Effect::GlossyReflection;
    let materials = &findings.facts.materials;
    if materials
        .iter()
        .all(|material| material.glossy_samples.get() == 1)
    {
        return EffectStatus::absent(effect, "all reflections are perfect: one sample", vec![])
            .by(Rule::GlossyMirror);
    }
    if let Some(status) = no_bounce(findings, effect, |_| true) {
        return status;
    }
    match findings.first(|summary| summary.glossy && summary.has_bounce()) {
        Some(surface) => {
            let count = materials[findings.facts.scene.surfaces()[surface].material].glossy_samples;
            let facts = vec![
                findings.material(surface, EntityField::GlossySamples),
                findings.surface(surface, EntityField::Whole),
            ];
            EffectStatus::needed(effect, format!("{count} rays per glossy lobe"), facts)
        }
        None => {
            let reason = "no visible glossy surface has ks > 0";
            EffectStatus::pruned(effect, Rule::GlossyMirror, reason, vec![])
        }
    }
}

fn refraction(findings: &RuleResults<'_>) -> EffectStatus {
    let effect = Effect::Refraction;
    let materials = &findings.facts.materials;
    if materials.iter().all(|material| material.kt.get() == 0.0) {
        return EffectStatus::absent(effect, "no material transmits light", vec![])
            .by(Rule::Opaque);
    }
    if let Some(status) = no_bounce(findings, effect, |_| true) {
        return status;
    }
    match findings.first(|summary| summary.refracts) {
        Some(surface) => {
            let facts = vec![
                findings.material(surface, EntityField::Kt),
                findings.surface(surface, EntityField::Whole),
            ];
            EffectStatus::needed(effect, "kt > 0 on a visible surface", facts)
        }
        None => {
            let unseen = findings.first_unseen(|summary| summary.refracts);
            let facts = first_n(
                unseen
                    .iter()
                    .map(|surface| findings.surface(*surface, EntityField::Whole)),
            );
            EffectStatus::pruned(effect, Rule::Opaque, "no visible surface has kt > 0", facts)
        }
    }
}
