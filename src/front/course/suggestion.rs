//! Suggestions for values of the wrong type: named and hexadecimal colours, units, fractions,
//! decimal commas, round brackets, missing dashes.

use super::decode::ValueKey;
use super::expression;
use rtc_math::shortest;
use rtc_source::tree::{NodeContent, NodeId, SyntaxTree};

/// A hint for a value of the wrong type, and the replacement if it is known. `what` describes the
/// expected value.
pub(super) fn suggest(
    tree: &SyntaxTree<'_>,
    key: ValueKey<'_>,
    node: NodeId,
    what: &str,
) -> Option<(String, Option<String>)> {
    // Find the type that the key expects.
    let takes_triple = what.contains("list of three numbers");
    let takes_pair = what.contains("list of two whole numbers");
    let takes_number = !takes_triple && !takes_pair && what.contains("number");
    // Suggest how the value is written in that type.
    match tree.shape(node) {
        NodeContent::Map if what == "a list" => {
            let hint = "each item of a list begins with a dash: `- type: sphere`";
            Some((hint.to_owned(), None))
        }
        NodeContent::List if what == "a map" => {
            let hint = match tree.written(node).starts_with('[') {
                true => "a map is written in braces: `{key: value}`",
                false => "a map has a key before each value, and no dashes",
            };
            Some((hint.to_owned(), None))
        }
        NodeContent::Word(text) | NodeContent::Text(text)
            if what == "a map" && key.text == "material" && is_name(text) =>
        {
            Some((material_by_name(text), None))
        }
        NodeContent::Word("") if what == "a list" => {
            Some(("an empty list is written `[]`".to_owned(), None))
        }
        NodeContent::Word("") => {
            let line = tree.rest_of_line(key.span?).trim_start_matches(':').trim();
            let comment = line.starts_with('#').then_some(line)?;
            let hint = "`#` starts a comment".to_owned();
            Some(match color(comment).filter(|_| takes_triple) {
                Some(color) => (format!("{hint}; as numbers the colour is `{color}`"), None),
                None => (format!("{hint}; put text in quotes"), None),
            })
        }
        NodeContent::Word(text) | NodeContent::Text(text) if takes_triple => {
            let hint = "a list is written in square brackets, with commas: `[1, 2, 3]`".to_owned();
            if let Some(list) = as_list(text, 3) {
                return Some((hint, Some(list)));
            }
            if text.starts_with('(') {
                return Some((hint, None));
            }
            let color = color(text)?;
            Some(("a colour is three numbers".to_owned(), Some(color)))
        }
        NodeContent::Word(text) | NodeContent::Text(text) if takes_pair => {
            let list = as_list(text, 2)?;
            Some((
                "two numbers are written in square brackets".to_owned(),
                Some(list),
            ))
        }
        NodeContent::Word(text) | NodeContent::Text(text) if takes_number => number(text),
        NodeContent::Word(_) | NodeContent::Text(_) | NodeContent::List | NodeContent::Map => None,
    }
}

/// `count` numbers with any separators between them, as a YAML list.
pub(super) fn as_list(text: &str, count: usize) -> Option<String> {
    let is_between = |c: char| c.is_whitespace() || ",;()[]{}x×".contains(c);
    let items: Vec<_> = text
        .split(is_between)
        .filter(|item| !item.is_empty())
        .take(count + 1)
        .collect();
    let are_numbers = items
        .iter()
        .all(|item| item.parse::<f64>().is_ok_and(f64::is_finite));
    (items.len() == count && are_numbers).then(|| format!("[{}]", items.join(", ")))
}

/// Colour names.
const NAMED_COLORS: &[(&str, &str)] = &[
    ("black", "[0, 0, 0]"),
    ("white", "[1, 1, 1]"),
    ("red", "[1, 0, 0]"),
    ("green", "[0, 1, 0]"),
    ("blue", "[0, 0, 1]"),
    ("yellow", "[1, 1, 0]"),
    ("cyan", "[0, 1, 1]"),
    ("magenta", "[1, 0, 1]"),
    ("orange", "[1, 0.5, 0]"),
    ("gray", "[0.5, 0.5, 0.5]"),
    ("grey", "[0.5, 0.5, 0.5]"),
];

/// A colour name, `#rrggbb` or `#rgb`, as three numbers from 0 to 1.
fn color(text: &str) -> Option<String> {
    let named = NAMED_COLORS
        .iter()
        .find(|(name, _)| name.eq_ignore_ascii_case(text));
    if let Some((_, color)) = named {
        return Some((*color).to_owned());
    }
    let digits = text.strip_prefix('#')?;
    let digits: Vec<u32> = digits
        .chars()
        .take(7)
        .map(|digit| digit.to_digit(16))
        .collect::<Option<_>>()?;
    let [r, g, b] = match digits[..] {
        [r, g, b] => [r, g, b].map(|digit| 17 * digit),
        [r, s, g, h, b, c] => [16 * r + s, 16 * g + h, 16 * b + c],
        _ => return None,
    };
    let item = |value: u32| shortest((f64::from(value) / 255.0 * 1e3).round() / 1e3);
    Some(format!("[{}, {}, {}]", item(r), item(g), item(b)))
}

/// The hint for a material that is given by a name instead of a map.
fn material_by_name(name: &str) -> String {
    let advice = "a material is a map; mark a shared one";
    match color(name) {
        Some(color) => format!("a material is a map, with `color: {color}` among its keys"),
        None => format!("{advice} `&{name}` and refer to it by `*{name}`"),
    }
}

fn is_name(text: &str) -> bool {
    let is_letter = |c: char| c.is_alphanumeric() || matches!(c, '_' | '-');
    !text.is_empty() && text.len() <= 32 && text.chars().all(is_letter)
}

/// `count` numbers, some with a decimal comma, as a YAML list. If the list has a comma followed by
/// a space, only these commas separate numbers; otherwise every second comma does.
pub(super) fn decimal_commas(text: &str, count: usize) -> Option<String> {
    const MAX_LENGTH: usize = 256;
    let inside = text.strip_prefix('[')?.strip_suffix(']')?.trim();
    if inside.len() > MAX_LENGTH || inside.contains(['#', '\n']) {
        return None;
    }
    let items: Vec<&str> = match inside.contains(", ") {
        true => inside.split(", ").map(str::trim).collect(),
        false => {
            let commas = inside.match_indices(',').skip(1).step_by(2);
            let mut from = 0;
            let ends = commas.map(|(at, _)| at).chain([inside.len()]);
            ends.map(|end| inside.get(std::mem::replace(&mut from, end + 1)..end))
                .collect::<Option<_>>()?
        }
    };
    let point = |item: &&str| {
        let number = item.replacen(',', ".", 1);
        number
            .parse::<f64>()
            .is_ok_and(f64::is_finite)
            .then_some(number)
    };
    let numbers: Vec<String> = items.iter().map(point).collect::<Option<_>>()?;
    (numbers.len() == count).then(|| format!("[{}]", numbers.join(", ")))
}

/// The number in a text that has a decimal comma, a unit, a trailing `;` or `,`, a `//` comment,
/// non-ASCII digits or signs, or an expression.
fn number(text: &str) -> Option<(String, Option<String>)> {
    let read = |item: &str| {
        item.trim()
            .parse::<f64>()
            .ok()
            .filter(|number| number.is_finite())
    };
    // Look-alike characters.
    let ascii = to_ascii(text);
    if ascii != text && read(&ascii).is_some() {
        let other = text.chars().find(|c| !c.is_ascii())?;
        let hint = format!(
            "`{other}` is U+{:04X}, which only looks like a character of numbers",
            u32::from(other)
        );
        return Some((hint, Some(ascii)));
    }
    // A comment of another language.
    if let Some((before, comment)) = text.split_once("//") {
        read(before)?;
        let text = format!("{} #{comment}", before.trim());
        return Some(("`#` starts a comment".to_owned(), Some(text)));
    }
    // Trailing punctuation.
    if let Some(before) = text.strip_suffix([';', ',']) {
        read(before)?;
        return Some((
            "a value ends here".to_owned(),
            Some(before.trim().to_owned()),
        ));
    }
    // A decimal comma.
    if let Some((integer, decimals)) = text.split_once(',') {
        let is_decimal = !decimals.is_empty() && decimals.bytes().all(|byte| byte.is_ascii_digit());
        let point = format!("{integer}.{decimals}");
        read(&point).filter(|_| is_decimal)?;
        return Some(("decimals follow a point".to_owned(), Some(point)));
    }
    // An expression.
    if let Some(result) = expression::evaluate(&ascii) {
        let hint = "expressions are not evaluated: write the result".to_owned();
        return Some((hint, Some(shortest(result))));
    }
    let number =
        ascii.trim_end_matches(|c: char| c.is_alphabetic() || matches!(c, '°' | '%' | ' '));
    read(number).filter(|_| number.len() < ascii.len())?;
    Some(("a number has no unit".to_owned(), Some(number.to_owned())))
}

/// The text with look-alike characters replaced by ASCII: minus signs and dashes, full-width forms,
/// and spaces.
fn to_ascii(text: &str) -> String {
    let ascii = |c: char| match c {
        '\u{2010}'..='\u{2015}' | '\u{2212}' | '\u{fe58}' | '\u{fe63}' | '\u{207b}' => Some('-'),
        '\u{ff01}'..='\u{ff5e}' => char::from_u32(u32::from(c) - 0xfee0),
        '\u{200b}'..='\u{200d}' | '\u{feff}' | '\u{2060}' => None,
        c if c.is_whitespace() => Some(' '),
        c => Some(c),
    };
    let ascii: String = text.chars().filter_map(ascii).collect();
    ascii.trim().to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_and_colours_are_read_as_people_write_them() {
        let suggested = |text: &str| number(text).and_then(|(_, suggested)| suggested);
        for (text, expected) in [
            ("0,2", Some("0.2")),
            ("-1,25", Some("-1.25")),
            ("50cm", Some("50")),
            ("45°", Some("45")),
            ("100/2", Some("50")),
            ("1/0", None),
            ("1/3", Some("0.3333333333333333")),
            ("2*0.6", Some("1.2")),
            ("-(1 + 2) / 4", Some("-0.75")),
            ("\u{2212}0.5", Some("-0.5")),
            ("\u{2013} 2", Some("-2")),
            ("\u{ff10}\u{ff0e}\u{ff15}", Some("0.5")),
            ("1,2,3", None),
            ("much", None),
            ("12", None),
            ("nan", None),
            ("3;", Some("3")),
            ("3 // the radius", Some("3 # the radius")),
        ] {
            assert_eq!(suggested(text).as_deref(), expected, "{text}");
        }
        assert_eq!(color("#1e90ff").as_deref(), Some("[0.118, 0.565, 1]"));
        assert_eq!(color("#f00").as_deref(), Some("[1, 0, 0]"));
        assert_eq!(color("#1e90f"), None);
        assert_eq!(color("Red").as_deref(), Some("[1, 0, 0]"));
        assert_eq!(
            as_list("(90, 320, 100)", 3).as_deref(),
            Some("[90, 320, 100]")
        );
        assert_eq!(as_list("40x30", 2).as_deref(), Some("[40, 30]"));
        assert_eq!((as_list("1 0", 3), as_list("1 0 up", 3)), (None, None));
        let list = Some("[0.5, 0.6, 1]".to_owned());
        assert_eq!(decimal_commas("[0,5, 0,6, 1]", 3), list);
        assert_eq!(
            decimal_commas("[0,5,0,6,1,0]", 3).as_deref(),
            Some("[0.5, 0.6, 1.0]")
        );
        for other in [
            "[1, 2, 3, 4]",
            "[1,2,3,4]",
            "[0,5, 0,6, 1, 2]",
            "[0,5, a, 1]",
        ] {
            assert_eq!(decimal_commas(other, 3), None, "{other}");
        }
    }
}
