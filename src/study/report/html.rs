//! The HTML report: one file without network requests or script files, for wide and narrow screens,
//! light and dark mode.

use super::super::advice::{digits, interval, seconds};
use super::super::outcome::{BounceCost, Study, StudyRow};
use super::super::parameter::Parameter;
use super::captions::{MEANINGS, best_by_time, best_within};
use super::{chart, maps, picture, table};
use std::fmt::Write;

const STYLE: &str = include_str!("page.css");

/// The maximum number of rows with pictures.
const PICTURES: usize = 8;

/// The HTML report of a study.
#[must_use]
pub fn html(study: &Study) -> String {
    let title = format!("The cost of accuracy: {}", escaped(&study.about.scene));
    let sections = [
        front(study),
        legend(&study.used()),
        times(study),
        parameters(study),
        bounces(study),
        effects(study),
        precision(study),
        maps::section(study),
        pictures(study),
        notes(study),
    ];
    let lines = study.advice.iter().map(|line| paragraph(&escaped(line)));
    let command = study.command.iter().map(|command| {
        let label = "The command of the first line (one click selects it):";
        paragraph(&format!("{label} <code>{}</code>", escaped(command)))
    });
    let advice: String = lines.chain(command).collect();
    let advice = format!("<div class=\"advice\">\n{advice}</div>\n");
    page(&title, &(advice + &sections.concat()))
}

/// A self-contained page.
pub(super) fn page(title: &str, body: &str) -> String {
    format!(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
         <meta name=\"viewport\" content=\"width=device-width, \
         initial-scale=1\">\n<title>{title}</title>\n\
         <style>\n{STYLE}</style>\n</head>\n<body>\n<h1>{title}</h1>\n{body}</body>\n</html>\n"
    )
}

fn paragraph(inner: &str) -> String {
    format!("<p>{inner}</p>\n")
}

fn front(study: &Study) -> String {
    let used = study.used();
    let mut rows = String::new();
    for row in &study.rows {
        let class = if row.front { "front" } else { "other" };
        let cells: String = cells(row, &used, study.part.fraction)
            .iter()
            .map(|cell| format!("<td>{cell}</td>"))
            .collect();
        let _ = writeln!(rows, "<tr class=\"{class}\">{cells}</tr>");
    }
    let names = [
        "rays",
        "time",
        "×&nbsp;own",
        "error",
        "over renders",
        "expected",
        "largest",
        "pixels off",
        "FLIP",
    ];
    let names = std::iter::once("")
        .chain(used.iter().map(|parameter| parameter.short()))
        .chain(names);
    let head: String = names.map(|name| format!("<th>{name}</th>")).collect();
    format!(
        "<h2>The Pareto front: error against time</h2>\n<div class=\"plot\">{}</div>\n<p>{}</p>\n\
         <div class=\"wide\"><table><thead><tr>{head}</tr></thead>\n<tbody>\n{rows}</tbody></table></div>\n",
        chart::front(study),
        "Points are measured settings, bars their confidence intervals, steps the Pareto front. \
         The reference does not resolve the error of hollow points."
    )
}

/// The meaning of the columns, in a collapsible section.
fn legend(used: &[Parameter]) -> String {
    let parameters = used
        .iter()
        .map(|parameter| (parameter.short(), parameter.name()));
    let meanings = MEANINGS.iter().map(|(_, name, meaning)| (*name, *meaning));
    let entry = |(name, meaning)| {
        let meaning = escaped(meaning);
        format!("<dt>{name}</dt><dd>{meaning}</dd>\n")
    };
    let entries: String = parameters.chain(meanings).map(entry).collect();
    format!(
        "<details>\n<summary>Meaning of the columns</summary>\n<dl>\n{entries}</dl>\n</details>\n"
    )
}

/// The best setting within each time, with a slider over the times.
fn times(study: &Study) -> String {
    let lines: Vec<_> = best_by_time(study)
        .iter()
        .map(|what| escaped(&best_within(study, what)))
        .collect();
    let Some(last) = lines.len().checked_sub(1) else {
        return String::new();
    };
    let items: String = lines
        .iter()
        .enumerate()
        .map(|(index, line)| {
            let mark = if index == last { " class=\"at\"" } else { "" };
            format!("<li{mark}>{line}</li>\n")
        })
        .collect();
    format!(
        "<h2>Best setting within a time</h2>\n<input type=\"range\" min=\"0\" max=\"{last}\" \
         value=\"{last}\" \
         aria-label=\"time\" oninput=\"[...this.nextElementSibling.children].forEach((line, place) \
         => \
         line.classList.toggle('at', place == this.value)); this.setAttribute('aria-valuetext', \
         this.nextElementSibling.children[this.value].textContent)\">\n<ul \
         class=\"buys\">\n{items}</ul>\n"
    )
}

fn cells(row: &StudyRow, used: &[Parameter], fraction: f64) -> Vec<String> {
    // Mark the row of the Pareto front, the scene's own setting, and bounds.
    let star = if row.front { "★" } else { "" };
    let own = if row.is_scene_setting { " own" } else { "" };
    let limit = if row.is_resolved { "" } else { "≤ " };
    let parameters = used
        .iter()
        .map(|parameter| parameter.cell(row.setting.get(*parameter)));
    // Format the measured columns.
    let measured = [
        table::count(row.rays.all() as f64 / fraction),
        format!(
            "{} ± {:.1} %",
            seconds(row.seconds.value),
            100.0 * row.seconds.relative()
        ),
        format!(
            "{} ± {:.1} %",
            digits(row.ratio.value),
            100.0 * row.ratio.relative()
        ),
        format!(
            "{limit}{}{}",
            digits(row.errors.rmse),
            interval(&row.errors)
        ),
        format!(
            "{} ± {}",
            digits(row.spread.expected),
            digits(row.spread.deviation)
        ),
        digits(row.model),
        digits(row.errors.max),
        format!("{} %", digits(100.0 * row.errors.visible)),
        digits(row.errors.flip),
    ];
    std::iter::once(format!("{star}{own}"))
        .chain(parameters)
        .chain(measured)
        .collect()
}

fn parameters(study: &Study) -> String {
    let mut figures = String::new();
    let mut not_applicable = String::new();
    for report in &study.parameters {
        let label = escaped(&table::parameter_line(report, study.bounces.as_ref()));
        let has_points = report.levels.iter().any(|level| level.error > 0.0);
        if report.not_applicable.is_some()
            || report.parameter == Parameter::Precision
            || !has_points
        {
            let _ = writeln!(not_applicable, "<li>{label}</li>");
        } else {
            let plot = chart::parameter(report);
            let _ = writeln!(
                figures,
                "<figure>{plot}<figcaption>{label}</figcaption></figure>"
            );
        }
    }
    let note = "The error of each parameter if all others have none; hollow points are not \
     resolved from noise.";
    format!(
        "<h2>Each parameter alone</h2>\n<p>{note}</p>\n<div \
         class=\"grid\">\n{figures}</div>\n<ul>\n{not_applicable}</ul>\n"
    )
}

fn bounces(study: &Study) -> String {
    let costs = study.bounces.as_ref().map(table::steps).unwrap_or_default();
    if costs.is_empty() {
        return String::new();
    }
    let mut rows = String::new();
    for BounceCost {
        depth,
        ray_ratio,
        difference,
    } in costs
    {
        let difference = digits(difference);
        let _ = writeln!(
            rows,
            "<tr><td>{depth}</td><td>{ray_ratio:.2}</td><td>{difference}</td></tr>"
        );
    }
    format!(
        "<h2>The effect of more bounces</h2>\n<p>Paths deeper than those of the scene, compared \
         with its own depth. This is not part of the error of any row.</p>\n<div \
         class=\"wide\"><table><thead><tr><th>depth</th><th>rays</th>\
         <th>picture differs by (grey \
         levels)</th></tr></thead>\n<tbody>\n{rows}</tbody></table></div>\n"
    )
}

fn effects(study: &Study) -> String {
    if study.effects.is_empty() {
        return String::new();
    }
    let mut rows = String::new();
    for cost in &study.effects {
        let (time, off) = (cost.ratio.value, 100.0 * cost.ratio.relative());
        let (rays, noise) = (cost.ray_ratio, cost.noise_ratio);
        let (name, difference) = (escaped(&cost.effect), digits(cost.difference));
        let _ = writeln!(
            rows,
            "<tr><td>{name}</td><td>{time:.2} ± {off:.1} \
             %</td><td>{rays:.2}</td><td>{noise:.2}</td>\
             <td>{difference}</td></tr>"
        );
    }
    format!(
        "<h2>The cost of each effect, light, object and material</h2>\n<p>Ratios are the scene \
         without it over the complete scene, with the same random numbers. Noise is sampling \
         noise; the difference is beyond noise.</p>\n\
         <div class=\"wide\"><table><thead><tr><th>without</th><th>time</th><th>rays</th><th>noise</th>\
         <th>picture differs by (grey \
         levels)</th></tr></thead>\n<tbody>\n{rows}</tbody></table></div>\n"
    )
}

fn precision(study: &Study) -> String {
    let mut rows = String::new();
    for cost in &study.precision {
        let (time, off, difference) = (
            cost.ratio.value,
            100.0 * cost.ratio.relative(),
            &cost.difference,
        );
        let cells = [
            cost.label(),
            format!("{time:.2} ± {off:.1} %"),
            digits(difference.rmse),
            digits(difference.max),
            format!("{} %", digits(100.0 * difference.visible)),
        ];
        let _ = writeln!(
            rows,
            "<tr>{}</tr>",
            cells.map(|cell| format!("<td>{cell}</td>")).concat()
        );
    }
    format!(
        "<h2>The cost of each arithmetic</h2>\n<p>The same samples with each arithmetic, compared \
         with the robust one: time, and difference in grey levels.</p>\n<div \
         class=\"wide\"><table><thead><tr><th>arithmetic</th>\
         <th>time</th><th>error</th><th>largest</th><th>pixels \
         off</th></tr></thead>\n<tbody>\n{rows}</tbody></table>\
         </div>\n"
    )
}

fn pictures(study: &Study) -> String {
    if study.reference_tiles.is_empty() {
        return String::new();
    }
    // Choose rows of the front and the scene's row.
    let shown: Vec<_> = study
        .rows
        .iter()
        .filter(|row| row.front || row.is_scene_setting)
        .collect();
    let step = shown.len().div_ceil(PICTURES).max(1);
    // Draw each picture beside its FLIP map.
    let mut figures = figure(&[picture::tiles(&study.reference_tiles)], "The reference");
    for row in shown.into_iter().step_by(step) {
        let own = if row.is_scene_setting {
            ", the scene's own"
        } else {
            ""
        };
        let label = format!(
            "{}{own}: error {}{}",
            row.setting.label(&study.used()),
            digits(row.errors.rmse),
            interval(&row.errors)
        );
        figures += &figure(
            &[
                picture::tiles(&row.tiles),
                picture::heat(&row.tiles, &study.reference_tiles),
            ],
            &label,
        );
    }
    let what = if study.part.tiles == 0 {
        "The picture"
    } else {
        "The rendered tiles, side by side,"
    };
    format!(
        "<h2>Pictures</h2>\n<p>{what} and the FLIP map of the error (black is 0, white is \
         1).</p>\n<div class=\"grid\">\n{figures}</div>\n"
    )
}

fn figure(images: &[String], label: &str) -> String {
    let images: String = images
        .iter()
        .map(|uri| format!("<img alt=\"\" src=\"{uri}\">"))
        .collect();
    format!(
        "<figure><div class=\"pair\">{images}</div><figcaption>{}</figcaption></figure>\n",
        escaped(label)
    )
}

fn notes(study: &Study) -> String {
    let about = &study.about;
    let busy = format!(
        "wall time was {:.2} times processor time",
        study.wall_over_cpu
    );
    let facts = [
        table::part(study),
        table::reference(study),
        "“Pixels off” differ in a channel by more than one grey level. FLIP is computed for each \
         tile separately, at 67 pixels per degree. Times are medians of rounds in random order \
         with 95 % intervals; × own is relative to the scene's own setting in the same round."
            .to_owned(),
        format!(
            "{}, scene {}, seed {}.",
            about.software, about.hash, study.seed
        ),
        format!("{}, {} cores; {busy}.", about.processor, about.cores),
    ];
    let lines: String = facts
        .iter()
        .map(|fact| format!("<p><small>{}</small></p>\n", escaped(fact)))
        .collect();
    format!("<h2>Method</h2>\n{lines}")
}

/// Escapes text for HTML.
pub(super) fn escaped(text: &str) -> String {
    text.replace('&', "&amp;")
        .replace('<', "&lt;")
        .replace('>', "&gt;")
        .replace('"', "&quot;")
}
