//! Values that are written as keywords.

use super::decode::{Context, Decode};
use super::schema::Definitions;
use super::spelling::quoted_list;
use rtc_diag::{clip, codes, nearest};
use rtc_source::tree::NodeId;
use serde_json::{Value as Json, json};

/// A type whose values are keywords.
pub(super) trait Keyword: Copy + PartialEq + 'static {
    /// The keywords and their values. If several keywords have one value, the first is canonical.
    const KEYWORDS: &'static [(&'static str, Self)];
}

impl<T: Keyword> Decode for T {
    fn decode(node: NodeId, context: &mut Context<'_>) -> Option<Self> {
        keyword(node, T::KEYWORDS, context)
    }

    fn schema(_: &mut Definitions) -> Json {
        keyword_schema(T::KEYWORDS)
    }

    fn json(&self) -> Json {
        let keyword = T::KEYWORDS.iter().find(|(_, value)| value == self);
        keyword.map_or(Json::Null, |(keyword, _)| json!(keyword))
    }
}

/// Reads a keyword of a table; case-insensitive.
pub(super) fn keyword<T: Copy>(
    node: NodeId,
    table: &[(&'static str, T)],
    context: &mut Context<'_>,
) -> Option<T> {
    let keywords = || table.iter().map(|(keyword, _)| *keyword);
    let tree = context.tree;
    let Some(text) = tree.text(node).filter(|text| !text.is_empty()) else {
        return context.expected(node, &format!("one of {}", quoted_list(keywords())));
    };
    let meaning = table
        .iter()
        .find(|(keyword, _)| keyword.eq_ignore_ascii_case(text));
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
    meaning.map(|(_, meaning)| *meaning)
}

/// The schema of [`keyword()`]: editors propose the keywords, and any case is accepted.
pub(super) fn keyword_schema<T>(table: &[(&'static str, T)]) -> Json {
    let any_case = |letter: char| match letter.is_ascii_alphabetic() {
        true => format!("[{}{}]", letter.to_ascii_uppercase(), letter),
        false => letter.to_string(),
    };
    let keywords: Vec<_> = table.iter().map(|(keyword, _)| *keyword).collect();
    let pattern: Vec<String> = keywords
        .iter()
        .map(|keyword| keyword.chars().map(any_case).collect())
        .collect();
    let pattern = format!("^({})$", pattern.join("|"));
    json!({ "anyOf": [{ "enum": keywords }, { "type": "string", "pattern": pattern }] })
}
