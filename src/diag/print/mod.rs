//! Printers: diagnostics as text, in the formats of `--message-format`.
//!
//! A [`DiagnosticPrinter`] takes the diagnostics of one file at a time. They are sorted by span,
//! equal ones are folded (`fold`), and their number is capped. `human` shows the source with labels
//! (`window` selects the lines), `short` prints one line each, `json` one object per line; `sarif`
//! and `github` follow their specifications. Control characters of the input are escaped (`text`),
//! so that no input can send a command to a terminal. A printer returns text and writes nothing.

mod fold;
mod github;
mod human;
mod json;
mod location;
mod sarif;
mod short;
mod text;
mod window;

#[cfg(test)]
mod tests;

pub(super) use text::is_unsafe;
pub use text::{clean, clean_json, clean_lines, plural};

use super::{Diagnostic, DiagnosticSink, Severity, codes};
use fold::FoldedDiagnostic;
use rtc_source::SourceMap;
use schemars::Schema;
use schemars::generate::SchemaSettings;

/// The format of the text.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Format {
    /// The source with marks, in the manner of rustc.
    #[default]
    Human,
    /// One line for each diagnostic.
    Short,
    /// One JSON object on each line.
    Json,
    /// SARIF 2.1.0.
    Sarif,
    /// GitHub workflow commands.
    Github,
}

impl Format {
    /// Whether programs read it: then it holds the diagnostics of all severities.
    #[must_use]
    pub fn is_for_programs(self) -> bool {
        matches!(self, Self::Json | Self::Sarif)
    }
}

/// One diagnostic in the human format, without colours.
#[must_use]
pub fn one(found: &Diagnostic, map: &SourceMap, width: usize) -> String {
    let mut each = each(&[found], map, width);
    each.pop().map(|(_, text)| text).unwrap_or_default()
}

/// Each of some diagnostics in the human format, without colours; equal ones are folded into the
/// first of them.
#[must_use]
pub fn each<'a>(
    found: &[&'a Diagnostic],
    map: &SourceMap,
    width: usize,
) -> Vec<(&'a Diagnostic, String)> {
    let options = PrintOptions {
        color: false,
        width,
        least: Severity::Note,
        max: 1,
    };
    let text = |fold: FoldedDiagnostic<'a>| {
        let text = human::diagnostic(&fold, map, &options);
        (fold.first, text)
    };
    fold::equal(found).into_iter().map(text).collect()
}

/// The JSON Schema of one line of [`Format::Json`].
#[must_use]
pub fn json_schema(settings: SchemaSettings) -> Schema {
    json::schema(settings)
}

/// Options of a printer.
#[derive(Clone, Copy, Debug)]
pub struct PrintOptions {
    /// Use colours, in the human format.
    pub color: bool,
    /// The width of the terminal in columns.
    pub width: usize,
    /// The lowest severity that is printed; formats for programs hold all.
    pub least: Severity,
    /// The largest number of diagnostics of a file, at least 1.
    pub max: usize,
}

/// Turns the diagnostics of one file after another into text.
#[derive(Debug)]
pub struct DiagnosticPrinter {
    format: Format,
    options: PrintOptions,
    omitted: usize,
    results: Vec<serde_json::Value>,
    /// The last printed message about settings of a project file.
    settings: Option<String>,
}

impl DiagnosticPrinter {
    /// A printer before its first file.
    #[must_use]
    pub fn new(format: Format, options: PrintOptions) -> Self {
        Self {
            format,
            options,
            omitted: 0,
            results: Vec::new(),
            settings: None,
        }
    }

    /// The note about settings of a project file is printed once even without `-v`: the command
    /// line does not show them.
    fn shows_settings(&self, diagnostic: &Diagnostic) -> bool {
        diagnostic.code.id == codes::SETTINGS_READ.id
            && self.options.least != Severity::Error
            && self.settings.as_ref() != Some(&diagnostic.message)
    }

    /// The text for the diagnostics of the file `name`; empty if none is printed.
    pub fn file(&mut self, name: &str, mut sink: DiagnosticSink, map: &SourceMap) -> String {
        // Keep what the options show, in the order of the text.
        sink.sort();
        let visible = |diagnostic: &&Diagnostic| {
            let is_shown = diagnostic.severity <= self.options.least;
            self.format.is_for_programs() || is_shown || self.shows_settings(diagnostic)
        };
        let found: Vec<&Diagnostic> = sink.kept().iter().filter(visible).collect();
        // Fold equal diagnostics for people, and cap the number of all.
        let folds = match self.format {
            Format::Human => fold::equal(&found),
            Format::Short | Format::Json | Format::Sarif | Format::Github => fold::none(&found),
        };
        let shown = cap(folds, self.options.max);
        let printed: usize = shown.iter().map(|fold| 1 + fold.others.len()).sum();
        let hidden = found.len() - printed + sink.dropped();
        self.omitted += hidden;
        // Print in the format.
        let each = |one: &dyn Fn(&Diagnostic) -> String| {
            shown.iter().map(|fold| one(fold.first)).collect()
        };
        let text: String = match self.format {
            Format::Human => shown
                .iter()
                .map(|fold| human::diagnostic(fold, map, &self.options))
                .collect(),
            Format::Short => each(&|diagnostic| short::diagnostic(name, diagnostic, map)),
            Format::Json => each(&|diagnostic| json::diagnostic(name, diagnostic, map)),
            Format::Github => each(&|diagnostic| github::diagnostic(name, diagnostic, map)),
            Format::Sarif => {
                self.results.extend(
                    shown
                        .iter()
                        .map(|fold| sarif::result(name, fold.first, map)),
                );
                String::new()
            }
        };
        // Remember the settings and add what comes at the end.
        let settings = found
            .iter()
            .find(|diagnostic| diagnostic.code.id == codes::SETTINGS_READ.id);
        if let Some(diagnostic) = settings {
            self.settings = Some(diagnostic.message.clone());
        }
        text + &self.after(name, &found, hidden)
    }

    /// The text after the diagnostics of one file.
    fn after(&self, name: &str, found: &[&Diagnostic], hidden: usize) -> String {
        match self.format {
            Format::Human if !found.is_empty() => human::summary(name, found, hidden),
            Format::Short if hidden > 0 => format!("{}: and {hidden} more\n", text::clean(name)),
            Format::Github if hidden > 0 => github::more(name, hidden),
            Format::Human | Format::Short | Format::Github | Format::Json | Format::Sarif => {
                String::new()
            }
        }
    }

    /// The number of diagnostics about which [`Self::finish`] has a text.
    #[must_use]
    pub fn deferred(&self) -> usize {
        match self.format {
            Format::Sarif => self.results.len() + self.omitted,
            Format::Json => self.omitted,
            Format::Human | Format::Short | Format::Github => 0,
        }
    }

    /// The text after the last file.
    #[must_use]
    pub fn finish(self) -> String {
        match self.format {
            Format::Sarif => sarif::log(&self.results, self.omitted),
            Format::Json if self.omitted > 0 => json::omitted(self.omitted),
            Format::Human | Format::Short | Format::Json | Format::Github => String::new(),
        }
    }
}

/// At most `max` diagnostics: errors before warnings before notes, of each severity the first ones.
/// Their order stays.
fn cap(found: Vec<FoldedDiagnostic<'_>>, max: usize) -> Vec<FoldedDiagnostic<'_>> {
    let mut order: Vec<usize> = (0..found.len()).collect();
    order.sort_by_key(|&index| found[index].first.severity);
    order.truncate(max);
    order.sort_unstable();
    let mut wanted = order.into_iter().peekable();
    let is_wanted = |(index, _): &(usize, FoldedDiagnostic<'_>)| wanted.next_if_eq(index).is_some();
    let kept = found.into_iter().enumerate().filter(is_wanted);
    kept.map(|(_, fold)| fold).collect()
}
