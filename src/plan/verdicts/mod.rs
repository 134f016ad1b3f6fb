//! The verdicts: whether the picture needs each effect, and by which values, or the rule that left
//! it out, and the reason.

mod light;
mod mirror;
mod picture;

use super::effect::{Effect, EffectStatus, State};
use super::region::Region;
use super::rules::Rule;
use super::{Findings, MaterialSummary};
use rtc_ir::{EntityKind, Field, ValuePath};
use rtc_valid::Mode;

/// The maximum number of verdicts on single lights or materials for one effect.
const MAX_DETAILS: usize = 24;

/// The verdicts on all effects, each followed by those on single entities.
pub(super) fn verdicts(findings: &Findings<'_>, region: &Region) -> Vec<EffectStatus> {
    let mut all = picture::buffers(findings, region);
    all.extend(light::verdicts(findings));
    all.extend(mirror::verdicts(findings));
    all.extend(picture::maps(findings));
    all.push(picture::lens(findings));
    all.push(picture::supersampling(findings, region));
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
    fn needed(effect: Effect, because: impl Into<String>, facts: Vec<ValuePath>) -> Self {
        Self {
            effect,
            of: None,
            state: State::Needed,
            rule: None,
            because: because.into(),
            facts,
        }
    }

    fn absent(effect: Effect, because: impl Into<String>, facts: Vec<ValuePath>) -> Self {
        Self {
            effect,
            of: None,
            state: State::Absent,
            rule: None,
            because: because.into(),
            facts,
        }
    }

    fn pruned(
        effect: Effect,
        rule: Rule,
        because: impl Into<String>,
        facts: Vec<ValuePath>,
    ) -> Self {
        Self {
            effect,
            of: None,
            state: State::Pruned,
            rule: Some(rule),
            because: because.into(),
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
        self.reached()
            .find(|surface| shows(&self.facts.summaries[*surface]))
    }

    /// The first surface that has nonzero terms but is not seen.
    fn first_unseen(&self, shows: impl Fn(&MaterialSummary) -> bool) -> Option<usize> {
        let mut surfaces = 0..self.facts.summaries.len();
        surfaces.find(|surface| {
            !self.visibility.reached[*surface] && shows(&self.facts.summaries[*surface])
        })
    }

    /// The materials without a seen surface that has nonzero terms, each with one of its surfaces.
    fn materials_without(
        &self,
        shows: impl Fn(&MaterialSummary) -> bool,
    ) -> impl Iterator<Item = usize> {
        let mut without = vec![None; self.facts.materials.len()];
        for surface in self.reached() {
            let first =
                without[self.facts.scene.surfaces()[surface].material].get_or_insert(Some(surface));
            *first = first.filter(|_| !shows(&self.facts.summaries[surface]));
        }
        without.into_iter().flatten().flatten()
    }

    /// The verdict on an effect of shading in a mode without it, or with another form of it.
    fn by_mode(&self, effect: Effect, asked: bool) -> Option<EffectStatus> {
        let words = match self.mode() {
            Mode::Phong | Mode::Path(_) => return None,
            Mode::Gooch(_) => "Gooch's shading has none",
            Mode::Normal => "a normal buffer shows the first hit alone",
            Mode::Zbuffer => "a depth buffer shows the first hit alone",
        };
        let facts = vec![settings(Field::Mode)];
        Some(if asked {
            EffectStatus::pruned(effect, Rule::Mode, words, facts)
        } else {
            EffectStatus::absent(effect, words, facts).by(Rule::Mode)
        })
    }
}

/// The first few of many places.
fn few(places: impl Iterator<Item = ValuePath>) -> Vec<ValuePath> {
    const FEW: usize = 3;
    let mut few = Vec::with_capacity(FEW);
    for place in places {
        if !few.contains(&place) {
            few.push(place);
        }
        if few.len() == FEW {
            break;
        }
    }
    few
}
