//! The status of direct light, shadows, area lights and highlights.

use super::{MAX_DETAILS, first_n, settings};
use crate::effect::{Effect, EffectStatus};
use crate::light::PossibleShadow;
use crate::rules::Rule;
use crate::{MaterialSummary, RuleResults};
use rtc_ir::{EntityField, ValuePath};
use rtc_valid::{CourseLightId, Mode};

pub(super) fn statuses(findings: &RuleResults<'_>) -> Vec<EffectStatus> {
    let mut all = vec![direct(findings)];
    all.extend(per_light(findings).take(MAX_DETAILS));
    all.push(shadows(findings));
    all.push(soft(findings));
    all.push(highlight(findings));
    all.extend(materials_without_highlight(findings).take(MAX_DETAILS));
    all
}

/// The reason why a rule removed the direct terms of a light, and the scene values that decided.
fn reason(
    findings: &RuleResults<'_>,
    index: CourseLightId,
    rule: Rule,
) -> (&'static str, Vec<ValuePath>) {
    if rule == Rule::LightBlack {
        return (
            "its colour is 0",
            vec![findings.light(index, EntityField::Color)],
        );
    }
    if rule == Rule::Mode {
        return (
            "the mode renders only the first hit",
            vec![settings(EntityField::Mode)],
        );
    }
    if rule == Rule::LightBehind {
        let mut facts = vec![findings.light(index, EntityField::Position)];
        facts.extend(first_n(
            findings
                .visible()
                .map(|surface| findings.surface(surface, EntityField::Whole)),
        ));
        return ("it is behind all visible surfaces", facts);
    }
    let facts = first_n(
        findings
            .visible()
            .map(|surface| findings.material(surface, EntityField::Kd)),
    );
    ("kd·C and ks are 0 on all visible surfaces", facts)
}

fn direct(findings: &RuleResults<'_>) -> EffectStatus {
    let effect = Effect::DirectLight;
    // Absent without lights or shading.
    let lights = &findings.facts.sources;
    if lights.is_empty() {
        return EffectStatus::absent(effect, "the scene has no light", vec![]);
    }
    if !findings.is_shaded() {
        return findings
            .by_mode(effect, true)
            .unwrap_or_else(|| EffectStatus::absent(effect, "", vec![]));
    }
    // Gooch shading needs all lights.
    if let Mode::Gooch(_) = findings.mode() {
        return EffectStatus::needed(
            effect,
            "Gooch shading depends on the light direction",
            vec![findings.light(CourseLightId::new(0), EntityField::Position)],
        );
    }
    // Needed if any light illuminates a visible surface, otherwise pruned.
    let mut plans = findings.lights.plans.entries();
    let needed = plans
        .find(|(_, light)| light.direct)
        .map(|(index, _)| index);
    match needed.zip(findings.first(MaterialSummary::is_illuminated)) {
        Some((index, surface)) => {
            let count = findings
                .lights
                .plans
                .iter()
                .filter(|light| light.direct)
                .count();
            let facts = vec![
                findings.light(index, EntityField::Position),
                findings.surface(surface, EntityField::Whole),
            ];
            EffectStatus::needed(
                effect,
                format!(
                    "{count} of {} lights illuminate visible surfaces",
                    lights.len()
                ),
                facts,
            )
        }
        None => {
            let rule = findings
                .lights
                .rules
                .iter()
                .flatten()
                .next()
                .copied()
                .unwrap_or(Rule::LightUnreached);
            let (reason, facts) = reason(findings, CourseLightId::new(0), rule);
            EffectStatus::pruned(effect, rule, format!("each light: {reason}"), facts)
        }
    }
}

fn per_light(findings: &RuleResults<'_>) -> impl Iterator<Item = EffectStatus> {
    let rules = findings.lights.rules.entries();
    let shaded = findings.is_shaded();
    rules.filter(move |_| shaded).filter_map(|(index, rule)| {
        let (reason, facts) = reason(findings, index, (*rule)?);
        Some(
            EffectStatus::pruned(Effect::DirectLight, (*rule)?, reason, facts)
                .of(findings.light(index, EntityField::Whole)),
        )
    })
}

fn shadows(findings: &RuleResults<'_>) -> EffectStatus {
    let effect = Effect::Shadows;
    // Absent if the mode or the scene has no shadows.
    let requested = findings.facts.scene.settings().shadows;
    if let Some(status) = findings.by_mode(effect, requested) {
        return status;
    }
    if !requested {
        let reason = "shadows are off in the scene";
        return EffectStatus::absent(effect, reason, vec![]).by(Rule::ShadowOff);
    }
    // Needed if there is a possible shadow.
    if let Some(PossibleShadow {
        light: index,
        occluder,
        receiver,
    }) = findings.lights.shadow
    {
        let facts = vec![
            findings.light(index, EntityField::Position),
            findings.surface(occluder, EntityField::Whole),
            findings.surface(receiver, EntityField::Whole),
        ];
        let reason = match (occluder == receiver, findings.lights.capped) {
            (_, true) => "too many surfaces to test all occluders",
            (true, false) => "a surface may shadow itself",
            (false, false) => "a surface may shadow another",
        };
        return EffectStatus::needed(effect, reason, facts);
    }
    // Absent without shadow casters.
    if findings.facts.occluders().next().is_none() {
        return EffectStatus::absent(effect, "no surface casts shadows", vec![]);
    }
    // Pruned otherwise; find the rule.
    let illuminated = findings.first(|summary| findings.is_illuminated(summary));
    let Some(surface) = illuminated else {
        return EffectStatus::pruned(
            effect,
            Rule::ShadowUnlit,
            "no light contributes more than its ambient term",
            vec![],
        );
    };
    let facts = vec![
        findings.surface(surface, EntityField::Whole),
        findings.light(CourseLightId::new(0), EntityField::Position),
    ];
    if findings.lights.single_surface {
        return EffectStatus::pruned(
            effect,
            Rule::ShadowConvex,
            "the only surface is convex, and the lights are outside",
            facts,
        );
    }
    EffectStatus::pruned(
        effect,
        Rule::ShadowPair,
        "no surface lies between a light and the surfaces it illuminates",
        facts,
    )
}

fn soft(findings: &RuleResults<'_>) -> EffectStatus {
    let effect = Effect::SoftLight;
    // Absent if no light has a radius.
    let (scene, samples) = (findings.facts.scene, settings(EntityField::LightSamples));
    let mut sources = findings.facts.sources.entries();
    let Some((first, _)) = sources.find(|(_, light)| light.radius.get() > 0.0) else {
        return EffectStatus::absent(effect, "no light has a radius", vec![]).by(Rule::SoftPoint);
    };
    if let Some(status) = findings.by_mode(effect, true) {
        return status;
    }
    // Pruned with a single sample; needed if a sampled light contributes.
    let facts = vec![samples, findings.light(first, EntityField::LightRadius)];
    let count = scene.settings().light_samples.get();
    if count == 1 {
        return EffectStatus::pruned(
            effect,
            Rule::SoftPoint,
            "one light sample is the centre of the light",
            facts,
        );
    }
    if findings.is_soft() {
        return EffectStatus::needed(
            effect,
            format!("{count} samples of a light with a radius"),
            facts,
        );
    }
    // Pruned by the rule that removed the light.
    let rule = findings.lights.rules[first].unwrap_or(Rule::LightUnreached);
    let (reason, facts) = reason(findings, first, rule);
    EffectStatus::pruned(effect, rule, format!("soft light: {reason}"), facts)
}

fn highlight(findings: &RuleResults<'_>) -> EffectStatus {
    let effect = Effect::Highlight;
    // Decided by the mode without shading.
    let any_ks = findings
        .facts
        .materials
        .iter()
        .any(|material| material.ks.get() > 0.0);
    if !findings.is_shaded() {
        return findings
            .by_mode(effect, any_ks)
            .unwrap_or_else(|| EffectStatus::absent(effect, "", vec![]));
    }
    // Needed if a visible surface with ks > 0 is illuminated.
    if let Some(surface) =
        findings.first(|summary| summary.is_specular && findings.is_illuminated(summary))
    {
        let facts = vec![
            findings.material(surface, EntityField::Ks),
            findings.surface(surface, EntityField::Whole),
        ];
        return EffectStatus::needed(effect, "ks > 0 on a visible surface", facts);
    }
    // Pruned otherwise; find the rule: no light, invisible, or ks = 0.
    if findings.any(|summary| summary.is_specular) {
        let rule = findings
            .lights
            .rules
            .iter()
            .flatten()
            .next()
            .copied()
            .unwrap_or(Rule::LightUnreached);
        return EffectStatus::pruned(
            effect,
            rule,
            "no light contributes more than its ambient term",
            vec![],
        );
    }
    let unseen = findings.first_unseen(|summary| summary.is_specular);
    if let Some(surface) = unseen.filter(|_| findings.facts.rules.contains(Rule::Cull)) {
        let facts = vec![findings.surface(surface, EntityField::Whole)];
        return EffectStatus::pruned(effect, Rule::Cull, "no visible surface has ks > 0", facts);
    }
    let facts = first_n(
        findings
            .visible()
            .map(|surface| findings.material(surface, EntityField::Ks)),
    );
    EffectStatus::pruned(
        effect,
        Rule::HighlightKs,
        "ks is 0 on all visible surfaces",
        facts,
    )
}

/// The visible materials without a highlight, if others have one.
fn materials_without_highlight(findings: &RuleResults<'_>) -> impl Iterator<Item = EffectStatus> {
    let is_needed = findings.is_shaded() && findings.any(|summary| summary.is_specular);
    let surfaces = findings
        .materials_without(|summary| summary.is_specular)
        .filter(move |_| is_needed);
    surfaces.map(|surface| {
        let facts = vec![findings.material(surface, EntityField::Ks)];
        let status =
            EffectStatus::pruned(Effect::Highlight, Rule::HighlightKs, "its ks is 0", facts);
        status.of(findings.material(surface, EntityField::Whole))
    })
}
