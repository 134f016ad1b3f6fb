//! Diagnostics in the form of the protocol, by file, and their suggestions as quick fixes.

use super::super::args::ReadArgs;
use super::open_text::{CheckedScene, CheckedText, OpenText};
use super::place;
use super::protocol::{
    CodeAction, CodeActionKind, DiagnosticRelatedInformation, DiagnosticSeverity, EditorDiagnostic,
    Location, Range, TextEdit, WorkspaceEdit,
};
use super::text::{Columns, TextLines};
use super::uri::DocumentUri;
use rtc_diag::{self as diag, Severity};
use rtc_pipeline::{self as pipeline, FixFilter};
use rtc_source::{FileId, Span};
use std::cell::RefCell;
use std::collections::BTreeMap;
use std::path::Path;

/// The `source` of the diagnostics.
const SOURCE: &str = "rtc";

/// A file and its diagnostics.
pub(super) type FileDiagnostics = (DocumentUri, Vec<EditorDiagnostic>);

/// The diagnostics of a document, by file; those without a span are at the beginning of the
/// document.
pub(super) fn diagnostics(document: &OpenText, columns: Columns) -> Vec<FileDiagnostics> {
    let mut own = Vec::new();
    let mut others: Vec<FileDiagnostics> = Vec::new();
    if let Some(CheckedText::Failed(error_text)) = &document.checked {
        own.push(EditorDiagnostic {
            range: Range::default(),
            severity: DiagnosticSeverity::ERROR,
            code: None,
            source: SOURCE,
            message: error_text.clone(),
            related_information: None,
        });
    }
    let mut place_of: BTreeMap<String, usize> = BTreeMap::new();
    if let Some(checked) = document.scene() {
        let atlas = DocumentLineTables::new(document, checked, columns);
        for diagnostic in &checked.diagnostics {
            let (uri, diagnostic) = atlas.diagnostic(diagnostic);
            if uri == document.uri {
                own.push(diagnostic);
                continue;
            }
            let place = place_of.entry(uri.as_str().to_owned()).or_insert_with(|| {
                others.push((uri, Vec::new()));
                others.len() - 1
            });
            others[*place].1.push(diagnostic);
        }
    }
    others.insert(0, (document.uri.clone(), own));
    others
}

/// The files of a checked document with their line tables, which are computed once.
struct DocumentLineTables<'d> {
    document: &'d OpenText,
    checked: &'d CheckedScene,
    lines: TextLines<'d>,
    /// The other files, and their lines if they are text.
    others: RefCell<BTreeMap<FileId, (DocumentUri, Option<TextLines<'d>>)>>,
}

impl<'d> DocumentLineTables<'d> {
    fn new(document: &'d OpenText, checked: &'d CheckedScene, columns: Columns) -> Self {
        Self {
            document,
            checked,
            lines: document.lines(columns),
            others: RefCell::default(),
        }
    }

    fn diagnostic(&self, diagnostic: &diag::Diagnostic) -> (DocumentUri, EditorDiagnostic) {
        let primary = diagnostic.primary.as_ref();
        let primary = primary.map(|label| self.location(label.span));
        let start = || Location::new(self.document.uri.clone(), Range::default());
        let Location { uri, range } = primary.unwrap_or_else(start);
        let related = diagnostic
            .secondary
            .iter()
            .map(|label| DiagnosticRelatedInformation {
                location: self.location(label.span),
                message: label.text.clone(),
            });
        let diagnostic = EditorDiagnostic {
            range,
            severity: match diagnostic.severity {
                Severity::Error => DiagnosticSeverity::ERROR,
                Severity::Warning => DiagnosticSeverity::WARNING,
                Severity::Note => DiagnosticSeverity::HINT,
            },
            code: Some(diagnostic.code.id),
            source: SOURCE,
            message: message(diagnostic),
            related_information: Some(related.collect()),
        };
        (uri, diagnostic)
    }

    /// The location of a span.
    fn location(&self, span: Span) -> Location {
        let Span { file, start, end } = span;
        let range = |lines: &TextLines<'_>| lines.range(start as usize, end as usize);
        if self.checked.is_own(file) {
            return Location::new(self.document.uri.clone(), range(&self.lines));
        }
        let mut others = self.others.borrow_mut();
        let (uri, lines) = others.entry(file).or_insert_with(|| self.other(file));
        let range = lines.as_ref().map_or_else(Range::default, range);
        Location::new(uri.clone(), range)
    }

    /// Another file.
    fn other(&self, file: FileId) -> (DocumentUri, Option<TextLines<'d>>) {
        let map = self.checked.map();
        let uri = place::uri(Path::new(map.name(file)));
        let uri = uri.unwrap_or_else(|| self.document.uri.clone());
        let text = map.text(file);
        (uri, text.map(|text| self.lines.of_other(text)))
    }
}

/// The message, the label and the hints, one per line.
fn message(diagnostic: &diag::Diagnostic) -> String {
    let here = diagnostic.primary.as_ref().map(|label| label.text.as_str());
    let hints = diagnostic
        .hints
        .iter()
        .map(|hint| format!("help: {}", hint.text));
    let lines = here.filter(|text| !text.is_empty()).map(str::to_owned);
    let all = std::iter::once(diagnostic.message.clone())
        .chain(lines)
        .chain(hints);
    all.collect::<Vec<_>>().join("\n")
}

/// The quick fixes of the diagnostics in a range of a checked document. All safe fixes at once only
/// if requested by kind, since that needs many checks.
pub(super) fn actions(
    document: &OpenText,
    range: Range,
    only: Option<&[CodeActionKind]>,
    reading: &ReadArgs,
    columns: Columns,
) -> Vec<CodeAction> {
    let lines = document.lines(columns);
    // An editor that fixes on saving asks for all fixes of the file.
    if let Some(kinds) = only
        && !kinds.contains(&CodeActionKind::QUICKFIX)
    {
        let source = [CodeActionKind::SOURCE, CodeActionKind::SOURCE_FIX_ALL];
        let is_asked = kinds.iter().any(|kind| source.contains(kind));
        let fixed = is_asked.then(|| fix_all(document, reading, &lines));
        return fixed.flatten().into_iter().collect();
    }
    let Some(checked) = document.scene() else {
        return Vec::new();
    };
    // Collect the fixes of diagnostics that touch the range.
    let atlas = DocumentLineTables::new(document, checked, columns);
    let fixes = checked.diagnostics.iter().flat_map(|diagnostic| {
        let (uri, reported) = atlas.diagnostic(diagnostic);
        let is_here = uri == document.uri && touch(reported.range, range);
        let hints = diagnostic.hints.iter().filter(move |_| is_here);
        let changes = hints.filter_map(|hint| {
            let change = hint.replacement.as_ref()?;
            checked.is_own(change.span.file).then_some((hint, change))
        });
        changes
            .map(|(hint, change)| {
                let (start, end) = (change.span.start as usize, change.span.end as usize);
                let edit = TextEdit::new(lines.range(start, end), change.text.clone());
                let written = document.text.get(start..end).unwrap_or_default();
                let title = change.summary(written).unwrap_or_else(|| hint.text.clone());
                quick_fix(document, title, !change.is_guess, edit, reported.clone())
            })
            .collect::<Vec<_>>()
    });
    let mut fixes: Vec<CodeAction> = fixes.collect();
    // The sure ones first.
    fixes.sort_by_key(|fix| fix.is_preferred != Some(true));
    fixes
}

fn quick_fix(
    document: &OpenText,
    title: String,
    is_certain: bool,
    edit: TextEdit,
    repaired: EditorDiagnostic,
) -> CodeAction {
    CodeAction {
        title,
        kind: CodeActionKind::QUICKFIX,
        diagnostics: Some(vec![repaired]),
        edit: change_of(document, edit),
        is_preferred: Some(is_certain),
    }
}

/// What `rtc check --fix` does to the text, if that is anything.
fn fix_all(document: &OpenText, reading: &ReadArgs, lines: &TextLines<'_>) -> Option<CodeAction> {
    let (options, _) = document.options(reading).ok()?;
    let wish = FixFilter::default();
    let fixed = pipeline::fix(&document.path, &document.text, &options, &wish);
    if fixed.changes == 0 {
        return None;
    }
    let edit = TextEdit::new(lines.range(0, document.text.len()), fixed.text);
    Some(CodeAction {
        title: "make all sure fixes of the file, as `rtc check --fix`".to_owned(),
        kind: CodeActionKind::SOURCE_FIX_ALL,
        diagnostics: None,
        edit: change_of(document, edit),
        is_preferred: None,
    })
}

fn change_of(document: &OpenText, edit: TextEdit) -> WorkspaceEdit {
    WorkspaceEdit {
        changes: [(document.uri.clone(), vec![edit])].into(),
    }
}

fn touch(a: Range, b: Range) -> bool {
    a.start <= b.end && b.start <= a.end
}
