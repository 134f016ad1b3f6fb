//! The report for a terminal of 80 columns.

use super::super::advice::{digits, seconds};
use super::super::outcome::{BounceCost, MoreBounces, ParameterReport, Study, StudyRow};
use super::super::parameter::Parameter;
use super::super::reference::DepthEnd;
use super::captions::{MEANINGS, best_by_time, best_within};
use std::fmt::Write;

const WIDTH: usize = 80;

/// The study as text.
#[must_use]
pub fn table(study: &Study) -> String {
    // Write the header of the table and its rows.
    let used = study.used();
    let mut text = format!("{}\n", head(study));
    let mut names = String::from(" ");
    used.iter()
        .for_each(|parameter| write_cell(&mut names, parameter.short(), width(*parameter)));
    let columns = columns(study, &used);
    for column in &columns {
        let (name, width) = COLUMNS[*column];
        write_cell(&mut names, name, width);
    }
    text += &format!("{names}\n");
    study.rows.iter().for_each(|row| {
        text += &format!("{}\n", line(row, &used, (&columns, study.part.fraction)))
    });
    if study.rows.iter().any(|row| row.resumed) {
        text += "† partly timed before the study was interrupted\n";
    }
    text += &legend(&used, &columns);
    text += "\n";
    // Write the best setting within each time.
    for what in best_by_time(study) {
        text += &wrapped(&best_within(study, &what));
    }
    text += "\n";
    study
        .parameters
        .iter()
        .for_each(|parameter| text += &wrapped(&parameter_line(parameter, study.bounces.as_ref())));
    // Write bounces, ablations and arithmetics.
    text += &more_bounces(study.bounces.as_ref());
    text += &effects(study);
    text += "\n";
    // Write the advice.
    for (index, advice) in study.advice.iter().enumerate() {
        text += &wrapped(advice);
        // The first line is the main advice. Its command stays on one line, so that it can be
        // copied.
        if let (0, Some(command)) = (index, &study.command) {
            let _ = writeln!(text, "  {command}");
        }
    }
    if study.wall_over_cpu > 1.2 {
        let times = study.wall_over_cpu;
        let note = format!(
            "The machine was busy (wall time {times:.1}× processor time); these are processor \
             times."
        );
        text += &wrapped(&note);
    }
    text
}

/// The meaning of the displayed columns.
fn legend(used: &[Parameter], columns: &[usize]) -> String {
    let parameters = used
        .iter()
        .map(|parameter| format!("{}: {}", parameter.short(), parameter.name()));
    let is_shown = |name: &str| name == "*" || columns.iter().any(|at| COLUMNS[*at].0 == name);
    let meanings = MEANINGS.iter().filter(|(name, ..)| is_shown(name));
    let meanings = meanings.map(|(name, _, meaning)| format!("{name}: {meaning}"));
    wrapped(&parameters.chain(meanings).collect::<Vec<_>>().join("; "))
}

/// The effect of more bounces than the scene has.
fn more_bounces(bounces: Option<&MoreBounces>) -> String {
    let costs = bounces.map(steps).unwrap_or_default();
    let line = |cost: &BounceCost| {
        let (depth, rays, difference) = (cost.depth, cost.ray_ratio, digits(cost.difference));
        format!("depth {depth:<26}{rays:5.2}×  {difference} grey levels\n")
    };
    match costs.as_slice() {
        [] => String::new(),
        costs => {
            let lines: String = costs.iter().map(line).collect();
            format!("\nmore bounces                      rays  picture differs by\n{lines}")
        }
    }
}

/// The listed depths: 1, 2, 4, … more bounces, and the last.
pub(super) fn steps(bounces: &MoreBounces) -> Vec<BounceCost> {
    let last = bounces.deeper.len().saturating_sub(1);
    let all = bounces.deeper.iter().enumerate();
    let listed = all.filter(|(index, _)| (index + 1).is_power_of_two() || *index == last);
    listed.map(|(_, cost)| *cost).collect()
}

/// The cost of effects and arithmetics.
fn effects(study: &Study) -> String {
    let mut text = String::new();
    if !study.effects.is_empty() {
        text += "\nwithout                           time    rays   noise  picture differs by\n";
    }
    for cost in &study.effects {
        let (time, rays, noise) = (cost.ratio.value, cost.ray_ratio, cost.noise_ratio);
        let (name, difference) = (clipped(&cost.effect), digits(cost.difference));
        let _ = writeln!(
            text,
            "{name:31}{time:6.2}×  {rays:5.2}×  {noise:5.2}×  {difference} grey levels"
        );
    }
    text += "\narithmetic                time  picture differs by\n";
    for cost in &study.precision {
        let (name, time, visible) = (
            cost.label(),
            cost.ratio.value,
            digits(100.0 * cost.difference.visible),
        );
        let difference = digits(cost.difference.rmse);
        text += &format!(
            "{name:24}{time:5.2}×  {difference} grey levels, {visible} % of pixels by over 1\n"
        );
    }
    text
}

/// Truncates a name to its column.
fn clipped(name: &str) -> String {
    const MAX_NAME: usize = 30;
    match name.chars().count() {
        ..=MAX_NAME => name.to_owned(),
        _ => name.chars().take(MAX_NAME - 1).chain(['…']).collect(),
    }
}

/// The columns after those of the parameters, with their widths.
const COLUMNS: [(&str, usize); 11] = [
    ("rays", 8),
    ("time", 8),
    ("±%", 5),
    ("×own", 6),
    ("error", 7),
    ("mean", 6),
    ("σ%", 5),
    ("model", 6),
    (">1lv%", 6),
    ("FLIP", 6),
    ("tiles%", 8),
];

/// The columns that are dropped if there is no room, in this order.
const MODEL: usize = 7;
const MEAN: usize = 5;
const SPREAD: usize = 6;
const FLIP: usize = 9;

/// The indices of the displayed columns, as far as there is room: the interval only if tiles were
/// rendered, the error over renders only if renders differ.
fn columns(study: &Study, used: &[Parameter]) -> Vec<usize> {
    let is_alike = study.rows.iter().all(|row| row.spread.deviation == 0.0);
    let mut shown: Vec<_> = (0..COLUMNS.len())
        .filter(|index| *index != COLUMNS.len() - 1 || study.part.tiles > 0)
        .filter(|index| !(is_alike && [MEAN, SPREAD].contains(index)))
        .collect();
    let parameters = used
        .iter()
        .map(|parameter| width(*parameter))
        .sum::<usize>();
    for index in [MODEL, MEAN, FLIP, SPREAD] {
        let columns = shown.iter().map(|index| COLUMNS[*index].1).sum::<usize>();
        if 1 + parameters + columns > WIDTH {
            shown.retain(|other| *other != index);
        }
    }
    shown
}

/// The width of a parameter's column.
fn width(parameter: Parameter) -> usize {
    if parameter == Parameter::Precision {
        7
    } else {
        6
    }
}

fn line(row: &StudyRow, used: &[Parameter], (columns, fraction): (&[usize], f64)) -> String {
    // Write the mark of the Pareto front and the parameters.
    let mut line = String::from(if row.front { "*" } else { " " });
    used.iter().for_each(|parameter| {
        write_cell(
            &mut line,
            &parameter.cell(row.setting.get(*parameter)),
            width(*parameter),
        )
    });
    // Write the measured columns that were chosen.
    // The model knows estimated caustics alone.
    let is_off = used.contains(&Parameter::Caustics) && !row.setting.caustics;
    let limit = if row.is_resolved { "" } else { "≤" };
    let cells = [
        count(row.rays.all() as f64 / fraction),
        format!(
            "{}{}",
            seconds(row.seconds.value),
            if row.resumed { "†" } else { "" }
        ),
        format!("{:.1}", 100.0 * row.ratio.relative()),
        if row.is_scene_setting {
            "own".to_owned()
        } else {
            digits(row.ratio.value)
        },
        format!("{limit}{}", digits(row.errors.rmse)),
        digits(row.spread.expected),
        format!("{:.1}", 100.0 * row.spread.relative()),
        match row.setting.denoise || is_off {
            true => "–".to_owned(),
            false => digits(row.model),
        },
        digits(100.0 * row.errors.visible),
        digits(row.errors.flip),
        off(row),
    ];
    for column in columns {
        write_cell(&mut line, &cells[*column], COLUMNS[*column].1);
    }
    line
}

/// The relative confidence interval of the error of the whole picture, in percent: "-25+70".
fn off(row: &StudyRow) -> String {
    let errors = &row.errors;
    let off = |end: f64| match errors.rmse {
        0.0 => 0.0,
        rmse => 100.0 * (end / rmse - 1.0).abs(),
    };
    format!("-{:.0}+{:.0}", off(errors.rmse_low), off(errors.rmse_high))
}

/// Writes a right-aligned cell, with at least one blank before it.
fn write_cell(line: &mut String, text: &str, width: usize) {
    let blanks = width.saturating_sub(text.chars().count()).max(1);
    let _ = write!(line, "{:blanks$}{text}", "");
}

fn head(study: &Study) -> String {
    let about = format!("{}, {}.", study.about.scene, study.about.hash);
    [about, part(study), reference(study)]
        .map(|line| wrapped(&line))
        .concat()
}

/// The rendered part of the picture.
pub(super) fn part(study: &Study) -> String {
    let [width, height] = study.part.size;
    match study.part.tiles {
        0 => format!("The whole picture of {width}×{height} pixels was rendered."),
        tiles => {
            let fraction = 100.0 * study.part.fraction;
            format!(
                "{tiles} random tiles, {fraction:.1} % of the picture of {width}×{height} pixels, \
                 were rendered: tiles% is the confidence interval of each error for the whole \
                 picture (how much less and more)."
            )
        }
    }
}

/// The reference, and the unit of errors.
pub(super) fn reference(study: &Study) -> String {
    let setting = study.reference.setting.label(&study.used());
    let floor = digits(study.reference.floor);
    let omitted = match study.effort.has_arithmetics() {
        true => "",
        false => {
            " A quick study has cheaper arithmetic in the setting of the scene alone; \
             `--effort default` has it in each row."
        }
    };
    format!(
        "Reference: two renders with {setting}; its own error is {floor} grey levels. Errors are \
         root mean squares in grey levels of clamped display values; rays and processor times are \
         for the whole picture; * marks the Pareto front.{omitted}"
    )
}

/// The result for a parameter, in one sentence.
pub(super) fn parameter_line(report: &ParameterReport, bounces: Option<&MoreBounces>) -> String {
    let name = report.parameter.name();
    let last = report.levels.last().map_or(0, |level| level.value);
    // Tell why a parameter is not used.
    if let Some(reason) = &report.not_applicable {
        return format!("{name}: not used by this scene: {reason}");
    }
    // Tell its fitted power law, or why there is none.
    match (&report.law, report.parameter, bounces) {
        (Some(law), parameter, _) => {
            let samples = if parameter == Parameter::Supersampling {
                "samples"
            } else {
                "n"
            };
            let (p, half) = (law.p.value, 0.5 * (law.p.high - law.p.low));
            format!("{name}: error ∝ {samples}^−{p:.3} ± {half:.3}")
        }
        (None, Parameter::Depth, Some(bounces)) => depth_line(bounces, last),
        (None, Parameter::Caustics, _) => format!(
            "{name}: a row of the scene's paths is rendered with the estimate and one without, and \
             one without of four times the paths; the reference is with it"
        ),
        (None, Parameter::Denoise, _) => format!(
            "{name}: rows with fewer paths are also denoised; their time includes the error \
             estimate"
        ),
        (None, Parameter::Precision, _) => {
            let robust = report.levels.len().saturating_sub(1);
            let label: Vec<_> = report.levels[..robust]
                .iter()
                .map(|level| report.parameter.cell(level.value))
                .collect();
            format!(
                "{name}: rows also use {} arithmetic where that adds no error",
                label.join(" or ")
            )
        }
        (None, _, _) => format!("{name}: no power law: too few values are resolved from noise"),
    }
}

/// The scene's depth, and the effect of greater depths. The search went to `last` if it did not go
/// beyond the scene's depth.
fn depth_line(bounces: &MoreBounces, last: u32) -> String {
    let MoreBounces {
        scene_depth,
        end,
        deeper,
    } = bounces;
    let label = match deeper.last() {
        Some(most) => format!(
            "depth {} would change the picture by {} grey levels, ",
            most.depth,
            digits(most.difference)
        ),
        None => String::new(),
    };
    let last = deeper.last().map_or(last, |most| most.depth);
    let label = match end {
        DepthEnd::Exact => format!("{label}no path goes deeper than {last}"),
        DepthEnd::Still => format!("{label}the picture does not change from {last} on"),
        DepthEnd::Open => format!("{label}paths go deeper than {last}, where the budget ended"),
    };
    format!("depth: errors are measured at the scene's own, {scene_depth}; {label}")
}

/// Formats a number of rays, for example 1.23 M.
pub(super) fn count(rays: f64) -> String {
    match rays {
        ..1e4 => format!("{rays:.0}"),
        ..1e6 => format!("{:.0} k", rays / 1e3),
        ..1e9 => format!("{:.2} M", rays / 1e6),
        _ => format!("{:.2} G", rays / 1e9),
    }
}

/// Wraps text at 80 columns.
fn wrapped(text: &str) -> String {
    let mut lines = String::new();
    let mut column = 0;
    for word in text.split_whitespace() {
        let length = word.chars().count();
        if column > 0 && column + 1 + length > WIDTH {
            lines.push('\n');
            column = 0;
        } else if column > 0 {
            lines.push(' ');
            column += 1;
        }
        lines += word;
        column += length;
    }
    lines + "\n"
}
