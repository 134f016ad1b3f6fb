//! Diagnostics as the page shows them: texts for pages of several widths, with paths relative to
//! the folder of the scene, and what their buttons change.

use super::preview_state::ReportedDiagnostic;
use rtc_diag::{self as diag, Diagnostic};
use rtc_pipeline::{self as pipeline, Input};
use std::path::{MAIN_SEPARATOR, Path};

/// The widths of texts, in columns: over a picture, beside it, and on a telephone.
const WIDTHS: [usize; 3] = [100, 56, 40];

/// The folder of the scene, which is left out of paths.
pub(super) struct ServedFolder(String);

impl ServedFolder {
    pub(super) fn of(scene: &Path) -> Self {
        let folder = scene.parent().filter(|own| !own.as_os_str().is_empty());
        let prefix = |own: &Path| match own.display().to_string() {
            root if root.ends_with(MAIN_SEPARATOR) => root,
            folder => format!("{folder}{MAIN_SEPARATOR}"),
        };
        Self(folder.map(prefix).unwrap_or_default())
    }

    /// A report with paths relative to the folder; lines of a source stay as they are.
    pub(super) fn relative(&self, report: &str) -> String {
        if self.0.is_empty() {
            return report.to_owned();
        }
        let is_source =
            |line: &str| line.starts_with(|first: char| first.is_ascii_digit() || first == '|');
        let line = |line: &str| match is_source(line.trim_start()) {
            true => line.to_owned(),
            false => line.replace(&self.0, ""),
        };
        report.split_inclusive('\n').map(line).collect()
    }
}

/// The first diagnostics, equal ones as one.
pub(super) fn reported(
    found: &[&Diagnostic],
    most: usize,
    input: &Input,
    folder: &ServedFolder,
) -> Vec<ReportedDiagnostic> {
    let [wide, middle, narrow] = WIDTHS.map(|width| diag::each(found, input.map(), width));
    let rows = wide.into_iter().zip(middle).zip(narrow).take(most);
    let row = |(((diagnostic, wide), (_, middle)), (_, narrow))| {
        let texts = [wide, middle, narrow].map(|text: String| folder.relative(&text));
        with_change(diagnostic, texts, input)
    };
    rows.map(row).collect()
}

/// A diagnostic with its texts and the change that fixes it.
fn with_change(diagnostic: &Diagnostic, texts: [String; 3], input: &Input) -> ReportedDiagnostic {
    let changes = diagnostic
        .hints
        .iter()
        .filter_map(|hint| hint.replacement.as_ref());
    let own: Vec<_> = changes.filter(|change| input.is_own(change.span)).collect();
    let is_guess = own.iter().map(|change| change.is_guess);
    let is_guess = is_guess.reduce(|a, b| a && b);
    let summaries = own.iter().filter_map(|change| {
        let written = input.map().slice(change.span);
        change.summary(&written)
    });
    ReportedDiagnostic {
        severity: diagnostic.severity.name(),
        texts,
        fix: is_guess.map(|is_guess| (pipeline::diagnostic_ref(diagnostic), is_guess)),
        change: summaries.collect::<Vec<_>>().join("; "),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn paths_are_relative_but_for_those_of_the_source() {
        let folder = ServedFolder::of(Path::new("/my/scenes/a.yaml"));
        let report = "error: no `/my/scenes/b.png`\n --> /my/scenes/a.yaml:3:1\n  |\n\
            3 | map: /my/scenes/b.png\n";
        let relative = "error: no `b.png`\n --> a.yaml:3:1\n  |\n3 | map: /my/scenes/b.png\n";
        assert_eq!(folder.relative(report), relative);
        assert_eq!(
            ServedFolder::of(Path::new("a.yaml")).relative(report),
            report
        );
    }
}
