//! The page that compares two pictures: a slider between them, a map and measures of their
//! difference, and the differences of their scenes.

use super::super::difference::{Difference, heat_map};
use super::html::{self, escaped};
use super::picture::wide;
use rtc_codec::ValueChange;
use rtc_image::Image;
use serde_json::Value;
use std::fmt::Write;

/// The maximum number of scene differences on the page.
const MAX_CHANGES: usize = 500;

/// Two pictures and their difference.
pub struct SliderPage<'a> {
    /// The names of the new and the old picture.
    pub names: [&'a str; 2],
    /// The pictures, of the same size.
    pub pictures: [&'a Image; 2],
    /// The measures of their difference.
    pub difference: &'a Difference,
    /// FLIP of each pixel.
    pub flips: &'a [f64],
    /// The differences of their scenes, if known.
    pub changes: Option<&'a [ValueChange]>,
}

/// The self-contained page.
#[must_use]
pub fn slider_page(page: &SliderPage<'_>) -> String {
    let [new, old] = page.names.map(escaped);
    let title = format!("{new} against {old}");
    let sections = [
        slider(page, [&new, &old]),
        numbers(page.difference),
        changed(page),
    ];
    html::page(&title, &sections.concat())
}

fn slider(page: &SliderPage<'_>, [new, old]: [&str; 2]) -> String {
    let [a, b] = page.pictures;
    let map = heat_map([a.width, a.height], page.flips);
    let labels = format!("<p class=\"ends\"><span>new: {new}</span><span>old: {old}</span></p>\n");
    format!(
        "{labels}<div class=\"slider\">\n<img alt=\"{old}\" src=\"{}\">\n<img class=\"over\" \
         alt=\"{new}\" src=\"{}\">\n</div>\n\
         <input type=\"range\" min=\"0\" max=\"100\" value=\"50\" aria-label=\"the fraction of \
         {new}, from the left\" \
         oninput=\"this.previousElementSibling.style.setProperty('--at', this.value + '%')\">\n\
         <h2>Where they differ</h2>\n<figure><img alt=\"where they differ\" src=\"{}\">\
         <figcaption>FLIP of each pixel: dark where the difference is invisible, bright where it \
         is large</figcaption></figure>\n",
        wide(b),
        wide(a),
        wide(&map),
    )
}

fn numbers(difference: &Difference) -> String {
    let Difference {
        rmse,
        max,
        max_at: _,
        relative_mse,
        flip,
        fraction,
        levels,
    } = difference;
    let rows = [
        ("root mean square", format!("{rmse:.4} grey levels")),
        ("largest", format!("{max:.2} grey levels")),
        ("relMSE", format!("{relative_mse:.3e}")),
        ("mean FLIP", format!("{flip:.6}")),
        (
            "pixels off",
            format!(
                "{:.4} % by more than {levels} grey levels",
                100.0 * fraction
            ),
        ),
    ];
    let rows = rows.map(|(name, value)| format!("<tr><td>{name}</td><td>{value}</td></tr>\n"));
    format!(
        "<h2>Measures</h2>\n<table class=\"measures\">\n{}</table>\n",
        rows.concat()
    )
}

fn changed(page: &SliderPage<'_>) -> String {
    let Some(changes) = page.changes else {
        return String::new();
    };
    let mut rows = String::new();
    for ValueChange { path, new, old } in changes.iter().take(MAX_CHANGES) {
        let cell = |value: &Option<Value>| escaped(&value_text(value.as_ref()));
        let (path, old, new) = (escaped(path), cell(old), cell(new));
        let _ = writeln!(rows, "<tr><td>{path}</td><td>{old}</td><td>{new}</td></tr>");
    }
    let more = match changes.len().saturating_sub(MAX_CHANGES) {
        0 => String::new(),
        more => format!("<p>and {more} more</p>\n"),
    };
    let table = match changes {
        [] => "<p>nothing</p>\n".to_owned(),
        _ => format!(
            "<div class=\"wide\"><table>\n<tr><th>value</th><th>old</th><th>new</th></tr>\n{rows}</table></div>\n{more}"
        ),
    };
    format!("<h2>Differences of the scenes</h2>\n{table}")
}

/// A value of a scene as short text; a dash for none.
#[must_use]
pub fn value_text(value: Option<&Value>) -> String {
    const MAX_CHANGES: usize = 60;
    let text = value.map_or_else(|| "–".to_owned(), Value::to_string);
    match text.char_indices().nth(MAX_CHANGES) {
        None => text,
        Some((end, _)) => format!("{}…", text.split_at(end).0),
    }
}
