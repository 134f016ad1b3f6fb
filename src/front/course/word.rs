//! Words: values of which each has a name.

use super::decode::{Context, Value};
use super::schema::Definitions;
use super::spelling::list;
use rtc_diag::{clip, codes, nearest};
use rtc_source::tree::NodeId;
use serde_json::{Value as Json, json};

/// A type of which each value is written as a word.
pub(super) trait Words: Copy + PartialEq + 'static {
    /// The words, and what each means; of several for one value the first is shown.
    const WORDS: &'static [(&'static str, Self)];
}

impl<T: Words> Value for T {
    fn decode(node: NodeId, context: &mut Context<'_>) -> Option<Self> {
        word(node, T::WORDS, context)
    }

    fn schema(_: &mut Definitions) -> Json {
        word_schema(T::WORDS)
    }

    fn json(&self) -> Json {
        let word = T::WORDS.iter().find(|(_, value)| value == self);
        word.map_or(Json::Null, |(word, _)| json!(word))
    }
}

/// A word of a table, in any case of letters: the table's words, and what each means.
pub(super) fn word<T: Copy>(
    node: NodeId,
    table: &[(&'static str, T)],
    context: &mut Context<'_>,
) -> Option<T> {
    let words = || table.iter().map(|(word, _)| *word);
    let tree = context.tree;
    let Some(text) = tree.text(node).filter(|text| !text.is_empty()) else {
        return context.expected(node, &format!("one of {}", list(words())));
    };
    let meaning = table
        .iter()
        .find(|(word, _)| word.eq_ignore_ascii_case(text));
    if meaning.is_none() {
        let (key, span) = (context.key, tree.span(node));
        let meant = nearest(text, words()).map(|meant| (meant, context.in_its_quotes(node, meant)));
        let message = || format!("`{}` can't be `{}`", clip(key.text), clip(text));
        context.report(&codes::UNKNOWN_WORD, span, message, |d| {
            let d = d
                .at(span, "unknown")
                .hint(format!("it is one of {}", list(words())));
            match meant {
                Some((meant, better)) => d.guess(format!("did you mean `{meant}`?"), span, better),
                None => d,
            }
        });
    }
    meaning.map(|(_, meaning)| *meaning)
}

/// The schema of [`word`]: an editor offers the words, and any case of letters is taken.
pub(super) fn word_schema<T>(table: &[(&'static str, T)]) -> Json {
    let any_case = |letter: char| match letter.is_ascii_alphabetic() {
        true => format!("[{}{}]", letter.to_ascii_uppercase(), letter),
        false => letter.to_string(),
    };
    let words: Vec<_> = table.iter().map(|(word, _)| *word).collect();
    let pattern: Vec<String> = words
        .iter()
        .map(|word| word.chars().map(any_case).collect())
        .collect();
    json!({ "anyOf": [{ "enum": words }, { "type": "string", "pattern": format!("^({})$", pattern.join("|")) }] })
}
