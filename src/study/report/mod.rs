//! A study in several forms: a table for a terminal, CSV and JSON for programs, a page for a
//! browser.

mod braille;
mod captions;
mod chart;
mod csv;
mod html;
mod maps;
mod picture;
mod slider;
mod table;
mod versus;

pub use csv::csv;
pub use html::html;
pub use maps::maps_page;
pub use slider::{SliderPage, slider_page, value_text};
pub use table::table;
pub use versus::versus_table;

use super::outcome::Study;

/// All of a study but its pictures as JSON.
///
/// # Panics
/// Never: a study holds nothing that JSON can't.
#[must_use]
pub fn json(study: &Study) -> String {
    serde_json::to_string_pretty(study).expect("a study holds names and numbers") + "\n"
}
