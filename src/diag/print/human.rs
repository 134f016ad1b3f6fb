//! For people: the source with its marks, in the style of rustc. The one file that names
//! `annotate-snippets`.

use super::fold::FoldedDiagnostic;
use super::location::SourceLocation;
use super::text::{clean, clean_except};
use super::window::{self, SourceWindow};
use super::{PrintOptions, text};
use crate::{Diagnostic, Hint, Label, Replacement, Severity};
use annotate_snippets::renderer::DecorStyle;
use annotate_snippets::{
    Annotation, AnnotationKind, Element, Group, Level, Origin, Patch, Renderer, Snippet,
};
use rtc_source::SourceMap;

/// A label, and whether it is the primary one.
type PrintedLabel<'a> = (&'a Label, AnnotationKind);

/// One diagnostic, with the number of equal ones, and an empty line.
pub(super) fn diagnostic(
    fold: &FoldedDiagnostic<'_>,
    map: &SourceMap,
    options: &PrintOptions,
) -> String {
    let renderer = if options.color {
        Renderer::styled()
    } else {
        Renderer::plain()
    };
    let renderer = renderer
        .term_width(options.width)
        .decor_style(DecorStyle::Ascii);
    let report = report(fold, map);
    let rendered = renderer.render(&report);
    format!("{}\n\n", rendered.trim_end_matches('\n'))
}

/// The text after the diagnostics of one file: their number, and how to read more about the most
/// severe one.
pub(super) fn summary(name: &str, found: &[&Diagnostic], hidden: usize) -> String {
    let more = if hidden == 0 {
        String::new()
    } else {
        format!("and {hidden} more\n")
    };
    let worst = found.iter().min_by_key(|diagnostic| diagnostic.severity);
    let explain = worst
        .map(|worst| format!("; see `rtc explain {}`", worst.code))
        .unwrap_or_default();
    format!("{more}{}: {}{explain}\n", clean(name), counts(found))
}

fn report<'a>(fold: &FoldedDiagnostic<'a>, map: &'a SourceMap) -> Vec<Group<'a>> {
    let diagnostic = fold.first;
    let Diagnostic {
        code,
        severity,
        message,
        primary: _,
        secondary: _,
        hints,
        pointer,
        alias: _,
        cause: _,
    } = diagnostic;
    let title = level(*severity).primary_title(clean(message)).id(code.id);
    let mut first = Group::with_title(title).elements(marks(diagnostic, map));
    if let Some(pointer) = pointer.as_ref().filter(|_| diagnostic.primary.is_none()) {
        first = first.element(Level::NOTE.message(format!("at `{}`", clean(pointer))));
    }
    if let Some(note) = fold.note(map) {
        first = first.element(Level::NOTE.message(note));
    }
    let mut patches = Vec::new();
    for hint in hints {
        match patch(hint, map) {
            Some(group) => patches.push(group),
            None => first = first.element(Level::HELP.message(clean(&hint.text))),
        }
    }
    std::iter::once(first).chain(patches).collect()
}

fn level(severity: Severity) -> Level<'static> {
    match severity {
        Severity::Error => Level::ERROR,
        Severity::Warning => Level::WARNING,
        Severity::Note => Level::NOTE,
    }
}

/// The marked lines: the window with the primary label first, then the others.
fn marks<'a>(diagnostic: &'a Diagnostic, map: &'a SourceMap) -> Vec<Element<'a>> {
    let primary = diagnostic
        .primary
        .iter()
        .map(|label| (label, AnnotationKind::Primary));
    let mut marks: Vec<PrintedLabel<'a>> = primary
        .chain(
            diagnostic
                .secondary
                .iter()
                .map(|label| (label, AnnotationKind::Context)),
        )
        .collect();
    marks.sort_by_key(|(label, _)| label.span);
    let mut runs = window::runs(marks, |(label, _)| window::mark(map, label.span));
    runs.sort_by_key(|run| !run.iter().any(|(_, kind)| *kind == AnnotationKind::Primary));
    runs.iter().flat_map(|run| snippet(run, map)).collect()
}

fn snippet<'a>(run: &[PrintedLabel<'a>], map: &'a SourceMap) -> Vec<Element<'a>> {
    let head = run
        .iter()
        .find(|(_, kind)| *kind == AnnotationKind::Primary)
        .unwrap_or(&run[0])
        .0;
    if !map.is_text(head.span.file)
        || !run
            .iter()
            .all(|(label, _)| window::is_near(map, label.span))
    {
        return without_source(run, &SourceLocation::new(map, head.span));
    }
    let spans: Vec<_> = run
        .iter()
        .map(|(label, _)| window::mark(map, label.span))
        .collect();
    let window = SourceWindow::new(map, &spans);
    let annotation = |(&(label, kind), &span): (&PrintedLabel<'a>, _)| -> Annotation<'a> {
        let text = Some(clean(&label.text)).filter(|text| !text.is_empty());
        kind.span(window.range(span)).label(text)
    };
    let annotations: Vec<_> = run.iter().zip(&spans).map(annotation).collect();
    let snippet = Snippet::source(window.text)
        .line_start(window.first_line)
        .annotations(annotations);
    vec![snippet.path(clean(map.name(head.span.file))).into()]
}

/// The location and the labels of spans whose source is not printed.
fn without_source<'a>(run: &[PrintedLabel<'a>], place: &SourceLocation) -> Vec<Element<'a>> {
    let labels = run.iter().filter(|(label, _)| !label.text.is_empty());
    let notes = labels.map(|(label, _)| Level::NOTE.message(clean(&label.text)).into());
    std::iter::once(Origin::path(place.to_string()).into())
        .chain(notes)
        .collect()
}

/// The hint as a change of the source, if it has a replacement that can be printed.
fn patch<'a>(hint: &'a Hint, map: &'a SourceMap) -> Option<Group<'a>> {
    let Replacement { span, text, .. } = hint.replacement.as_ref()?;
    if !map.is_text(span.file) || !window::fits(map, *span) {
        return None;
    }
    let window = SourceWindow::new(map, &[*span]);
    let patch = Patch::new(window.range(*span), clean_except(text, &['\n', '\t']));
    let snippet = Snippet::source(window.text)
        .line_start(window.first_line)
        .patch(patch);
    Some(
        Level::HELP
            .secondary_title(clean(&hint.text))
            .element(snippet.path(clean(map.name(span.file)))),
    )
}

/// `2 errors, 1 warning`.
fn counts(found: &[&Diagnostic]) -> String {
    let names = [
        (Severity::Error, "error"),
        (Severity::Warning, "warning"),
        (Severity::Note, "note"),
    ];
    let count = |severity| {
        found
            .iter()
            .filter(|diagnostic| diagnostic.severity == severity)
            .count()
    };
    let parts = names
        .map(|(severity, name)| (count(severity), name))
        .into_iter()
        .filter(|(count, _)| *count > 0);
    parts
        .map(|(count, name)| text::plural(count, name))
        .collect::<Vec<_>>()
        .join(", ")
}
