//! Turns the syntax errors of the YAML parser into diagnostics.

use rtc_diag::{Code, Diagnostic, Severity, clip, codes};
use rtc_source::Span;
use rtc_source::tree::yaml::{MAX_DEPTH, MissingSeparator, YamlError};

/// The diagnostic for a syntax error.
pub(super) fn diagnostic(mistake: YamlError<'_>) -> Diagnostic {
    // Each kind of syntax error has its code and its hint.
    match mistake {
        YamlError::Utf16 { span } => utf16(span),
        YamlError::NotUtf8 { byte, span } => not_utf8(byte, span),
        YamlError::Control { character, span } => control(character, span),
        YamlError::TooLong { span } => {
            let message = "a scalar is longer than 1 MiB";
            at_span(&codes::TOO_LONG, message, span, "starts here").hint("is this a scene file?")
        }
        YamlError::Empty { span } => empty(span),
        YamlError::TwoDocuments { span } => {
            let message = "a second document starts in this file";
            at_span(&codes::TWO_DOCUMENTS, message, span, "the second document")
                .hint("keep one scene per file, or remove the `---`")
        }
        YamlError::Tag { span } => {
            let message = "a tag has no meaning in a scene";
            at_span(&codes::TAG, message, span, "read as if it had no tag")
        }
        YamlError::SelfAlias { span, anchor } => {
            let message = "an alias refers to a node that contains it";
            at_span(&codes::SELF_ALIAS, message, span, "expands without end")
                .also(anchor, "the anchor of that node")
        }
        YamlError::TooDeep { span } => {
            let message = format!("lists and maps are nested more than {MAX_DEPTH} deep");
            at_span(&codes::NESTED_TOO_DEEP, message, span, "too deep here")
                .hint("a scene needs at most 6 levels")
        }
        YamlError::Unclosed {
            bracket,
            runs_into,
            comment,
        } => unclosed(bracket, runs_into, comment),
        YamlError::DuplicateKey {
            key,
            first,
            second,
            is_same,
            separator,
        } => match separator {
            Some(separator) => new_item(key, first, second, separator),
            None => duplicate_key(key, first, second, is_same),
        },
        YamlError::Syntax {
            message,
            label,
            hint,
            replacement,
            span,
            bracket,
        } => {
            let diagnostic = at_span(&codes::SYNTAX, message, span, &label)
                .also(bracket, "inside what this bracket opens");
            with_hint(diagnostic, hint, replacement)
        }
    }
}

fn with_hint(
    diagnostic: Diagnostic,
    hint: &'static str,
    replacement: Option<Box<(Span, String)>>,
) -> Diagnostic {
    match replacement {
        Some(replacement) => diagnostic.replace(hint, replacement.0, replacement.1),
        None => diagnostic.hint(hint),
    }
}

fn control(character: u32, span: Span) -> Diagnostic {
    let message = format!("control character U+{character:04X}");
    at_span(
        &codes::CONTROL_CHARACTER,
        message,
        span,
        "not allowed in YAML",
    )
    .replace("remove it", span, "")
}

/// The diagnostic for an empty file.
fn empty(span: Span) -> Diagnostic {
    let message = "the file contains no scene";
    at_span(&codes::EMPTY_FILE, message, span, "the end of the file")
        .hint("a scene has at least a `Camera`, `Lights` and `Objects`")
}

fn at_span(code: &'static Code, message: impl Into<String>, span: Span, label: &str) -> Diagnostic {
    Diagnostic::new(code, message).at(span, label)
}

fn utf16(span: Span) -> Diagnostic {
    let message = "the file is UTF-16, not UTF-8";
    at_span(
        &codes::NOT_UTF8,
        message,
        span,
        "two bytes a character from here on",
    )
    .hint("save it as UTF-8, or convert it with `iconv -f UTF-16 -t UTF-8`")
}

fn not_utf8(byte: u8, span: Span) -> Diagnostic {
    let message = format!(
        "the file is not UTF-8: byte 0x{byte:02x} at offset {}",
        span.start
    );
    let hint = "save it as UTF-8; if it is Latin-1, convert it with `iconv -f LATIN1 -t UTF-8`";
    at_span(&codes::NOT_UTF8, message, span, "not UTF-8").hint(hint)
}

/// The diagnostic for a key that repeats because the separator between two list items is missing.
fn new_item(key: &str, first: Span, second: Span, separator: MissingSeparator) -> Diagnostic {
    let what = match separator {
        MissingSeparator::Dash(_) => "a dash is missing before the second",
        MissingSeparator::Braces => "`}, {` is missing before the second",
        MissingSeparator::FirstKey => "the beginning of an item is missing before the second",
    };
    let message = format!("the key `{}` occurs twice: {what}", clip(key));
    let diagnostic = at_span(
        &codes::DUPLICATE_KEY,
        message,
        second,
        "the next item begins here",
    )
    .also(first, "the item before it");
    match separator {
        MissingSeparator::Dash(blanks) => {
            diagnostic.guess("each item of a list begins with a dash", blanks, "- ")
        }
        MissingSeparator::Braces => diagnostic.hint("each item of a list has its own braces"),
        MissingSeparator::FirstKey => diagnostic.hint(
            "other keys occur twice, too: write the first line of the next object before it, as \
             `- type: sphere`; in JSON `}, {` and its type",
        ),
    }
}

fn duplicate_key(key: &str, first: Span, second: Span, is_same: bool) -> Diagnostic {
    let key = clip(key);
    let message = match is_same {
        true => format!("the key `{key}` occurs twice, with the same value"),
        false => format!("the key `{key}` occurs twice"),
    };
    let diagnostic = at_span(&codes::DUPLICATE_KEY, message, second, "again")
        .also(first, "first")
        .hint("remove one of them; of two lists, move the items of one below those of the other");
    match is_same {
        true => diagnostic.severity(Severity::Warning),
        false => diagnostic,
    }
}

fn unclosed(bracket: Span, runs_into: Option<Span>, comment: Option<Span>) -> Diagnostic {
    at_span(
        &codes::UNCLOSED,
        "a bracket is never closed",
        bracket,
        "opened here",
    )
    .also(runs_into, "parsed as inside the bracket")
    .also(comment, "`#` starts a comment, up to the end of the line")
    .hint("close it with `]` or `}` after its last item")
}
