//! The limits of `--gate` on measured values. A command exits with code 1 if one is exceeded.

use super::{Failure, reporter};
use schemars::JsonSchema;
use serde::Serialize;
use std::fmt;

/// The unit after a limit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum LimitUnit {
    /// Nothing.
    Plain,
    /// `%`: a fraction in hundredths.
    Share,
    /// `x`: a ratio.
    Ratio,
}

/// The measures of a command.
type MeasuredValues = [(&'static str, LimitUnit)];

/// The measures of the difference of two pictures.
const OF_PICTURES: &MeasuredValues = &[
    ("rmse", LimitUnit::Plain),
    ("max", LimitUnit::Plain),
    ("relmse", LimitUnit::Plain),
    ("flip", LimitUnit::Plain),
    ("share", LimitUnit::Share),
];

/// The measures of one scene against another.
const OF_SCENES: &MeasuredValues = &[
    ("error", LimitUnit::Plain),
    ("time", LimitUnit::Ratio),
    ("rays", LimitUnit::Ratio),
    ("noise", LimitUnit::Ratio),
];

/// The limits of a `--gate`, as `rmse<=1,share<=0.5%`.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct MeasureLimits(Vec<MeasureLimit>);

/// The limit of a measure.
#[derive(Clone, Debug, PartialEq)]
struct MeasureLimit {
    measure: &'static str,
    most: f64,
}

/// Reads gates of the difference of two pictures as typed.
///
/// # Errors
/// If the text is not a gate; the message lists the valid measures.
pub(super) fn picture_limits(text: &str) -> Result<MeasureLimits, String> {
    gates(text, OF_PICTURES)
}

/// Reads gates of one scene against another as typed.
///
/// # Errors
/// As [`picture_limits`].
pub(super) fn scene_limits(text: &str) -> Result<MeasureLimits, String> {
    gates(text, OF_SCENES)
}

fn gates(text: &str, measures: &MeasuredValues) -> Result<MeasureLimits, String> {
    text.split(',')
        .map(|gate| MeasureLimit::read(gate.trim(), measures))
        .collect::<Result<_, _>>()
        .map(MeasureLimits)
}

/// Reports each gate, or in quiet mode only the failed ones; an error if one failed.
pub(super) fn pass(gates: &[GateResult], is_quiet: bool) -> Result<(), Failure> {
    let reported = gates.iter().filter(|gate| !(gate.passed && is_quiet));
    reported.for_each(|gate| reporter::print_message(&gate.to_string()));
    match gates.iter().all(|gate| gate.passed) {
        true => Ok(()),
        false => Err(Failure::Reported),
    }
}

impl MeasureLimit {
    fn read(text: &str, measures: &MeasuredValues) -> Result<Self, String> {
        let (name, most) = text.split_once("<=").ok_or_else(|| {
            let first = measures[0].0;
            format!("`{text}` is no gate; write `MEASURE<=VALUE`, as `{first}<=1`")
        })?;
        let (name, most) = (name.trim(), most.trim());
        let measure = measures.iter().find(|(measure, _)| *measure == name);
        let (measure, unit) = measure.copied().ok_or_else(|| {
            let all: Vec<_> = measures.iter().map(|(name, _)| *name).collect();
            let all = all.join(", ");
            format!("there is no measure `{name}`; measures are {all}")
        })?;
        let number = |text: &str| {
            text.trim()
                .parse::<f64>()
                .ok()
                .filter(|value| *value >= 0.0)
        };
        let most = match (most.strip_suffix('%'), most.strip_suffix('x')) {
            (Some(percent), _) if unit == LimitUnit::Share => {
                number(percent).map(|value| value / 100.0)
            }
            (Some(_), _) => {
                return Err(format!("`{measure}` is no share, so its limit has no `%`"));
            }
            (None, Some(times)) if unit == LimitUnit::Ratio => number(times),
            (None, Some(_)) => {
                return Err(format!("`{measure}` is no ratio, so its limit has no `x`"));
            }
            (None, None) => number(most),
        };
        let most =
            most.ok_or_else(|| format!("the limit of `{measure}` must be a number of at least 0"))?;
        Ok(Self { measure, most })
    }
}

/// A gate and its measured value.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, JsonSchema)]
#[serde(rename_all = "camelCase")]
pub(super) struct GateResult {
    /// The name of the measure.
    measure: &'static str,
    /// The measured value.
    value: f64,
    /// The limit.
    most: f64,
    /// Whether the value is within the limit.
    #[serde(rename = "isMet")]
    pub(super) passed: bool,
}

impl MeasureLimits {
    /// The gates with their measured values.
    pub(super) fn results(&self, measured: impl Fn(&str) -> f64) -> Vec<GateResult> {
        let results = |gate: &MeasureLimit| {
            let (measure, most, value) = (gate.measure, gate.most, measured(gate.measure));
            GateResult {
                measure,
                value,
                most,
                passed: value <= most,
            }
        };
        self.0.iter().map(results).collect()
    }
}

impl fmt::Display for GateResult {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self {
            measure,
            value,
            most,
            passed,
        } = self;
        let message = if *passed { "passed" } else { "failed" };
        write!(f, "gate {message}: {measure} is {value:.6}, limit {most}")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn gates_are_read() {
        let gates = |limits: &[(&'static str, f64)]| {
            let gate = |(measure, most): &(&'static str, f64)| MeasureLimit {
                measure,
                most: *most,
            };
            MeasureLimits(limits.iter().map(gate).collect())
        };
        assert_eq!(
            picture_limits("rmse<=1, share <= 0.5%,flip<=2e-2").unwrap(),
            gates(&[("rmse", 1.0), ("share", 0.005), ("flip", 0.02)])
        );
        assert_eq!(
            scene_limits("error<=0.5,time<=1.2x,rays<=2").unwrap(),
            gates(&[("error", 0.5), ("time", 1.2), ("rays", 2.0)])
        );
    }

    #[test]
    fn what_is_wrong_with_a_gate_is_named() {
        for (text, message) in [
            ("rmse<1", "write `MEASURE<=VALUE`"),
            ("rsme<=1", "no measure `rsme`"),
            ("speed<=1", "measures are rmse, max"),
            ("rmse<=1%", "no `%`"),
            ("rmse<=-1", "at least 0"),
            ("rmse<=nan", "at least 0"),
            ("rmse<=1,", "is no gate"),
        ] {
            let error = picture_limits(text).unwrap_err();
            assert!(error.contains(message), "{text}: {error}");
        }
        for (text, message) in [
            ("error<=1x", "no `x`"),
            ("time<=10%", "no `%`"),
            ("rmse<=1", "error, time"),
        ] {
            let error = scene_limits(text).unwrap_err();
            assert!(error.contains(message), "{text}: {error}");
        }
    }

    #[test]
    fn a_gate_is_met_up_to_its_limit() {
        let gates = picture_limits("rmse<=1,max<=3").unwrap();
        let results = gates.results(|name| if name == "rmse" { 1.0 } else { 3.5 });
        assert_eq!(
            results.iter().map(|gate| gate.passed).collect::<Vec<_>>(),
            [true, false]
        );
        assert_eq!(
            results[1].to_string(),
            "gate failed: max is 3.500000, limit 3"
        );
    }
}
