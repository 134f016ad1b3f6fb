//! Detects characters that look like YAML indicators, and comments in the syntax of other
//! languages: word processors, web pages and JSON with comments contain them.

use super::super::SyntaxTree;
use super::YamlError;
use super::typo::{span, typo};

/// The name of a character that looks like an ASCII character, and that character.
fn ascii_lookalike(c: char) -> Option<(&'static str, &'static str)> {
    Some(match c {
        '\u{a0}' | '\u{202f}' | '\u{2007}' => ("a no-break space", " "),
        '\u{3000}' => ("an ideographic space", " "),
        '\u{200b}'..='\u{200d}' | '\u{2060}' | '\u{feff}' => ("a space of no width", ""),
        '\u{2028}' | '\u{2029}' | '\u{85}' => ("a line end of Unicode", " "),
        c if c.is_whitespace() && !c.is_ascii() => ("a space of Unicode", " "),
        '\u{2010}'..='\u{2015}' | '\u{2212}' => ("a dash of Unicode", "-"),
        '\u{201c}'..='\u{201f}' | '\u{ab}' | '\u{bb}' => ("a typographic quote", "\""),
        '\u{2018}'..='\u{201b}' => ("a typographic quote", "'"),
        '\u{ff1a}' => ("a wide colon", ":"),
        '\u{ff0c}' | '\u{3001}' => ("a wide comma", ","),
        '\u{ff3b}' | '\u{3010}' => ("a wide bracket", "["),
        '\u{ff3d}' | '\u{3011}' => ("a wide bracket", "]"),
        '\u{ff5b}' => ("a wide brace", "{"),
        '\u{ff5d}' => ("a wide brace", "}"),
        _ => return None,
    })
}

/// An error in an unquoted scalar that has such a character where only a YAML indicator makes
/// sense.
pub(super) fn in_word(
    tree: &SyntaxTree<'_>,
    start: usize,
    end: usize,
) -> Option<YamlError<'static>> {
    let word = tree.source.get(start..end)?;
    if word.is_ascii() {
        return comment(tree, start, word).filter(|_| word.contains('\n') || word.contains('"'));
    }
    let after = tree.source.get(end..)?.trim_start_matches(' ');
    let (is_key, is_prose) = (after.starts_with(':'), word.split(' ').count() > PROSE);
    // Any text may contain quotes and dashes, and prose any character.
    found(tree, start, word, |ascii| match ascii {
        " " | "" => is_key || !is_prose,
        "-" | "'" | "\"" => is_key,
        _ => false,
    })
}

/// Texts of more words are prose.
const PROSE: usize = 2;

/// The same for the line of a syntax error, or the line before it.
pub(super) fn near(tree: &SyntaxTree<'_>, at: usize) -> Option<YamlError<'static>> {
    let (first, lines) = lines_around(tree, at)?;
    if lines.is_ascii() {
        return None;
    }
    found(tree, first, lines, |_| true)
}

/// A comment in the syntax of another language, in the line of a syntax error or the line before
/// it.
pub(super) fn comment_near(tree: &SyntaxTree<'_>, at: usize) -> Option<YamlError<'static>> {
    let (mut from, lines) = lines_around(tree, at)?;
    for line in lines.split_inclusive('\n') {
        let mut is_quoted = false;
        let mut last = ' ';
        for (offset, c) in line.char_indices() {
            is_quoted ^= c == '"';
            let starts = last.is_whitespace() || matches!(last, ',' | '{' | '[' | '}' | ']');
            if !is_quoted && starts && c == '#' {
                break;
            }
            if let (false, true, Some(rest)) = (is_quoted, starts, line.get(offset..))
                && let Some(mistake) = comment(tree, from + offset, rest)
            {
                return Some(mistake);
            }
            last = c;
        }
        from += line.len();
    }
    None
}

/// The line of an offset and the line before it, with their start.
fn lines_around<'s>(tree: &SyntaxTree<'s>, at: usize) -> Option<(usize, &'s str)> {
    let line = |before: usize| {
        let text = tree.source.get(..before).unwrap_or_default();
        text.rfind('\n').map_or(0, |end| end + 1)
    };
    let found_text = line(at);
    let first = line(found_text.saturating_sub(1));
    let rest = tree.source.get(found_text..)?;
    let end = found_text + rest.find('\n').unwrap_or(rest.len());
    Some((first, tree.source.get(first..end)?))
}

/// The first character of a text that stands where only a YAML indicator makes sense: next to an
/// indicator, or at an end of the text or of a line.
fn found(
    tree: &SyntaxTree<'_>,
    start: usize,
    text: &str,
    matters: impl Fn(&str) -> bool,
) -> Option<YamlError<'static>> {
    let is_indicator = |c: Option<char>| {
        c.is_none_or(|c| matches!(c, ':' | ',' | '[' | ']' | '{' | '}' | '\n' | '\r'))
    };
    let mut before = None;
    for (offset, c) in text.char_indices() {
        let next = offset + c.len_utf8();
        let ascii = ascii_lookalike(c);
        if let Some((name, ascii)) = ascii {
            let after = text.get(next..)?.trim_start_matches(' ').chars().next();
            let is_dash = ascii == "-";
            // A minus sign before digits belongs to a number, which reports it; a dash begins an
            // item.
            let counts = match is_dash {
                true => is_indicator(before) && text.get(next..)?.starts_with(' '),
                false => {
                    is_indicator(before)
                        || is_indicator(after)
                        || !matches!(ascii, " " | "" | "'" | "\"")
                }
            };
            if counts && matters(ascii) {
                return Some(lookalike(tree, start + offset, c, name, ascii));
            }
        }
        if c != ' ' && ascii.is_none_or(|(_, ascii)| !matches!(ascii, " " | "")) {
            before = Some(c);
        }
    }
    None
}

fn lookalike(
    tree: &SyntaxTree<'_>,
    at: usize,
    c: char,
    name: &str,
    ascii: &'static str,
) -> YamlError<'static> {
    let span = span(tree, at, at + c.len_utf8());
    let what = match ascii {
        " " | "" => "where YAML takes a space of ASCII",
        _ => "where YAML takes its sign of ASCII",
    };
    typo(
        format!("{name} (U+{:04X}) stands {what}", u32::from(c)),
        name.to_owned(),
        "write",
        span,
        (span, ascii.to_owned()),
    )
}

/// The comment at the start of a text in the syntax of another language.
fn comment(tree: &SyntaxTree<'_>, at: usize, text: &str) -> Option<YamlError<'static>> {
    // The line is inspected only if a comment starts here, so that the time stays linear in the
    // length of the line.
    let opener = ["//", "/*"]
        .into_iter()
        .find(|opener| text.starts_with(opener))?;
    let line = text.split(['\n', '\r']).next()?;
    let end = match opener {
        "/*" => text.find("*/").map_or(line.len(), |end| end + 2),
        _ => line.len(),
    };
    let span = span(tree, at, at + end);
    let comment_text = text.get(2..end)?.trim_end_matches("*/").trim();
    if tree.source.trim_start().starts_with('{') {
        return Some(typo(
            format!("`{opener}` starts a comment in other languages: JSON has none"),
            "not a comment".to_owned(),
            "leave it out, or say it in a key `comment`",
            span,
            (span, String::new()),
        ));
    }
    let has_more_lines = comment_text.contains('\n');
    Some(typo(
        format!("`{opener}` does not start a comment in YAML"),
        "not a comment".to_owned(),
        "a comment begins with `#`",
        span,
        match has_more_lines {
            true => (span, String::new()),
            false => (span, format!("# {comment_text}")),
        },
    ))
}
