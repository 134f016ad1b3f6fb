//! The hover text of a plugin or a parameter in a scene of Mitsuba, pbrt or USD: how the reader
//! reads it, from the tables of `rtc schema support`.

use rtc_front::{ForeignFormat, SupportLevel, SupportRow};
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

/// How a reader reads the word at a byte, and the range of the word; `None` if no table has it.
pub(super) fn meaning(
    text: &str,
    offset: usize,
    format: ForeignFormat,
) -> Option<(String, (usize, usize))> {
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
