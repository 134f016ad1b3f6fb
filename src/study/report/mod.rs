//! Reports of a study: a table for a terminal, CSV for programs, an HTML page.
//!
//! - [`mod@table`]: text of 80 columns;
//! - [`mod@csv`]: all numbers of the rows;
//! - [`mod@html`]: a self-contained page with SVG plots ([`chart`]), pictures ([`picture`]) and
//!   [`maps`];
//! - [`slider`]: the page that compares two pictures (`rtc diff`);
//! - [`versus`]: the comparison of two scenes (`rtc cost` with a reference scene).
//!
//! [`captions`] has the texts that the table and the page share. Reports only format what a
//! [`Study`](super::Study) holds: a study that was read from JSON gives the same reports, except
//! for the pictures.

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
