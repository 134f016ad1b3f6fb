//! Maps of cost and error with their scales: a section of the report, and a separate page.

use super::super::advice::digits;
use super::super::difference::heat_map;
use super::super::maps::{StudyMap, maps};
use super::super::outcome::Study;
use super::html::{escaped, page};
use super::picture::wide;
use std::fmt::Write;

/// The number of colours of a scale.
const STEPS: u32 = 64;

/// The section of the maps; empty if there are none.
pub(super) fn section(study: &Study) -> String {
    let maps = maps(study);
    if maps.is_empty() {
        return String::new();
    }
    // Draw the colour bar and one figure per map.
    let scale: Vec<_> = (0..STEPS)
        .map(|step| f64::from(step) / f64::from(STEPS - 1))
        .collect();
    let bar = wide(&heat_map([STEPS, 1], &scale));
    let mut figures = String::new();
    for map in &maps {
        let StudyMap {
            label,
            unit,
            most,
            image,
            name: _,
        } = map;
        let (label, most, picture) = (escaped(label), digits(*most), wide(image));
        let _ = writeln!(
            figures,
            "<figure><img alt=\"{label}\" src=\"{picture}\">\n<img class=\"bar\" alt=\"\" \
             src=\"{bar}\">\
             <div class=\"ends\"><span>0</span><span>{unit}</span><span>{most} and \
             more</span></div>\
             <figcaption>{label}</figcaption></figure>"
        );
    }
    // Explain the areas that were not rendered.
    let hatched = match study.part.tiles {
        0 => "",
        _ => " Hatched grey was not rendered.",
    };
    format!(
        "<h2>Maps of rays and of errors</h2>\n<p>The whole picture. All maps of a measure have the \
         same scale.{hatched}</p>\n\
         <div class=\"grid maps\">\n{figures}</div>\n"
    )
}

/// The page of the maps alone.
#[must_use]
pub fn maps_page(study: &Study) -> String {
    let title = format!("Maps of cost and error: {}", escaped(&study.about.scene));
    page(&title, &section(study))
}
