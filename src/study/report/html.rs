//! The page.

use super::super::outcome::Study;

/// The page of a study.
#[must_use]
pub fn html(study: &Study) -> String {
    format!("<pre>{}</pre>", super::table(study))
}
