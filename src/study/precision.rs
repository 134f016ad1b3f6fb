//! What each arithmetic costs: the same samples of the same scene, by all three.

use super::knob::{Knob, bears, place};
use super::metrics::Errors;
use super::outcome::Rays;
use super::race::{Runner, TimedRun, race};
use super::reference::Level;
use super::setting::Setting;
use super::statistics::{Estimate, Rng};
use super::subject::{Stopped, Subject};
use super::sweep::Levels;
use crate::plan::Arithmetic;
use serde::{Deserialize, Serialize};

/// What a scene is by one arithmetic.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "camelCase")]
pub struct PrecisionCost {
    /// The arithmetic.
    pub arithmetic: Arithmetic,
    /// Whether the plan expects nothing to show of what it loses; only then rows may be of it.
    pub borne: bool,
    /// The rays of the part looked at: what is proven for the robust one alone is not left out by
    /// others.
    pub rays: Rays,
    /// Processor seconds over those of the robust one.
    pub ratio: Estimate,
    /// How far the picture is from that of the robust one.
    pub difference: Errors,
}

impl PrecisionCost {
    /// Its name, and whether it is warned of.
    pub(super) fn words(&self) -> String {
        format!(
            "{}{}",
            self.arithmetic.name(),
            if self.borne { "" } else { " (warned of)" }
        )
    }
}

/// The arithmetics, the robust one first, with what each costs in a setting.
pub(super) fn costs(
    subject: &Subject<'_>,
    setting: Setting,
    budget: u64,
    rng: &mut Rng,
) -> Result<Vec<PrecisionCost>, Stopped> {
    let runner = |precision| Runner {
        subject: subject.clone(),
        setting: Setting {
            precision,
            ..setting
        },
    };
    let race = race(&Arithmetic::ALL.map(runner), budget, rng)?;
    let robust = &race.runs[0].shot.tiles;
    let cost = |(arithmetic, run): (Arithmetic, &TimedRun)| PrecisionCost {
        arithmetic,
        borne: bears(&subject.scene, arithmetic),
        rays: run.shot.counts.into(),
        ratio: run.ratio,
        difference: Errors::of(&run.shot.tiles, robust, subject.fraction()),
    };
    Ok(Arithmetic::ALL
        .into_iter()
        .zip(&race.runs)
        .map(cost)
        .collect())
}

/// The precision as a knob alone, of the arithmetics that rows may be of. It samples nothing, so no
/// noise hides its error.
pub(super) fn levels(costs: &[PrecisionCost]) -> Levels {
    let level = |cost: &PrecisionCost| Level {
        value: place(cost.arithmetic),
        error: cost.difference.rmse,
        resolved: true,
        rays: cost.rays.all(),
    };
    let levels = costs
        .iter()
        .rev()
        .filter(|cost| cost.borne)
        .map(level)
        .collect();
    Levels {
        knob: Knob::Precision,
        levels,
        law: None,
    }
}
