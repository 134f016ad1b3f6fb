//! Texts that several reports share: the meaning of each column, and the best setting within a
//! time.

use super::super::advice::{digits, interval, seconds};
use super::super::outcome::{Study, StudyRow};
use super::super::parameter::Parameter;

/// The meaning of the columns, with their names in the terminal and in the HTML report. Parameters
/// are explained by their long names.
pub(super) const MEANINGS: [(&str, &str, &str); 13] = [
    (
        "*",
        "★",
        "on the Pareto front: no setting as cheap has a lower error",
    ),
    ("rays", "rays", "rays of the whole picture"),
    (
        "time",
        "time",
        "seconds of one processor for the whole picture: the median",
    ),
    ("±%", "±", "half its 95 % interval, in %"),
    (
        "×own",
        "× own",
        "the time over that of the scene's own setting",
    ),
    (
        "error",
        "error",
        "root mean square against the reference, in grey levels of 255",
    ),
    (
        "mean",
        "over renders",
        "the expected error: the root mean square over renders with other seeds",
    ),
    (
        "σ%",
        "± over renders",
        "the standard deviation of the error of one render, in %",
    ),
    (
        "model",
        "expected",
        "the error that the model predicts from each parameter alone",
    ),
    (
        ">1lv%",
        "pixels off",
        "% of pixels with a channel off by more than one grey level",
    ),
    (
        "FLIP",
        "FLIP",
        "the perceived difference of alternating pictures, from 0 to 1",
    ),
    (
        "tiles%",
        "(low … high)",
        "the confidence interval of the error of the whole picture: only tiles were rendered",
    ),
    (
        "",
        "largest",
        "the largest error of a channel, in grey levels",
    ),
];

/// For times of 1, 2, 5, 10 …, the row of the front with the least error within this time; only the
/// times at which the row changes.
pub(super) fn best_by_time(study: &Study) -> Vec<(f64, &StudyRow)> {
    let front: Vec<_> = study.rows.iter().filter(|row| row.front).collect();
    let times = (-4..6).flat_map(|decade| [1.0, 2.0, 5.0].map(|step| step * power_of_ten(decade)));
    let mut best_within: Vec<(f64, &StudyRow)> = Vec::new();
    for time in times {
        let Some(row) = front.iter().rfind(|row| row.seconds.value <= time) else {
            continue;
        };
        if best_within
            .last()
            .is_none_or(|(_, last)| last.setting != row.setting)
        {
            best_within.push((time, row));
        }
    }
    best_within
}

/// For example "0.17 s ± 3.1 %, error 1.07 grey levels, 1.09 ± 0.02 over 12 renders (2×2, depth
/// 2)".
pub(super) fn measured(row: &StudyRow, used: &[Parameter]) -> String {
    let limit = if row.is_resolved { "" } else { "≤ " };
    let (time, off) = (seconds(row.seconds.value), 100.0 * row.seconds.relative());
    let (error, interval) = (digits(row.errors.rmse), interval(&row.errors));
    let spread = &row.spread;
    let over = match spread.deviation == 0.0 {
        true => String::new(),
        false => format!(
            ", {} ± {} over {} renders",
            digits(spread.expected),
            digits(spread.deviation),
            spread.renders
        ),
    };
    let setting = row.setting.label(used);
    format!("{time} ± {off:.1} %, error {limit}{error}{interval} grey levels{over} ({setting})")
}

fn power_of_ten(decade: i32) -> f64 {
    rtc_math::exp(f64::from(decade) * std::f64::consts::LN_10)
}

/// For example "in 1.00 s: error 0.4 grey levels (4×4, depth 2)".
pub(super) fn best_within(study: &Study, (time, row): &(f64, &StudyRow)) -> String {
    let limit = if row.is_resolved { "" } else { "≤ " };
    let (time, error) = (seconds(*time), digits(row.errors.rmse));
    let (interval, setting) = (interval(&row.errors), row.setting.label(&study.used()));
    format!("in {time}: error {limit}{error}{interval} grey levels ({setting})")
}
