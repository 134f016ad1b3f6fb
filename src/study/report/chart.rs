//! Log–log plots as SVG. Each mark has its values as a tooltip. Text stays text, and the page's
//! style inverts black in dark mode.

use super::super::advice::{digits, seconds};
use super::super::outcome::{ParameterReport, Study, StudyRow};
use super::super::parameter::Parameter;
use super::super::reference::ParameterLevel;
use super::captions;
use super::html::escaped;
use plotters::coord::Shift;
use plotters::coord::combinators::{IntoLogRange, LogCoord};
use plotters::prelude::*;
use rtc_math::{exp, pow};
use std::error::Error;

const ACCENT: RGBColor = RGBColor(0x2b, 0x7c, 0xd3);
const MUTED: RGBColor = RGBColor(0x80, 0x80, 0x80);
const FLOOR: RGBColor = RGBColor(0xd0, 0x60, 0x30);

type Chart<'a, 'b> = ChartContext<'a, SVGBackend<'b>, Cartesian2d<LogCoord<f64>, LogCoord<f64>>>;
type ChartResult<T = ()> = Result<T, Box<dyn Error>>;

/// A mark of a plot that shows its values on hover or keyboard focus.
struct ChartMark {
    /// The position, in units of the plot.
    at: (i32, i32),
    label: String,
}

/// A range of positive values for a logarithmic axis.
type AxisRange = std::ops::Range<f64>;

/// Error against time: all rows with their intervals, the front as steps, the floor of the
/// reference.
pub(super) fn front(study: &Study) -> String {
    // Find the ranges of both axes.
    let rows: Vec<_> = study
        .rows
        .iter()
        .filter(|row| row.errors.rmse > 0.0)
        .collect();
    let xs = span(rows.iter().map(|row| row.seconds.value));
    let floor = Some(study.reference.floor).filter(|floor| *floor > 0.0);
    let ys = span(rows.iter().map(|row| row.errors.rmse).chain(floor));
    plot((460, 360), |root| {
        let mut chart = axes(
            root,
            [xs.clone(), ys],
            ["time of one processor", "error in grey levels"],
            seconds,
        )?;
        // Draw the front and the error of the reference.
        let steps = front_steps(&rows, xs.end);
        chart.draw_series([PathElement::new(steps, ACCENT.stroke_width(2))])?;
        if let Some(floor) = floor {
            chart.draw_series([PathElement::new(
                [(xs.start, floor), (xs.end, floor)],
                FLOOR.stroke_width(1),
            )])?;
            let label = Text::new("error of the reference", (6, -14), font(11));
            chart.draw_series([EmptyElement::at((xs.start, floor)) + label])?;
        }
        // Draw the rows with labels.
        let used = study.used();
        let mut labels = Vec::new();
        for row in &rows {
            draw_row(&mut chart, row)?;
            if row.front || row.is_scene_setting {
                draw_label(&mut chart, row, &used, &mut labels)?;
            }
        }
        // Add tooltips.
        let mark_of = |row: &&StudyRow| ChartMark {
            at: chart.backend_coord(&(row.seconds.value, row.errors.rmse)),
            label: captions::measured(row, &used),
        };
        Ok(rows.iter().map(mark_of).collect())
    })
}

/// The vertices of the front's step line: the least error for each time.
fn front_steps(rows: &[&StudyRow], end: f64) -> Vec<(f64, f64)> {
    let mut steps: Vec<(f64, f64)> = Vec::new();
    for row in rows.iter().filter(|row| row.front) {
        // Rows with similar times are ordered by rays: keep x monotonic.
        let x = steps
            .last()
            .map_or(0.0, |last| last.0)
            .max(row.seconds.value);
        steps.extend(steps.last().map(|last| (x, last.1)));
        steps.push((x, row.errors.rmse));
    }
    steps.extend(steps.last().map(|last| (end, last.1)));
    steps
}

fn draw_row(chart: &mut Chart<'_, '_>, row: &StudyRow) -> ChartResult {
    let (x, y) = (row.seconds.value, row.errors.rmse);
    let color = if row.front { ACCENT } else { MUTED };
    let errors = &row.errors;
    let across = [(row.seconds.low.max(x * 0.1), y), (row.seconds.high, y)];
    let along = [(x, errors.rmse_low.max(y * 0.1)), (x, errors.rmse_high)];
    for bar in [across, along] {
        chart.draw_series([PathElement::new(bar, color.mix(0.5).stroke_width(1))])?;
    }
    let fill = if row.is_resolved {
        color.filled()
    } else {
        color.stroke_width(1)
    };
    chart.draw_series([Circle::new((x, y), 4, fill)])?;
    Ok(())
}

/// Draws the values of a setting above its mark, or below it if another label overlaps; if both
/// overlap, no label. `labels` has the positions of all labels.
fn draw_label(
    chart: &mut Chart<'_, '_>,
    row: &StudyRow,
    used: &[Parameter],
    labels: &mut Vec<(i32, i32)>,
) -> ChartResult {
    /// The approximate size of a label.
    const SIZE: (i32, i32) = (110, 13);
    const ABOVE_OR_BELOW: [i32; 2] = [-15, 6];
    let at = (row.seconds.value, row.errors.rmse);
    let (x, y) = chart.backend_coord(&at);
    let is_free = |up: &&i32| {
        let is_near = |other: &(i32, i32)| {
            (x - other.0).abs() < SIZE.0 && (y + **up - other.1).abs() < SIZE.1
        };
        !labels.iter().any(is_near)
    };
    let Some(up) = ABOVE_OR_BELOW.iter().find(is_free).copied() else {
        return Ok(());
    };
    labels.push((x, y + up));
    let values: Vec<_> = used
        .iter()
        .map(|parameter| parameter.cell(row.setting.get(*parameter)))
        .collect();
    let own = if row.is_scene_setting { " (own)" } else { "" };
    let label = Text::new(format!("{}{own}", values.join("·")), (6, up), font(11));
    chart.draw_series([EmptyElement::at(at) + label])?;
    Ok(())
}

/// Plots the error of one parameter, and its power law.
pub(super) fn parameter(report: &ParameterReport) -> String {
    // A logarithmic axis has no 0: a depth of 0 is drawn at ½.
    let x = |value: u32| report.parameter.samples(value).max(0.5);
    // Collect the levels with an error, and the ranges of both axes.
    let points: Vec<_> = report
        .levels
        .iter()
        .filter(|level| level.error > 0.0)
        .map(|level| (x(level.value), level))
        .collect();
    let xs = span(points.iter().map(|point| point.0));
    let ys = span(points.iter().map(|point| point.1.error));
    let name = match report.parameter {
        Parameter::Supersampling => "samples of a pixel",
        Parameter::Depth => "depth, 0 at ½",
        parameter @ (Parameter::Aperture
        | Parameter::Lights
        | Parameter::Glossy
        | Parameter::Paths
        | Parameter::Caustics
        | Parameter::Denoise
        | Parameter::Precision) => parameter.name(),
    };
    plot((400, 300), |root| {
        let mut chart = axes(
            root,
            [xs.clone(), ys.clone()],
            [name, "error in grey levels"],
            digits,
        )?;
        // Draw the power law.
        if let Some(law) = &report.law {
            const STEPS: u32 = 100;
            let x =
                |step: u32| xs.start * pow(xs.end / xs.start, f64::from(step) / f64::from(STEPS));
            let line = (0..=STEPS).map(|step| (x(step), law.at(x(step))));
            // Drop points outside: plotters would draw them on the edge.
            let line = line.filter(|(_, y)| ys.contains(y)).collect::<Vec<_>>();
            chart.draw_series([PathElement::new(line, ACCENT.mix(0.6).stroke_width(1))])?;
        }
        // Draw the levels.
        let mark = |(x, level): &(f64, &ParameterLevel)| {
            let style = if level.resolved {
                ACCENT.filled()
            } else {
                MUTED.stroke_width(1)
            };
            Circle::new((*x, level.error), 4, style)
        };
        chart.draw_series(points.iter().map(mark))?;
        // Add tooltips.
        let mark_of = |(x, level): &(f64, &ParameterLevel)| ChartMark {
            at: chart.backend_coord(&(*x, level.error)),
            label: format!(
                "{name} {}: error {} grey levels",
                report.parameter.cell(level.value),
                digits(level.error)
            ),
        };
        Ok(points.iter().map(mark_of).collect())
    })
}

/// The range of decades that contains all values.
fn span(values: impl Iterator<Item = f64>) -> AxisRange {
    let decades = (-12..=12).map(|decade| exp(f64::from(decade) * std::f64::consts::LN_10));
    let (low, high) = values.fold((f64::INFINITY, 0.0_f64), |(low, high), value| {
        (low.min(value), high.max(value))
    });
    let below = decades.clone().rfind(|decade| *decade < 0.95 * low);
    let above = decades.clone().find(|decade| *decade > 1.05 * high);
    match (below, above) {
        (Some(below), Some(above)) if low <= high => below..above,
        _ => 0.1..10.0,
    }
}

fn plot(
    size: (u32, u32),
    draw: impl FnOnce(&DrawingArea<SVGBackend<'_>, Shift>) -> ChartResult<Vec<ChartMark>>,
) -> String {
    let mut svg = String::new();
    let root = SVGBackend::with_string(&mut svg, size).into_drawing_area();
    let drawn = draw(&root).and_then(|marks| {
        root.present()?;
        Ok(marks)
    });
    drop(root);
    // Drawing into a string cannot fail; if it did, the page would have no plot.
    match drawn {
        Ok(marks) => with_marks(&svg, &marks),
        Err(error) => format!("<p>no plot: {error}</p>"),
    }
}

/// A plot with its marks on top, and a line below it for the values of the last one.
fn with_marks(svg: &str, marks: &[ChartMark]) -> String {
    let mark_of = |ChartMark { at: (x, y), label }: &ChartMark| {
        let label = escaped(label);
        format!(
            "<circle class=\"mark\" cx=\"{x}\" cy=\"{y}\" r=\"10\" tabindex=\"0\" role=\"img\" \
             aria-label=\"{label}\"><title>{label}</title></circle>\n"
        )
    };
    let marks: String = marks.iter().map(mark_of).collect();
    let drawing = svg.trim_end().trim_end_matches("</svg>");
    format!(
        "<div onpointerover=\"{SHOW_VALUES}\" onfocusin=\"{SHOW_VALUES}\">{drawing}{marks}</svg>\n\
         <p class=\"values\">Point at a mark to see its values.</p></div>"
    )
}

/// Shows the values of the mark under the pointer or the keyboard focus below the plot.
const SHOW_VALUES: &str = "const words = event.target.getAttribute('aria-label'); \
                    if (words) this.lastElementChild.textContent = words";

fn axes<'a, 'b>(
    root: &'a DrawingArea<SVGBackend<'b>, Shift>,
    [xs, ys]: [AxisRange; 2],
    [x_name, y_name]: [&str; 2],
    x_words: fn(f64) -> String,
) -> Result<Chart<'a, 'b>, Box<dyn Error>> {
    let mut builder = ChartBuilder::on(root);
    builder
        .margin(8)
        .margin_right(20)
        .x_label_area_size(40)
        .y_label_area_size(56);
    let mut chart = builder.build_cartesian_2d(xs.log_scale(), ys.log_scale())?;
    chart
        .configure_mesh()
        .bold_line_style(MUTED.mix(0.3))
        .light_line_style(MUTED.mix(0.1))
        .label_style(font(12))
        .axis_desc_style(font(13))
        .x_desc(x_name)
        .y_desc(y_name)
        .x_labels(4)
        .y_labels(4)
        .x_label_formatter(&|x| x_words(*x))
        .y_label_formatter(&|y| digits(*y))
        .draw()?;
    Ok(chart)
}

fn font(size: u32) -> (&'static str, u32) {
    ("sans-serif", size)
}
