//! From findings to text: for people, editors, programs, code scanning and GitHub.
//!
//! Findings come out sorted by place, folded and capped; nothing of the input can command a terminal;
//! nothing is written here.

mod fold;
mod github;
mod human;
mod json;
mod place;
mod sarif;
mod short;
mod text;
mod window;

#[cfg(test)]
mod tests;

use super::{Diagnostic, Severity, Sink, codes};
use fold::Fold;
use rtc_source::SourceMap;

/// The form of the text.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Format {
    /// With the source and marks in it.
    #[default]
    Human,
    /// One line a finding.
    Short,
    /// One JSON object a line.
    Json,
    /// SARIF 2.1.0.
    Sarif,
    /// GitHub workflow commands.
    Github,
}

impl Format {
    /// True if programs read it: then it holds every finding, whatever its severity.
    #[must_use]
    pub fn is_for_programs(self) -> bool {
        matches!(self, Self::Json | Self::Sarif)
    }
}

/// One finding for people, without colours.
#[must_use]
pub fn one(found: &Diagnostic, map: &SourceMap, width: usize) -> String {
    let options = PrintOptions {
        color: false,
        width,
        least: Severity::Note,
        max: 1,
    };
    let alone = Fold {
        first: found,
        others: Vec::new(),
    };
    human::finding(&alone, map, &options)
}

/// How findings are shown.
#[derive(Clone, Copy, Debug)]
pub struct PrintOptions {
    /// With colours, in the human format.
    pub color: bool,
    /// Columns of the terminal.
    pub width: usize,
    /// The least severity shown; programs always get everything.
    pub least: Severity,
    /// At most this many findings of a file, at least 1.
    pub max: usize,
}

/// Turns the findings of one file after another into text.
#[derive(Debug)]
pub struct Printer {
    format: Format,
    options: PrintOptions,
    omitted: usize,
    results: Vec<serde_json::Value>,
    /// Which settings hold, as it was told last.
    settings: Option<String>,
}

impl Printer {
    /// A printer that has seen no file.
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

    /// Which settings hold is told once wherever warnings are: what nobody typed surprises.
    fn tells_settings(&self, finding: &Diagnostic) -> bool {
        finding.code.id == codes::SETTINGS_READ.id
            && self.options.least != Severity::Error
            && self.settings.as_ref() != Some(&finding.message)
    }

    /// The text for the findings of the file `name`; empty if there are none to show.
    pub fn file(&mut self, name: &str, mut sink: Sink, map: &SourceMap) -> String {
        sink.sort();
        let visible = |diagnostic: &&Diagnostic| {
            let is_shown = diagnostic.severity <= self.options.least;
            self.format.is_for_programs() || is_shown || self.tells_settings(diagnostic)
        };
        let found: Vec<&Diagnostic> = sink.kept().iter().filter(visible).collect();
        let folds = match self.format {
            Format::Human => fold::equal(&found),
            Format::Short | Format::Json | Format::Sarif | Format::Github => fold::none(&found),
        };
        let shown = cap(folds, self.options.max);
        let told: usize = shown.iter().map(|fold| 1 + fold.others.len()).sum();
        let hidden = found.len() - told + sink.dropped();
        self.omitted += hidden;
        let each = |one: &dyn Fn(&Diagnostic) -> String| {
            shown.iter().map(|fold| one(fold.first)).collect()
        };
        let text: String = match self.format {
            Format::Human => shown
                .iter()
                .map(|fold| human::finding(fold, map, &self.options))
                .collect(),
            Format::Short => each(&|diagnostic| short::finding(name, diagnostic, map)),
            Format::Json => each(&|diagnostic| json::finding(name, diagnostic, map)),
            Format::Github => each(&|diagnostic| github::finding(name, diagnostic, map)),
            Format::Sarif => {
                self.results.extend(
                    shown
                        .iter()
                        .map(|fold| sarif::result(name, fold.first, map)),
                );
                String::new()
            }
        };
        let told = found
            .iter()
            .find(|finding| finding.code.id == codes::SETTINGS_READ.id);
        if let Some(finding) = told {
            self.settings = Some(finding.message.clone());
        }
        text + &self.after(name, &found, hidden)
    }

    /// The text after the findings of one file.
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

/// At most `max` findings: errors before warnings before notes, and each kind from the top, in
/// order of place.
fn cap(found: Vec<Fold<'_>>, max: usize) -> Vec<Fold<'_>> {
    let mut order: Vec<usize> = (0..found.len()).collect();
    order.sort_by_key(|&index| found[index].first.severity);
    order.truncate(max);
    order.sort_unstable();
    let mut wanted = order.into_iter().peekable();
    let is_wanted = |(index, _): &(usize, Fold<'_>)| wanted.next_if_eq(index).is_some();
    let kept = found.into_iter().enumerate().filter(is_wanted);
    kept.map(|(_, fold)| fold).collect()
}
