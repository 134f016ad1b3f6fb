//! The cost of each arithmetic: the same samples of the same scene with all three.

use super::benchmark::{BenchmarkCase, TimedRun, benchmark};
use super::metrics::PictureErrors;
use super::outcome::RayTotals;
use super::parameter::{Parameter, precision_value, tolerates};
use super::reference::ParameterLevel;
use super::setting::Setting;
use super::statistics::{Estimate, SplitMix64};
use super::subject::{Stopped, StudySubject};
use super::sweep::ParameterSweep;
use rtc_plan::Arithmetic;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A scene rendered with one arithmetic.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "camelCase")]
pub struct PrecisionCost {
    /// The arithmetic.
    pub arithmetic: Arithmetic,
    /// Whether no visible loss is expected. Only then rows may use it.
    #[serde(rename = "borne")]
    pub is_tolerated: bool,
    /// The rays of the rendered part: rules that are proven only for the robust arithmetic do not
    /// apply to the others.
    pub rays: RayTotals,
    /// Processor seconds over those of the robust one.
    pub ratio: Estimate,
    /// The difference from the picture of the robust one.
    pub difference: PictureErrors,
}

#[cfg(feature = "cli")]
impl PrecisionCost {
    /// Its name, and whether there is a warning.
    pub(super) fn label(&self) -> String {
        format!(
            "{}{}",
            self.arithmetic.name(),
            if self.is_tolerated {
                ""
            } else {
                " (with a warning)"
            }
        )
    }
}

/// More paths do not change the comparison.
const PATHS: u32 = 16;

/// The arithmetics, the robust one first, with the cost of each in a setting.
pub(super) fn costs(
    subject: &StudySubject<'_>,
    setting: Setting,
    budget: u64,
    rng: &mut SplitMix64,
) -> Result<Vec<PrecisionCost>, Stopped> {
    let case = |precision| BenchmarkCase {
        subject: subject.clone(),
        setting: Setting {
            precision,
            paths: setting.paths.min(PATHS),
            ..setting
        },
    };
    let benchmark = benchmark(&Arithmetic::ALL.map(case), budget, None, rng)?;
    let robust = &benchmark.runs[0].rendered.tiles;
    let cost = |(arithmetic, run): (Arithmetic, &TimedRun)| PrecisionCost {
        arithmetic,
        is_tolerated: tolerates(&subject.scene, arithmetic),
        rays: run.rendered.counts.into(),
        ratio: run.ratio,
        difference: PictureErrors::of(&run.rendered.tiles, robust, subject.fraction()),
    };
    Ok(Arithmetic::ALL
        .into_iter()
        .zip(&benchmark.runs)
        .map(cost)
        .collect())
}

/// The precision as a parameter alone, over the arithmetics allowed in rows. Its error has no
/// sampling noise.
pub(super) fn levels(costs: &[PrecisionCost]) -> ParameterSweep {
    let level = |cost: &PrecisionCost| ParameterLevel {
        value: precision_value(cost.arithmetic),
        error: cost.difference.rmse,
        resolved: true,
        rays: cost.rays.all(),
    };
    let levels = costs
        .iter()
        .rev()
        .filter(|cost| cost.is_tolerated)
        .map(level)
        .collect();
    ParameterSweep {
        parameter: Parameter::Precision,
        levels,
        law: None,
    }
}
