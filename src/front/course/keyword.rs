//! Values that are written as keywords.

use super::decode::{Decode, DecodeContext};
use super::schema::SchemaDefinitions;
use super::spelling::quoted_list;
use rtc_diag::{clip, codes, nearest};
use rtc_source::tree::NodeId;
use serde_json::{Value as Json, json};

/// The keywords of a type: each with its value and its meaning. If several keywords have one
/// value, the first is canonical, and the others have no meaning of their own.
pub(super) type KeywordTable<T> = &'static [(&'static str, T, &'static str)];

/// A type whose values are keywords.
pub(super) trait Keyword: Copy + PartialEq + 'static {
    /// The keywords.
    const KEYWORDS: KeywordTable<Self>;
}

impl<T: Keyword> Decode for T {
    fn decode(node: NodeId, context: &mut DecodeContext<'_>) -> Option<Self> {
        keyword(node, T::KEYWORDS, context)
    }

    fn schema(_: &mut SchemaDefinitions) -> Json {
        keyword_schema(T::KEYWORDS)
    }

    fn json(&self) -> Json {
        let keyword = T::KEYWORDS.iter().find(|(_, value, _)| value == self);
        keyword.map_or(Json::Null, |(keyword, ..)| json!(keyword))
    }
}

/// Reads a keyword of a table; case-insensitive, unless the table has two that differ by case
/// alone.
pub(super) fn keyword<T: Copy>(
    node: NodeId,
    table: KeywordTable<T>,
    context: &mut DecodeContext<'_>,
) -> Option<T> {
    let keywords = || table.iter().map(|(keyword, ..)| *keyword);
    let tree = context.tree;
    let Some(text) = tree.text(node).filter(|text| !text.is_empty()) else {
        return context.expected(node, &format!("one of {}", quoted_list(keywords())));
    };
    let exact = table.iter().find(|(keyword, ..)| *keyword == text);
    let mut words = table.iter();
    let meaning = exact.or_else(|| words.find(|(known, ..)| known.eq_ignore_ascii_case(text)));
    if meaning.is_none() {
        let (key, span) = (context.key, tree.span(node));
        let suggestion = nearest(text, keywords())
            .map(|suggestion| (suggestion, context.with_quotes_of(node, suggestion)));
        let message = || format!("`{}` can't be `{}`", clip(key.text), clip(text));
        context.report(&codes::UNKNOWN_WORD, span, message, |d| {
            let d = d
                .at(span, "unknown")
                .hint(format!("it is one of {}", quoted_list(keywords())));
            match suggestion {
                Some((suggestion, replacement)) => {
                    d.guess(format!("did you mean `{suggestion}`?"), span, replacement)
                }
                None => d,
            }
        });
    }
    meaning.map(|(_, meaning, _)| *meaning)
}

/// The schema of [`keyword()`]: editors propose the canonical keywords, and any case is accepted.
pub(super) fn keyword_schema<T>(table: KeywordTable<T>) -> Json {
    let any_case = |letter: char| match letter.is_ascii_alphabetic() {
        true => format!("[{}{}]", letter.to_ascii_uppercase(), letter),
        false => letter.to_string(),
    };
    let pattern: Vec<String> = table
        .iter()
        .map(|(keyword, ..)| keyword.chars().map(any_case).collect())
        .collect();
    let pattern = format!("^({})$", pattern.join("|"));
    let mut variants = enumeration(table.iter().map(|(keyword, _, doc)| (*keyword, *doc)));
    variants.push(json!({ "type": "string", "pattern": pattern }));
    json!({ "anyOf": variants })
}

/// The schemas of words with their meanings, and of other spellings, which have none.
pub(super) fn enumeration<'t>(words: impl Iterator<Item = (&'t str, &'t str)>) -> Vec<Json> {
    let (known, others): (Vec<_>, Vec<_>) = words.partition(|(_, doc)| !doc.is_empty());
    let (known, docs): (Vec<_>, Vec<_>) = known.into_iter().unzip();
    let mut variants = vec![json!({ "enum": known, "enumDescriptions": docs })];
    if !others.is_empty() {
        let others: Vec<_> = others.iter().map(|(word, _)| *word).collect();
        variants.push(json!({ "enum": others, "deprecated": true }));
    }
    variants
}
