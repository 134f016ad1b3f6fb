//! Semantic tokens: the keys that the format knows, words, file names, anchors and aliases.

use super::anchor::anchors;
use super::completion::{is_file, words};
use super::open_text::OpenText;
use super::text::{Columns, TextLines};
use super::traverse::traverse;
use super::vocabulary::Vocabulary;
use serde_json::Value;
use std::ops::Range;

/// The types of tokens, by their numbers.
pub(super) const TYPES: [&str; 4] = ["property", "enumMember", "string", "variable"];
const PROPERTY: u32 = 0;
const WORD: u32 = 1;
const FILE: u32 = 2;
const NAME: u32 = 3;

/// The modifiers of tokens, by their bits.
pub(super) const MODIFIERS: [&str; 2] = ["deprecated", "declaration"];
const DEPRECATED: u32 = 1;
const DECLARATION: u32 = 2;

/// The bytes of a token, its type and its modifiers.
type SemanticToken = (Range<usize>, [u32; 2]);

/// The tokens in some bytes of a document, as the protocol encodes them: five numbers each, places
/// relative to the token before.
pub(super) fn tokens(
    document: &OpenText,
    bytes: &Range<usize>,
    vocabulary: &Vocabulary,
    columns: Columns,
) -> Vec<u32> {
    let Some(tree) = document.tree() else {
        return Vec::new();
    };
    let mut tokens: Vec<SemanticToken> = Vec::new();
    let range = |id| {
        let (start, end) = tree.range(id);
        start..end
    };
    traverse(&tree, vocabulary, bytes, |visited| {
        let is_old = |key: &str| {
            visited
                .schemas
                .iter()
                .any(|own| own.get(key) == Some(&Value::Bool(true)))
        };
        if let Some(key) = visited.key
            && !visited.schemas.is_empty()
        {
            let old = if is_old("deprecated") { DEPRECATED } else { 0 };
            tokens.push((range(key), [PROPERTY, old]));
        }
        if tree.target(visited.node) != visited.node {
            return tokens.push((range(visited.node), [NAME, 0]));
        }
        let Some(text) = tree.text(visited.node) else {
            return;
        };
        let is_word = || {
            let mut words = words(visited.schemas).into_iter();
            words.any(|(word, _)| word.eq_ignore_ascii_case(text))
        };
        if is_word() {
            tokens.push((range(visited.node), [WORD, 0]));
        } else if is_file(visited.schemas) {
            tokens.push((range(visited.node), [FILE, 0]));
        }
    });
    let named = anchors(&document.text, &tree).into_iter();
    let named = named.map(|anchor| anchor.bytes.start - 1..anchor.bytes.end);
    let named = named.filter(|own| own.start <= bytes.end && bytes.start <= own.end);
    tokens.extend(named.map(|own| (own, [NAME, DECLARATION])));
    tokens.sort_unstable_by_key(|(own, _)| own.start);
    encoded(&tokens, &document.lines(columns))
}

fn encoded(tokens: &[SemanticToken], lines: &TextLines<'_>) -> Vec<u32> {
    let mut encoded = Vec::with_capacity(5 * tokens.len());
    let (mut line, mut column) = (0, 0);
    for (bytes, [kind, modifiers]) in tokens {
        let range = lines.range(bytes.start, bytes.end);
        let (start, end) = (range.start, range.end);
        // Editors know no tokens of several lines.
        if start.line != end.line {
            continue;
        }
        let below = start.line - line;
        let right = if below == 0 {
            start.character - column
        } else {
            start.character
        };
        let length = end.character - start.character;
        encoded.extend([below, right, length, *kind, *modifiers]);
        (line, column) = (start.line, start.character);
    }
    encoded
}
