//! For editors: one line a finding, `file:line:column: error[VA001]: message`.

use super::place::FilePlace;
use super::text::clean;
use crate::Diagnostic;
use rtc_source::SourceMap;

/// One finding; `name` stands for its file where it has no place.
pub(super) fn finding(name: &str, diagnostic: &Diagnostic, map: &SourceMap) -> String {
    let place = match (&diagnostic.primary, &diagnostic.pointer) {
        (Some(label), _) => FilePlace::new(map, label.span).to_string(),
        (None, Some(pointer)) => format!("{}: {}", clean(name), clean(pointer)),
        (None, None) => clean(name).into_owned(),
    };
    format!(
        "{place}: {}[{}]: {}\n",
        diagnostic.severity.name(),
        diagnostic.code,
        clean(&diagnostic.message)
    )
}
