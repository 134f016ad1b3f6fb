//! One line for each diagnostic, for editors: `file:line:column: error[VA001]: message`.

use super::location::SourceLocation;
use super::text::clean;
use crate::Diagnostic;
use rtc_source::SourceMap;

/// One diagnostic; `name` is its file if it has no span.
pub(super) fn diagnostic(name: &str, diagnostic: &Diagnostic, map: &SourceMap) -> String {
    let place = match (&diagnostic.primary, &diagnostic.pointer) {
        (Some(label), _) => SourceLocation::new(map, label.span).to_string(),
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
