//! Scenes of Mitsuba, pbrt and USD: completions, and the hover text of a plugin or a parameter,
//! which is its meaning and how the reader reads it, from the tables of `rtc schema support`.

use super::open_text::OpenText;
use super::protocol::{CompletionItem, CompletionItemKind, Position, TextEdit};
use super::text::Columns;
use rtc_front::{ForeignFormat, Proposal, ProposalKind, SupportLevel, SupportRow};
use rtc_pipeline::SourceKind;
use std::sync::OnceLock;

/// The table of each format, which its reader fills the first time.
static TABLES: [OnceLock<Vec<SupportRow>>; ForeignFormat::ALL.len()] =
    [const { OnceLock::new() }; ForeignFormat::ALL.len()];

/// The format of another program that a document has.
pub(super) fn format(kind: SourceKind) -> Option<ForeignFormat> {
    match kind {
        SourceKind::Mitsuba => Some(ForeignFormat::Mitsuba),
        SourceKind::Pbrt => Some(ForeignFormat::Pbrt),
        SourceKind::Usd => Some(ForeignFormat::Usd),
        SourceKind::Scene | SourceKind::Ir(_) | SourceKind::Gltf | SourceKind::Mesh => None,
    }
}

/// The completions at a position.
pub(super) fn completions(
    document: &OpenText,
    position: Position,
    format: ForeignFormat,
    columns: Columns,
) -> Vec<CompletionItem> {
    let lines = document.lines(columns);
    let completion = format.completion(&document.text, lines.offset(position));
    let Some(completion) = completion else {
        return Vec::new();
    };
    let range = lines.range(completion.replaced.start, completion.replaced.end);
    let proposals = completion.proposals.into_iter().enumerate();
    let item = |(at, Proposal { text, kind, about }): (usize, Proposal)| CompletionItem {
        text_edit: Some(TextEdit::new(range, text.clone())),
        documentation: (!about.is_empty()).then(|| about.to_owned()),
        // Editors sort by names otherwise.
        sort_text: Some(format!("{at:04}")),
        ..CompletionItem::new(text, item_kind(kind))
    };
    proposals.map(item).collect()
}

fn item_kind(kind: ProposalKind) -> CompletionItemKind {
    match kind {
        ProposalKind::Keyword => CompletionItemKind::KEYWORD,
        ProposalKind::Plugin => CompletionItemKind::VALUE,
        ProposalKind::Parameter => CompletionItemKind::PROPERTY,
        ProposalKind::Name => CompletionItemKind::REFERENCE,
    }
}

/// What the table of a reader says of the word at a byte, then how the reader reads it; and the
/// range of the text that is meant. `None` if no table has it.
pub(super) fn meaning(
    text: &str,
    offset: usize,
    format: ForeignFormat,
) -> Option<(String, (usize, usize))> {
    let completion = format.completion(text, offset);
    let declared = completion.as_ref().and_then(|completion| {
        let Proposal { text, about, .. } = completion.written(text)?;
        let range = (completion.replaced.start, completion.replaced.end);
        (!about.is_empty()).then(|| (format!("**`{text}`** {about}"), range))
    });
    match (declared, support(text, offset, format)) {
        (Some((own, range)), Some((support, _))) => Some((format!("{own}\n\n{support}"), range)),
        (declared, support) => declared.or(support),
    }
}

/// How a reader reads the word at a byte, and the range of the word; `None` if no table has it.
fn support(text: &str, offset: usize, format: ForeignFormat) -> Option<(String, (usize, usize))> {
    let (start, end) = word(text, offset)?;
    let word = text.get(start..end)?;
    let quoted = format!("`{word}`");
    let table = TABLES[format as usize].get_or_init(|| format.support());
    let rows = table.iter().filter(|row| row.name.contains(&quoted));
    let lines: Vec<_> = rows.map(line).collect();
    (!lines.is_empty()).then(|| (lines.join("\n\n"), (start, end)))
}

fn line(row: &SupportRow) -> String {
    let read = match row.level {
        SupportLevel::AsIs => "read as it is",
        SupportLevel::Approximated => "read approximately",
        SupportLevel::NotSupported | SupportLevel::Mistaken => "not read",
    };
    let findings = match row.findings.as_str() {
        "" => String::new(),
        findings => format!(": {findings}"),
    };
    format!("**{}** ({}): {read}{findings}.", row.name, row.part)
}

/// The bytes of the word at a byte: letters, digits, `_` and the `:` of names of USD.
fn word(text: &str, offset: usize) -> Option<(usize, usize)> {
    let is_word = |c: char| c.is_alphanumeric() || matches!(c, '_' | ':');
    let (before, after) = text.split_at_checked(offset)?;
    let letters = before.chars().rev().take_while(|c| is_word(*c));
    let start = offset - letters.map(char::len_utf8).sum::<usize>();
    let end = after
        .find(|c| !is_word(c))
        .map_or(text.len(), |at| offset + at);
    (start < end).then_some((start, end))
}
