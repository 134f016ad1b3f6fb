//! The advice that follows from a study, as sentences.

use super::metrics::PictureErrors;
use super::outcome::{MoreBounces, Study, StudyRow};
use super::parameter::Parameter;
use super::pareto::EQUAL_ERROR;
use super::setting::Setting;
use super::statistics::Estimate;
use rtc_math::pow;
use rtc_plan::Arithmetic;

/// An invisible error, in grey levels.
const INVISIBLE: f64 = 0.5;

/// The advice of a study: one sentence per line, the main advice first.
#[must_use]
pub fn advice(study: &Study) -> Vec<String> {
    let front = front(study);
    let Some(chosen) = chosen(&front) else {
        return Vec::new();
    };
    let mut lines = vec![best(study, &front[chosen..])];
    lines.extend(
        study
            .scene_row()
            .map(|scene_row| about_scene_setting(study, scene_row, &front)),
    );
    lines.extend(about_paths(study));
    lines.extend(study.bounces.as_ref().and_then(about_more));
    if study.rows.iter().any(|row| !row.is_resolved) {
        lines.push(
            "The reference does not resolve the error of rows with ≤: these are upper \
             bounds. More effort resolves them."
                .to_owned(),
        );
    }
    lines
}

/// The rows of the Pareto front.
fn front(study: &Study) -> Vec<&StudyRow> {
    let rows = study.rows.iter().filter(|row| row.front);
    rows.map(|row| stabilised(study, row)).collect()
}

/// The index of the recommended row: the first whose error is certainly invisible, or the last.
fn chosen(front: &[&StudyRow]) -> Option<usize> {
    front
        .iter()
        .position(|row| row.errors.rmse_high <= INVISIBLE)
        .or(front.len().checked_sub(1))
}

/// The recommended row: the cheapest on the Pareto front whose error is certainly invisible.
#[must_use]
pub fn recommended(study: &Study) -> Option<&StudyRow> {
    let front = front(study);
    Some(front[chosen(&front)?])
}

/// The command that renders the scene in the recommended setting.
pub(super) fn command(study: &Study) -> Option<String> {
    let row = recommended(study)?;
    let scene_row = study.scene_row()?.setting;
    let is_shell_safe = |letter: char| letter.is_alphanumeric() || "._-".contains(letter);
    let name = match study.about.scene.as_str() {
        "" => "SCENE",
        name if name.chars().all(is_shell_safe) => name,
        _ => "SCENE",
    };
    let flags = study.used().into_iter();
    let flags = flags.filter(|parameter| row.setting.get(*parameter) != scene_row.get(*parameter));
    let flags =
        flags.map(|parameter| format!(" {}", parameter.argument(row.setting.get(parameter))));
    Some(format!("rtc render {name}{}", flags.collect::<String>()))
}

/// The number of paths for an error that is barely visible, extrapolated by the power law from the
/// error of the scene's number of paths.
fn about_paths(study: &Study) -> Option<String> {
    let parameters = &mut study.parameters.iter();
    let paths = parameters
        .find(|report| report.parameter == Parameter::Paths && report.not_applicable.is_none())?;
    let (scene_row, delta) = (study.scene_row()?, study.scene_row()?.errors.delta_e);
    let exponent = paths.law.map_or(0.5, |law| law.p.value.clamp(0.25, 1.0));
    let requested = f64::from(scene_row.setting.paths) * pow(delta, 1.0 / exponent);
    (delta > 0.0).then(|| {
        let [requested, scene_row] = [two_digits(requested), f64::from(scene_row.setting.paths)];
        format!(
            "An error of 1 ΔE (the mean distance in CIELAB) needs about `--spp {requested}`; the \
             scene's own {scene_row} paths have {} ΔE.",
            digits(delta)
        )
    })
}

/// Rounds up to two significant digits, to at least 1.
fn two_digits(value: f64) -> f64 {
    let mut unit = 1.0;
    while value > 100.0 * unit {
        unit *= 10.0;
    }
    (value / unit).ceil().max(1.0) * unit
}

/// The effect of more bounces, if it is visible.
fn about_more(bounces: &MoreBounces) -> Option<String> {
    let most = bounces.deeper.last()?;
    let (scene_row, depth) = (bounces.scene_depth, most.depth);
    (most.difference > INVISIBLE).then(|| {
        let (times, difference) = (most.ray_ratio, digits(most.difference));
        format!(
            "Errors are measured at the scene's own depth, {scene_row}; depth {depth} gives \
             another picture, {difference} grey levels \
             away, for {times:.2}× the rays."
        )
    })
}

/// The row, or the same row with the robust arithmetic if the row is not clearly cheaper: the
/// difference may be timing noise.
fn stabilised<'a>(study: &'a Study, row: &'a StudyRow) -> &'a StudyRow {
    /// A ratio that is certainly below 1.
    const CLEARLY_CHEAPER: f64 = 0.95;
    let robust = Setting {
        precision: Arithmetic::Robust,
        ..row.setting
    };
    let cost = study
        .precision
        .iter()
        .find(|cost| cost.arithmetic == row.setting.precision);
    let is_clear = cost.is_some_and(|cost| cost.ratio.high < CLEARLY_CHEAPER);
    study
        .rows
        .iter()
        .find(|row| !is_clear && row.setting == robust)
        .unwrap_or(row)
}

/// The recommended row, and the cost of better ones.
fn best(study: &Study, rows: &[&StudyRow]) -> String {
    let (chosen, better) = (rows[0], &rows[1..]);
    let label = |row: &StudyRow| row.setting.label(&study.used());
    let line = format!(
        "{}: {} for {}",
        label(chosen),
        error(chosen),
        seconds(chosen.seconds.value)
    );
    let half = better
        .iter()
        .find(|row| row.errors.rmse <= 0.5 * chosen.errors.rmse);
    match half {
        Some(half) => {
            let times = half.seconds.value / chosen.seconds.value;
            format!(
                "{line}; {} halves the error for {times:.1}× the time.",
                label(half)
            )
        }
        None => format!("{line}."),
    }
}

fn about_scene_setting(study: &Study, scene_row: &StudyRow, front: &[&StudyRow]) -> String {
    let label = scene_row.setting.label(&study.used());
    // The same setting with the other arithmetic may be on the front instead.
    let is_on_front = scene_row.front || front.iter().any(|row| row.setting == scene_row.setting);
    if is_on_front {
        let is_better_value = |row: &&&StudyRow| {
            row.ratio.value <= 1.05 && row.errors.rmse <= 0.8 * scene_row.errors.rmse
        };
        let line = format!("The scene's own setting, {label}, is on the front");
        return match front.iter().rfind(is_better_value) {
            Some(row) => format!("{line}, but {}.", improvement(study, row, scene_row)),
            None => line + ".",
        };
    }
    let better = front
        .iter()
        .rfind(|row| is_clearly_better(&row.errors, &scene_row.errors, row.ratio));
    match better {
        Some(row) => format!(
            "The scene's own setting, {label}, is off the front: {}.",
            improvement(study, row, scene_row)
        ),
        None => format!(
            "The scene's own setting, {label}, is as good as the front, as far as this study can \
             tell."
        ),
    }
}

/// Whether a setting is better than that of the scene beyond the intervals of both: certainly lower
/// in error for a time that may be the same, or certainly cheaper for an error that may be. `ratio`
/// is its time over that of the scene's.
fn is_clearly_better(errors: &PictureErrors, own: &PictureErrors, ratio: Estimate) -> bool {
    let is_lower = EQUAL_ERROR * errors.rmse_high < own.rmse_low;
    let is_no_higher = errors.rmse <= EQUAL_ERROR * own.rmse;
    (is_lower && ratio.low <= 1.0) || (is_no_higher && ratio.high < 1.0)
}

/// The advantage of a row over the scene's own setting.
fn improvement(study: &Study, row: &StudyRow, scene_row: &StudyRow) -> String {
    let (label, times) = (row.setting.label(&study.used()), row.ratio.value);
    if digits(row.errors.rmse) == digits(scene_row.errors.rmse) {
        return format!("{label} has the same error for {times:.2}× the time");
    }
    format!(
        "{label} has {} instead of {} for {times:.2}× the time",
        error(row),
        digits(scene_row.errors.rmse)
    )
}

/// As "error 0.4 grey levels".
fn error(row: &StudyRow) -> String {
    match row.errors.rmse {
        0.0 => "no error".to_owned(),
        rmse => format!(
            "error {}{}{} grey levels",
            if row.is_resolved { "" } else { "≤ " },
            digits(rmse),
            interval(&row.errors)
        ),
    }
}

/// The confidence interval of an error for the whole picture, if only tiles were rendered: " (0.3 …
/// 0.6)".
pub(super) fn interval(errors: &PictureErrors) -> String {
    if errors.rmse_low == errors.rmse_high {
        return String::new();
    }
    format!(
        " ({} … {})",
        digits(errors.rmse_low),
        digits(errors.rmse_high)
    )
}

/// Formats a number with its significant digits.
pub(super) fn digits(value: f64) -> String {
    match value {
        0.0 => "0".to_owned(),
        ..0.001 => format!("{value:.0e}"),
        ..0.1 => format!("{value:.3}"),
        ..10.0 => format!("{value:.2}"),
        ..100.0 => format!("{value:.1}"),
        _ => format!("{value:.0}"),
    }
}

/// Formats a duration in seconds, with a unit.
pub(super) fn seconds(value: f64) -> String {
    match value {
        ..0.1 => format!("{} ms", digits(1000.0 * value)),
        ..120.0 => format!("{} s", digits(value)),
        ..7200.0 => format!("{:.0} min", value / 60.0),
        _ => format!("{:.1} h", value / 3600.0),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_time_that_may_be_the_same_is_no_gain() {
        let errors = |rmse: f64| PictureErrors {
            rmse,
            rmse_low: rmse,
            rmse_high: rmse,
            relative_mse: 0.0,
            max: 0.0,
            visible: 0.0,
            flip: 0.0,
            delta_e: 0.0,
        };
        let better = |rmse: f64, [low, value, high]: [f64; 3]| {
            is_clearly_better(&errors(rmse), &errors(1.0), Estimate { value, low, high })
        };
        assert!(!better(1.0, [0.73, 1.02, 1.31]) && !better(1.0, [0.7, 0.9, 1.1]));
        assert!(better(1.0, [0.7, 0.8, 0.9]) && better(0.5, [0.9, 1.02, 1.1]));
        assert!(!better(0.5, [1.1, 1.2, 1.3]) && !better(1.1, [0.4, 0.5, 0.6]));
    }

    #[test]
    fn numbers_of_paths_are_rounded_up() {
        assert_eq!(
            [0.2, 17.0, 100.0, 101.0, 12_345.0].map(two_digits),
            [1.0, 17.0, 100.0, 110.0, 13_000.0]
        );
    }

    #[test]
    fn numbers_have_the_digits_that_matter() {
        assert_eq!(
            [0.0, 0.000_12, 0.0123, 0.456, 4.56, 45.6, 456.7]
                .map(digits)
                .join(" "),
            "0 1e-4 0.012 0.46 4.56 45.6 457"
        );
        let label = [0.0123, 1.234, 75.0, 600.0, 9000.0].map(seconds).join(", ");
        assert_eq!(label, "12.3 ms, 1.23 s, 75.0 s, 10 min, 2.5 h");
    }
}
