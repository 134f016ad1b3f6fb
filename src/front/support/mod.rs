//! What the readers of Mitsuba, pbrt and USD read as it is, approximate and leave out.
//!
//! The tables hold examples, not claims: the reader itself reads each one, and what it reports is
//! what `rtc schema support` prints. A row without a finding is read as it is.

#[cfg(test)]
#[expect(
    clippy::disallowed_methods,
    reason = "its tests read the scenes and the sources of the repository"
)]
mod declared;
mod files;
mod mitsuba;
mod pbrt;
mod usd;

use crate::plugin::Completion;
use crate::{FrontOptions, mitsuba as mitsuba_reader, pbrt as pbrt_reader, usd as usd_reader};
use rtc_diag::{DiagnosticSink, Severity, codes};
use rtc_ir::LoweredScene;
use rtc_source::{FileId, Loader, MemoryFiles, SourceMap};
use std::fmt::Write as _;
use std::sync::Arc;

/// A format of another program whose support is listed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ForeignFormat {
    /// Scenes of Mitsuba.
    Mitsuba,
    /// Scenes of pbrt.
    Pbrt,
    /// Stages of USD.
    Usd,
}

/// How a part of a file is read.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum SupportLevel {
    /// Without a finding.
    AsIs,
    /// Something similar is shown.
    Approximated,
    /// It is replaced or left out.
    NotSupported,
    /// The example is a mistake.
    Mistaken,
}

/// What the reader makes of an example.
#[derive(Clone, Debug)]
pub struct SupportRow {
    /// The kind of the part.
    pub part: &'static str,
    /// The part, in Markdown.
    pub name: &'static str,
    /// How it is read.
    pub level: SupportLevel,
    /// What the reader reports, one sentence after the other.
    pub findings: String,
}

/// Examples of one kind: the text of each stands between `before` and `after`.
struct ExamplePart {
    title: &'static str,
    before: &'static [&'static str],
    after: &'static str,
    /// The name of each, in Markdown, and its text.
    examples: &'static [(&'static str, &'static str)],
}

type Reader =
    fn(FileId, &mut SourceMap, &FrontOptions, &mut DiagnosticSink) -> Option<LoweredScene>;

impl ForeignFormat {
    /// All formats.
    pub const ALL: [Self; 3] = [Self::Mitsuba, Self::Pbrt, Self::Usd];

    fn name(self) -> &'static str {
        match self {
            Self::Mitsuba => "Mitsuba",
            Self::Pbrt => "pbrt",
            Self::Usd => "USD",
        }
    }

    fn file(self) -> &'static str {
        match self {
            Self::Mitsuba => "scene.xml",
            Self::Pbrt => "scene.pbrt",
            Self::Usd => "scene.usda",
        }
    }

    fn parts(self) -> &'static [ExamplePart] {
        match self {
            Self::Mitsuba => mitsuba::PARTS,
            Self::Pbrt => pbrt::PARTS,
            Self::Usd => usd::PARTS,
        }
    }

    fn reader(self) -> Reader {
        match self {
            Self::Mitsuba => mitsuba_reader::lower,
            Self::Pbrt => pbrt_reader::lower,
            Self::Usd => usd_reader::lower,
        }
    }

    /// What the reader makes of each example.
    #[must_use]
    pub fn support(self) -> Vec<SupportRow> {
        let beside = files::beside();
        let rows = self.parts().iter().flat_map(|part| {
            let beside = &beside;
            part.examples.iter().map(move |(name, text)| {
                let text = [&part.before.concat(), *text, part.after].concat();
                let (level, findings) = self.tried(&text, beside);
                SupportRow {
                    part: part.title,
                    name,
                    level,
                    findings,
                }
            })
        });
        rows.collect()
    }

    /// What an editor proposes at a byte of a text, which may be incomplete there.
    #[must_use]
    pub fn completion(self, text: &str, offset: usize) -> Option<Completion> {
        match self {
            Self::Pbrt => pbrt_reader::completion::completion(text, offset),
            Self::Mitsuba => mitsuba_reader::completion::completion(text, offset),
            Self::Usd => None,
        }
    }

    /// Has the reader read a text: how it is read, and the findings.
    fn tried(self, text: &str, beside: &[(String, Vec<u8>)]) -> (SupportLevel, String) {
        let scene = (self.file().to_owned(), text.as_bytes().to_vec());
        let files = Arc::new(MemoryFiles::new(beside.iter().cloned().chain([scene])));
        let (mut map, mut sink) = (SourceMap::default(), DiagnosticSink::default());
        let Ok(file) = Loader.memory(self.file(), &files, &mut map) else {
            return (
                SupportLevel::Mistaken,
                "the example cannot be read".to_owned(),
            );
        };
        let lowered = self.reader()(file, &mut map, &FrontOptions::default(), &mut sink);
        let found = sink.kept().iter();
        let level = found.map(|diagnostic| match diagnostic.severity {
            Severity::Error => SupportLevel::Mistaken,
            Severity::Note => SupportLevel::AsIs,
            Severity::Warning if is_approximation(diagnostic.code.id) => SupportLevel::Approximated,
            Severity::Warning => SupportLevel::NotSupported,
        });
        let level = level.max().unwrap_or(SupportLevel::AsIs);
        let level = if lowered.is_some() {
            level
        } else {
            SupportLevel::Mistaken
        };
        let reported = sink.kept().iter();
        let reported = reported.filter(|diagnostic| diagnostic.severity != Severity::Note);
        let messages: Vec<_> = reported
            .map(|diagnostic| diagnostic.message.as_str())
            .collect();
        (level, messages.join("; "))
    }
}

/// Whether a code is that of an approximation.
fn is_approximation(code: &str) -> bool {
    let codes = [
        &codes::MITSUBA_APPROXIMATE,
        &codes::PBRT_APPROXIMATE,
        &codes::USD_APPROXIMATE,
    ];
    codes.iter().any(|known| known.id == code)
}

/// The Markdown page about formats.
#[must_use]
pub fn page(formats: &[ForeignFormat]) -> String {
    let mut page = "# What is read of other programs' scenes\n\n\
        `rtc schema support mitsuba`, `pbrt` or `usd` prints a table. Each row is an example that the \
        reader reads, with what it reports of it.\n"
        .to_owned();
    for format in formats {
        write!(
            page,
            "\n## {}\n\n{}",
            format.name(),
            table(&format.support())
        )
        .expect("a string takes all that is written to it");
    }
    page
}

fn table(rows: &[SupportRow]) -> String {
    let mut table = "| part | | read | findings |\n| --- | --- | --- | --- |\n".to_owned();
    let mut last = "";
    for SupportRow {
        part,
        name,
        level,
        findings,
    } in rows
    {
        let shown = if *part == last { "" } else { part };
        last = part;
        let read = match level {
            SupportLevel::AsIs => "as it is",
            SupportLevel::Approximated => "approximately",
            SupportLevel::NotSupported => "no",
            SupportLevel::Mistaken => "mistaken",
        };
        let findings = findings.replace('|', "\\|");
        writeln!(table, "| {shown} | {name} | {read} | {findings} |")
            .expect("a string takes all that is written to it");
    }
    table
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeSet;

    #[test]
    fn no_example_is_a_mistake_and_none_stands_twice() {
        for format in ForeignFormat::ALL {
            let rows = format.support();
            let wrong = rows
                .iter()
                .filter(|row| row.level == SupportLevel::Mistaken);
            assert_eq!(
                wrong.map(|row| format!("{row:?}")).collect::<Vec<_>>(),
                [""; 0]
            );
            let names: BTreeSet<_> = rows.iter().map(|row| (row.part, row.name)).collect();
            assert_eq!(names.len(), rows.len());
        }
    }

    #[test]
    fn each_level_has_a_finding_unless_all_is_read() {
        for row in ForeignFormat::ALL
            .into_iter()
            .flat_map(ForeignFormat::support)
        {
            let is_silent = row.findings.is_empty();
            assert_eq!(is_silent, row.level == SupportLevel::AsIs, "{row:?}");
        }
    }
}
