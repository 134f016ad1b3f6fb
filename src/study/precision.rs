//! What each arithmetic costs: the same samples of the same scene, by all three.

use super::knob::Setting;
use super::metrics::Errors;
use super::race::{Runner, race};
use super::statistics::{Chance, Estimate};
use super::subject::{Stopped, Subject};
use crate::plan::Arithmetic;
use serde::{Deserialize, Serialize};

/// What a scene is by one arithmetic.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "camelCase")]
pub struct PrecisionCost {
    /// Its name.
    pub arithmetic: String,
    /// Processor seconds over those of the robust one.
    pub ratio: Estimate,
    /// How far the picture is from that of the robust one.
    pub difference: Errors,
}

/// The arithmetics, the robust one first, with what each costs in a setting.
pub(super) fn costs(
    subject: &Subject<'_>,
    setting: Setting,
    budget: u64,
    chance: &mut Chance,
) -> Result<Vec<PrecisionCost>, Stopped> {
    let all = [("robust", Arithmetic::Robust), ("plain", Arithmetic::Plain), ("f32", Arithmetic::F32)];
    let runners = all.map(|(_, arithmetic)| Runner { subject: subject.by(arithmetic), setting });
    let race = race(&runners, budget, chance)?;
    let robust = &race.runs[0].shot.tiles;
    let cost = |((name, _), run): (&(&str, Arithmetic), &super::race::Run)| PrecisionCost {
        arithmetic: (*name).to_owned(),
        ratio: run.ratio,
        difference: Errors::of(&run.shot.tiles, robust, subject.share()),
    };
    Ok(all.iter().zip(&race.runs).map(cost).collect())
}
