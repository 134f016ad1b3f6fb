//! The status of each effect of the Whitted integrator: whether the picture needs it, the reason,
//! the scene values that decide, and the rule that removed it.
//!
//! Each function of the submodules decides one effect from the [`RuleResults`], in a fixed order:
//! needed if any visible surface requires it; absent if the scene does not have it at all;
//! otherwise pruned, with the rule that removed it. Submodules:
//!
//! - [`mod@light`]: direct light, shadows, area lights, highlights;
//! - [`mirror`]: bounces, reflection, glossy lobes, refraction;
//! - [`picture`]: buffers, surfaces, textures, normals, lens, supersampling.
//!
//! A status for the whole scene may be followed by statuses of single lights or materials, at most
//! [`MAX_DETAILS`]. The path integrator has its own [`crate::path`] statuses.

mod light;
mod mirror;
mod picture;

use super::effect::{Effect, EffectState, EffectStatus};
use super::pixel_classes::PixelClassGrid;
use super::rules::Rule;
use super::{MaterialSummary, RuleResults};
use rtc_ir::{EntityField, EntityKind, ValuePath};
use rtc_math::IdTable;
use rtc_valid::{CourseLightId, Light, Material, Mode};

/// The maximum number of statuses of single lights or materials for one effect.
const MAX_DETAILS: usize = 24;

/// The status of each effect, followed by those of single entities.
pub(super) fn statuses(
    findings: &RuleResults<'_>,
    pixel_classes: &PixelClassGrid,
) -> Vec<EffectStatus> {
    let mut all = picture::buffers(findings, pixel_classes);
    all.extend(light::statuses(findings));
    all.extend(mirror::statuses(findings));
    all.extend(picture::maps(findings));
    all.push(picture::lens(findings));
    all.push(picture::supersampling(findings, pixel_classes));
    all
}

fn settings(field: EntityField) -> ValuePath {
    ValuePath::new(EntityKind::Settings, 0, field)
}

fn camera(field: EntityField) -> ValuePath {
    ValuePath::new(EntityKind::Camera, 0, field)
}

impl EffectStatus {
    fn needed(effect: Effect, reason: impl Into<String>, facts: Vec<ValuePath>) -> Self {
        Self {
            effect,
            of: None,
            state: EffectState::Needed,
            rule: None,
            reason: reason.into(),
            facts,
        }
    }

    fn absent(effect: Effect, reason: impl Into<String>, facts: Vec<ValuePath>) -> Self {
        Self {
            effect,
            of: None,
            state: EffectState::Absent,
            rule: None,
            reason: reason.into(),
            facts,
        }
    }

    fn pruned(
        effect: Effect,
        rule: Rule,
        reason: impl Into<String>,
        facts: Vec<ValuePath>,
    ) -> Self {
        Self {
            effect,
            of: None,
            state: EffectState::Pruned,
            rule: Some(rule),
            reason: reason.into(),
            facts,
        }
    }

    fn of(self, place: ValuePath) -> Self {
        Self {
            of: Some(place),
            ..self
        }
    }

    /// Adds the rule that explains the absence.
    fn by(self, rule: Rule) -> Self {
        Self {
            rule: Some(rule),
            ..self
        }
    }
}

impl RuleResults<'_> {
    /// The path of a light of the course in the IR, which has lights of other kinds as well.
    fn light(&self, id: CourseLightId, field: EntityField) -> ValuePath {
        let lights = self.facts.scene.lights().iter().enumerate();
        let mut course = lights.filter(|(_, light)| matches!(light, Light::Course(_)));
        let index = course.nth(id.index()).map_or(0, |(index, _)| index);
        ValuePath::new(EntityKind::Light, index, field)
    }

    /// The path of a surface in the IR.
    fn surface(&self, surface: usize, field: EntityField) -> ValuePath {
        ValuePath::new(
            EntityKind::Surface,
            self.facts.scene.surfaces()[surface].index,
            field,
        )
    }

    /// The path of a value of a surface's material in the IR.
    fn material(&self, surface: usize, field: EntityField) -> ValuePath {
        ValuePath::new(
            EntityKind::Material,
            self.facts.scene.surfaces()[surface].material.index(),
            field,
        )
    }

    /// The first visible surface whose material has a property.
    fn first(&self, shows: impl Fn(&MaterialSummary) -> bool) -> Option<usize> {
        self.visible()
            .find(|surface| shows(&self.facts.summaries[*surface]))
    }

    /// The first invisible surface whose material has a property.
    fn first_unseen(&self, shows: impl Fn(&MaterialSummary) -> bool) -> Option<usize> {
        let mut surfaces = 0..self.facts.summaries.len();
        surfaces.find(|surface| {
            !self.visibility.visible[*surface] && shows(&self.facts.summaries[*surface])
        })
    }

    /// The materials of visible surfaces that do not have a property, each with one of its
    /// surfaces.
    fn materials_without(
        &self,
        shows: impl Fn(&MaterialSummary) -> bool,
    ) -> impl Iterator<Item = usize> {
        let mut without = IdTable::<Material, _>::from(vec![None; self.facts.materials.len()]);
        for surface in self.visible() {
            let first =
                without[self.facts.scene.surfaces()[surface].material].get_or_insert(Some(surface));
            *first = first.filter(|_| !shows(&self.facts.summaries[surface]));
        }
        without.into_iter().flatten().flatten()
    }

    /// The status of a shading effect in a mode that does not have it.
    fn by_mode(&self, effect: Effect, requested: bool) -> Option<EffectStatus> {
        let reason = match self.mode() {
            Mode::Phong | Mode::Path(_) => return None,
            Mode::Gooch(_) => "Gooch shading does not have it",
            Mode::Normal => "a normal buffer is a function of the first hit",
            Mode::Depth => "a depth buffer is a function of the first hit",
        };
        let facts = vec![settings(EntityField::Mode)];
        Some(if requested {
            EffectStatus::pruned(effect, Rule::Mode, reason, facts)
        } else {
            EffectStatus::absent(effect, reason, facts).by(Rule::Mode)
        })
    }
}

/// The first few distinct paths.
fn first_n(places: impl Iterator<Item = ValuePath>) -> Vec<ValuePath> {
    const MAX_FACTS: usize = 3;
    let mut first_n = Vec::with_capacity(MAX_FACTS);
    for place in places {
        if !first_n.contains(&place) {
            first_n.push(place);
        }
        if first_n.len() == MAX_FACTS {
            break;
        }
    }
    first_n
}
