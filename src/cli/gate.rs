//! Gates: limits of measured numbers, for which a command ends with exit code 1 where one is not met.

use serde::Serialize;
use std::fmt;

/// The measures of a difference of two pictures.
const MEASURES: [&str; 5] = ["rmse", "max", "relmse", "flip", "share"];

/// Limits, as `rmse<=1,share<=0.5%`.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Gates(Vec<Gate>);

/// The limit of a measure.
#[derive(Clone, Debug, PartialEq)]
struct Gate {
    measure: &'static str,
    most: f64,
}

/// Reads gates as typed.
///
/// # Errors
/// If something else is written; in words that name what may be.
pub(super) fn gates(text: &str) -> Result<Gates, String> {
    text.split(',')
        .map(|gate| Gate::read(gate.trim()))
        .collect::<Result<_, _>>()
        .map(Gates)
}

impl Gate {
    fn read(text: &str) -> Result<Self, String> {
        let (name, most) = text
            .split_once("<=")
            .ok_or_else(|| format!("`{text}` is no gate; write `MEASURE<=VALUE`, as `rmse<=1`"))?;
        let (name, most) = (name.trim(), most.trim());
        let measure = MEASURES.into_iter().find(|measure| *measure == name);
        let measure = measure.ok_or_else(|| {
            let all = MEASURES.join(", ");
            format!("there is no measure `{name}`; measures are {all}")
        })?;
        let number = |text: &str| {
            text.trim()
                .parse::<f64>()
                .ok()
                .filter(|value| *value >= 0.0)
        };
        let most = match most.strip_suffix('%') {
            Some(percent) if measure == "share" => number(percent).map(|value| value / 100.0),
            Some(_) => return Err(format!("`{measure}` is no share, so its limit has no `%`")),
            None => number(most),
        };
        let most =
            most.ok_or_else(|| format!("the limit of `{measure}` must be a number of at least 0"))?;
        Ok(Self { measure, most })
    }
}

/// A gate, and what was measured.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct JudgedGate {
    measure: &'static str,
    value: f64,
    most: f64,
    pub(super) is_met: bool,
}

impl Gates {
    /// Which gates are met, given the measures.
    pub(super) fn judged(&self, measured: impl Fn(&str) -> f64) -> Vec<JudgedGate> {
        let judged = |gate: &Gate| {
            let (measure, most, value) = (gate.measure, gate.most, measured(gate.measure));
            JudgedGate {
                measure,
                value,
                most,
                is_met: value <= most,
            }
        };
        self.0.iter().map(judged).collect()
    }
}

impl fmt::Display for JudgedGate {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self {
            measure,
            value,
            most,
            is_met,
        } = self;
        let words = if *is_met { "met" } else { "not met" };
        write!(
            f,
            "gate {words}: {measure} is {value:.6}, at most {most} wanted"
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn gates_are_read() {
        let read = gates("rmse<=1, share <= 0.5%,flip<=2e-2").unwrap();
        let expected = [("rmse", 1.0), ("share", 0.005), ("flip", 0.02)];
        assert_eq!(
            read,
            Gates(
                expected
                    .map(|(measure, most)| Gate { measure, most })
                    .into()
            )
        );
    }

    #[test]
    fn what_is_wrong_with_a_gate_is_named() {
        for (text, words) in [
            ("rmse<1", "write `MEASURE<=VALUE`"),
            ("rsme<=1", "no measure `rsme`"),
            ("speed<=1", "measures are rmse, max"),
            ("rmse<=1%", "no `%`"),
            ("rmse<=-1", "at least 0"),
            ("rmse<=nan", "at least 0"),
            ("rmse<=1,", "is no gate"),
        ] {
            let error = gates(text).unwrap_err();
            assert!(error.contains(words), "{text}: {error}");
        }
    }

    #[test]
    fn a_gate_is_met_up_to_its_limit() {
        let gates = gates("rmse<=1,max<=3").unwrap();
        let judged = gates.judged(|name| if name == "rmse" { 1.0 } else { 3.5 });
        assert_eq!(
            judged.iter().map(|gate| gate.is_met).collect::<Vec<_>>(),
            [true, false]
        );
        assert_eq!(
            judged[1].to_string(),
            "gate not met: max is 3.500000, at most 3 wanted"
        );
    }
}
