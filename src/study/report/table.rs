//! The table for a terminal of 80 columns.

use super::super::advice::{digits, seconds};
use super::super::knob::Knob;
use super::super::outcome::{KnobReport, Row, Study};
use super::super::reference::DepthEnd;
use std::fmt::Write;

const WIDTH: usize = 80;

/// The whole study as text.
#[must_use]
pub fn table(study: &Study) -> String {
    let used = study.used();
    let mut text = format!("{}\n", head(study));
    let mut names = String::from(" ");
    used.iter()
        .for_each(|knob| write_cell(&mut names, knob.short(), width(*knob)));
    for (name, width) in COLUMNS {
        write_cell(&mut names, name, width);
    }
    text += &format!("{names}\n");
    study
        .rows
        .iter()
        .for_each(|row| text += &format!("{}\n", line(row, &used, study.part.fraction)));
    if study.rows.iter().any(|row| row.resumed) {
        text += "† timed, in part at least, before the study was interrupted\n";
    }
    text += "\n";
    study
        .knobs
        .iter()
        .for_each(|knob| text += &wrapped(&knob_line(knob, study.reference.depth)));
    text += &effects(study);
    text += "\n";
    study
        .advice
        .iter()
        .for_each(|advice| text += &wrapped(advice));
    if study.wall_over_cpu > 1.2 {
        let times = study.wall_over_cpu;
        let note = format!(
            "The machine was busy (wall time {times:.1}× processor time); times are of the processor."
        );
        text += &wrapped(&note);
    }
    text
}

/// The cost of effects and arithmetics.
fn effects(study: &Study) -> String {
    let mut text = String::new();
    if !study.effects.is_empty() {
        text += "\nwithout                   time    rays  picture differs by\n";
    }
    for cost in &study.effects {
        let (name, time, rays) = (&cost.effect, cost.ratio.value, cost.ray_ratio);
        text += &format!(
            "{name:24}{time:5.2}×  {rays:5.2}×  {} grey levels\n",
            digits(cost.difference)
        );
    }
    text += "\narithmetic                time  picture differs by\n";
    for cost in &study.precision {
        let (name, time, visible) = (
            cost.words(),
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

/// The columns after those of the knobs, with their widths.
const COLUMNS: [(&str, usize); 8] = [
    ("rays", 8),
    ("time", 8),
    ("±%", 5),
    ("×own", 6),
    ("error", 7),
    ("model", 6),
    (">1lv%", 6),
    ("FLIP", 6),
];

/// The width of the column of a knob.
fn width(knob: Knob) -> usize {
    if knob == Knob::Precision { 7 } else { 6 }
}

fn line(row: &Row, used: &[Knob], fraction: f64) -> String {
    let mut line = String::from(if row.front { "*" } else { " " });
    used.iter()
        .for_each(|knob| write_cell(&mut line, &knob.cell(row.setting.get(*knob)), width(*knob)));
    let limit = if row.judged { "" } else { "≤" };
    let cells = [
        count(row.rays.all() as f64 / fraction),
        format!(
            "{}{}",
            seconds(row.seconds.value),
            if row.resumed { "†" } else { "" }
        ),
        format!("{:.1}", 100.0 * row.ratio.relative()),
        if row.own {
            "own".to_owned()
        } else {
            digits(row.ratio.value)
        },
        format!("{limit}{}", digits(row.errors.rmse)),
        digits(row.model),
        digits(100.0 * row.errors.visible),
        digits(row.errors.flip),
    ];
    for (cell, (_, width)) in cells.iter().zip(COLUMNS) {
        write_cell(&mut line, cell, width);
    }
    line
}

/// Right-aligned, with a blank before it at least.
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

/// The part rendered, and how well it represents the whole.
pub(super) fn part(study: &Study) -> String {
    let [width, height] = study.part.size;
    match study.part.tiles {
        0 => format!("All of the picture of {width}×{height} pixels was looked at."),
        tiles => {
            let uncertainty = study
                .own()
                .map_or(0.0, |row| 100.0 * row.errors.rmse_uncertainty);
            let fraction = 100.0 * study.part.fraction;
            format!(
                "{tiles} random tiles, {fraction:.1} % of the picture of {width}×{height} pixels, were looked at: all errors \
                 together may be {uncertainty:.0} % less or more for the whole."
            )
        }
    }
}

/// The reference, and the unit of errors.
pub(super) fn reference(study: &Study) -> String {
    let setting = study.reference.setting.words(&study.used());
    let floor = digits(study.reference.floor);
    format!(
        "Reference: twice {setting}, off by {floor} grey levels itself. Errors are root mean squares in grey levels, of \
         values clamped as displayed; rays and the time of one processor are of the whole picture; * is the front."
    )
}

/// The result for a knob, in one sentence.
pub(super) fn knob_line(report: &KnobReport, end: Option<DepthEnd>) -> String {
    let name = report.knob.name();
    let last = report.levels.last().map_or(0, |level| level.value);
    if let Some(reason) = &report.idle {
        return format!("{name}: not used by this scene: {reason}");
    }
    match (&report.law, report.knob, end) {
        (Some(law), knob, _) => {
            let samples = if knob == Knob::Supersampling {
                "samples"
            } else {
                "n"
            };
            let (p, half) = (law.p.value, 0.5 * (law.p.high - law.p.low));
            format!("{name}: error ∝ {samples}^−{p:.3} ± {half:.3}")
        }
        (None, Knob::Depth, Some(DepthEnd::Exact)) => {
            format!("{name}: no path goes deeper than {last}")
        }
        (None, Knob::Depth, Some(DepthEnd::Still)) => {
            format!("{name}: nothing shows from {last} on")
        }
        (None, Knob::Depth, _) => {
            format!("{name}: paths go deeper than {last}, which was as far as the study went")
        }
        (None, Knob::Precision, _) => {
            let robust = report.levels.len().saturating_sub(1);
            let words: Vec<_> = report.levels[..robust]
                .iter()
                .map(|level| report.knob.cell(level.value))
                .collect();
            format!(
                "{name}: rows are by {} arithmetic too where that adds no error",
                words.join(" or ")
            )
        }
        (None, _, _) => format!("{name}: no law: too few values stand out from the noise"),
    }
}

/// A number of rays, as 1.23 M.
pub(super) fn count(rays: f64) -> String {
    match rays {
        ..1e4 => format!("{rays:.0}"),
        ..1e6 => format!("{:.0} k", rays / 1e3),
        ..1e9 => format!("{:.2} M", rays / 1e6),
        _ => format!("{:.2} G", rays / 1e9),
    }
}

/// The text in lines of at most 80 columns.
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
