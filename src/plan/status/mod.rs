//! The verdicts: whether the picture needs each effect, and by which values, or the rule that left
//! it out, and the reason.

mod light;
mod mirror;
mod picture;

use super::effect::{Effect, EffectStatus, State};
use super::pixel_classes::PixelClasses;
use super::rules::Rule;
use super::{Findings, MaterialSummary};
use rtc_ir::{EntityKind, Field, ValuePath};
use rtc_valid::Mode;

/// The maximum number of verdicts on single lights or materials for one effect.
const MAX_DETAILS: usize = 24;

/// The verdicts on all effects, each followed by those on single entities.
pub(super) fn statuses(findings: &Findings<'_>, pixel_classes: &PixelClasses) -> Vec<EffectStatus> {
    let mut all = picture::buffers(findings, pixel_classes);
    all.extend(light::statuses(findings));
    all.extend(mirror::statuses(findings));
    all.extend(picture::maps(findings));
    all.push(picture::lens(findings));
    all.push(picture::supersampling(findings, pixel_classes));
    all
}

fn settings(field: Field) -> ValuePath {
    ValuePath::new(EntityKind::Settings, 0, field)
}

fn camera(field: Field) -> ValuePath {
    ValuePath::new(EntityKind::Camera, 0, field)
}

fn light(index: usize, field: Field) -> ValuePath {
    ValuePath::new(EntityKind::Light, index, field)
}

impl EffectStatus {
    fn needed(effect: Effect, reason: impl Into<String>, facts: Vec<ValuePath>) -> Self {
        Self {
            effect,
            of: None,
            state: State::Needed,
            rule: None,
            reason: reason.into(),
            facts,
        }
    }

    fn absent(effect: Effect, reason: impl Into<String>, facts: Vec<ValuePath>) -> Self {
        Self {
            effect,
            of: None,
            state: State::Absent,
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
            state: State::Pruned,
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

    /// Adds the rule by whose definition the effect is absent.
    fn by(self, rule: Rule) -> Self {
        Self {
            rule: Some(rule),
            ..self
        }
    }
}

impl Findings<'_> {
    /// The place of a surface in the IR.
    fn surface(&self, surface: usize, field: Field) -> ValuePath {
        ValuePath::new(
            EntityKind::Surface,
            self.facts.scene.surfaces()[surface].index,
            field,
        )
    }

    /// The place of a value of the material of a surface.
    fn material(&self, surface: usize, field: Field) -> ValuePath {
        ValuePath::new(
            EntityKind::Material,
            self.facts.scene.surfaces()[surface].material,
            field,
        )
    }

    /// The first surface that is seen and has nonzero terms.
    fn first(&self, shows: impl Fn(&MaterialSummary) -> bool) -> Option<usize> {
        self.visible()
            .find(|surface| shows(&self.facts.summaries[*surface]))
    }

    /// The first surface that has nonzero terms but is not seen.
    fn first_unseen(&self, shows: impl Fn(&MaterialSummary) -> bool) -> Option<usize> {
        let mut surfaces = 0..self.facts.summaries.len();
        surfaces.find(|surface| {
            !self.visibility.visible[*surface] && shows(&self.facts.summaries[*surface])
        })
    }

    /// The materials without a seen surface that has nonzero terms, each with one of its surfaces.
    fn materials_without(
        &self,
        shows: impl Fn(&MaterialSummary) -> bool,
    ) -> impl Iterator<Item = usize> {
        let mut without = vec![None; self.facts.materials.len()];
        for surface in self.visible() {
            let first =
                without[self.facts.scene.surfaces()[surface].material].get_or_insert(Some(surface));
            *first = first.filter(|_| !shows(&self.facts.summaries[surface]));
        }
        without.into_iter().flatten().flatten()
    }

    /// The verdict on an effect of shading in a mode without it, or with another form of it.
    fn by_mode(&self, effect: Effect, requested: bool) -> Option<EffectStatus> {
        let reason = match self.mode() {
            Mode::Phong | Mode::Path(_) => return None,
            Mode::Gooch(_) => "Gooch's shading has none",
            Mode::Normal => "a normal buffer shows the first hit alone",
            Mode::Zbuffer => "a depth buffer shows the first hit alone",
        };
        let facts = vec![settings(Field::Mode)];
        Some(if requested {
            EffectStatus::pruned(effect, Rule::Mode, reason, facts)
        } else {
            EffectStatus::absent(effect, reason, facts).by(Rule::Mode)
        })
    }
}

/// The first few of many places.
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
