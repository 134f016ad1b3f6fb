//! Suggestions for values of the wrong type: named and hexadecimal colours, units, percentages,
//! fractions, decimal commas, round brackets, maps of channels, missing dashes.

use super::decode::ValueKey;
use super::spelling::same_letters;
use rtc_math::shortest;
use rtc_source::tree::{NodeContent, NodeId, SyntaxTree};

/// A hint for a value of the wrong type.
pub(super) struct Suggestion {
    pub(super) hint: String,
    /// What to write instead, if that is known.
    pub(super) text: Option<String>,
    /// Whether the text surely has the meaning of what is written.
    pub(super) is_certain: bool,
}

/// A hint for a value of the wrong type, and the replacement if it is known. `what` describes the
/// expected value.
pub(super) fn suggest(
    tree: &SyntaxTree<'_>,
    key: ValueKey<'_>,
    node: NodeId,
    what: &str,
) -> Option<Suggestion> {
    let (hint, text) = suggest_text(tree, key, node, what)?;
    let written = tree.written(node);
    let is_certain = |text: &str| same_letters(written, text) && !has_other_meaning(written);
    Some(Suggestion {
        is_certain: text.as_deref().is_some_and(is_certain),
        hint,
        text,
    })
}

/// Whether a number is written so that its digits alone do not say its value: with a unit, or with
/// a comma that may be one of thousands.
fn has_other_meaning(written: &str) -> bool {
    let decimals = written.split_once(',').map(|(_, decimals)| decimals.len());
    written.contains(['%', '°']) || decimals == Some(3)
}

fn suggest_text(
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
            let hint = match tree.written(node).starts_with('{') {
                true => "a list is written in square brackets, each item in braces: `[{…}, {…}]`",
                false => "each item of a list begins with a dash: `- type: sphere`",
            };
            Some((hint.to_owned(), None))
        }
        NodeContent::Map if takes_triple => {
            let hint = "three numbers are written as a list: `[1, 2, 3]`";
            Some((hint.to_owned(), Some(list_of_map(tree, node)?)))
        }
        NodeContent::Map if takes_number => {
            let hint = "a number stands after the colon, and no other key";
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
            if let Some(axis) = axis(text) {
                return Some((hint, Some(axis)));
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
        NodeContent::Word(text) | NodeContent::Text(text) if what.starts_with("a whole number") => {
            square(text).or_else(|| number(text))
        }
        NodeContent::Word(text) | NodeContent::Text(text) if takes_number => number(text),
        NodeContent::Word(_) | NodeContent::Text(_) | NodeContent::List | NodeContent::Map => None,
    }
}

/// The keys of three numbers in other programs, each row in order.
const CHANNELS: [[&str; 3]; 3] = [["r", "g", "b"], ["red", "green", "blue"], ["x", "y", "z"]];

/// The list of the three numbers in a map of channels or components.
fn list_of_map(tree: &SyntaxTree<'_>, node: NodeId) -> Option<String> {
    let value = |key: &str| {
        let mut pairs = tree.pairs(node).take(CHANNELS.len() + 1);
        let is_it = |name: NodeId| {
            tree.text(name)
                .is_some_and(|name| name.eq_ignore_ascii_case(key))
        };
        let (_, value) = pairs.find(|(name, _)| is_it(*name))?;
        let text = tree.text(value)?;
        text.parse::<f64>()
            .is_ok_and(f64::is_finite)
            .then(|| text.to_owned())
    };
    let rows = CHANNELS.iter();
    let mut lists = rows.filter_map(|row| row.iter().map(|key| value(key)).collect());
    lists
        .next()
        .map(|numbers: Vec<_>| format!("[{}]", numbers.join(", ")))
}

/// The direction that the name of an axis says, perhaps with a sign.
fn axis(text: &str) -> Option<String> {
    let name = text.trim_start_matches(['+', '-']);
    let sign = if text.starts_with('-') { "-" } else { "" };
    let at = ["x", "y", "z"]
        .iter()
        .position(|axis| axis.eq_ignore_ascii_case(name))?;
    let component = |k: usize| {
        if k == at {
            format!("{sign}1")
        } else {
            "0".to_owned()
        }
    };
    Some(format!("[{}]", [0, 1, 2].map(component).join(", ")))
}

/// The side of a square that is written as `4x4`.
fn square(text: &str) -> Option<(String, Option<String>)> {
    let (columns, rows) = text.split_once(['x', 'X', '×', '*'])?;
    let (columns, rows): (u32, u32) = (columns.trim().parse().ok()?, rows.trim().parse().ok()?);
    (columns == rows).then(|| {
        let hint = "one number counts them along each side".to_owned();
        (hint, Some(columns.to_string()))
    })
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

/// A colour name, `#rrggbb`, `#rgb` or `rgb(r, g, b)`, as three numbers from 0 to 1.
fn color(text: &str) -> Option<String> {
    if let Some(list) = color_function(text) {
        return Some(list);
    }
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
    Some(list_of_bytes([r, g, b].map(f64::from)))
}

/// The colour that `rgb(…)` names: bytes, or percentages.
fn color_function(text: &str) -> Option<String> {
    let lower = text.trim().to_ascii_lowercase();
    let inside = lower.strip_prefix("rgb")?.trim_start().strip_prefix('(')?;
    let inside = inside.strip_suffix(')')?;
    let channel = |item: &str| match item.trim().strip_suffix('%') {
        Some(percent) => percent.parse().ok().map(|percent: f64| percent * 2.55),
        None => item.trim().parse().ok(),
    };
    let channels: Vec<f64> = inside
        .split(',')
        .take(4)
        .map(channel)
        .collect::<Option<_>>()?;
    let channels: [f64; 3] = channels.try_into().ok()?;
    let are_bytes = channels
        .iter()
        .all(|channel| (0.0..=255.0).contains(channel));
    are_bytes.then(|| list_of_bytes(channels))
}

/// Bytes from 0 to 255 as a list of numbers from 0 to 1.
fn list_of_bytes(bytes: [f64; 3]) -> String {
    let [r, g, b] = bytes.map(|value| shortest((value / 255.0 * 1e3).round() / 1e3));
    format!("[{r}, {g}, {b}]")
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
/// or non-ASCII digits or signs.
fn number(text: &str) -> Option<(String, Option<String>)> {
    let read = |item: &str| {
        item.trim()
            .parse::<f64>()
            .ok()
            .filter(|number| number.is_finite())
    };
    // Look-alike characters.
    let mut ascii = to_ascii(text);
    if let Some(unsigned) = ascii.strip_prefix('-') {
        ascii = format!("-{}", unsigned.trim_start());
    }
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
    // A percentage.
    if let Some(percent) = ascii.strip_suffix('%') {
        let fraction = shortest(read(percent)? / 100.0);
        let hint = format!("a percentage is written as a fraction of 1: {ascii} is {fraction}");
        return Some((hint, Some(fraction)));
    }
    let number = ascii.trim_end_matches(|c: char| c.is_alphabetic() || matches!(c, '°' | ' '));
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
            ("20%", Some("0.2")),
            ("2.5 %", Some("0.025")),
            ("45°", Some("45")),
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
        assert_eq!(color("rgb(255, 0, 51)").as_deref(), Some("[1, 0, 0.2]"));
        assert_eq!(color("rgb(100%, 0%, 20%)").as_deref(), Some("[1, 0, 0.2]"));
        assert_eq!((color("rgb(300, 0, 0)"), color("rgb(1, 2)")), (None, None));
        assert_eq!(axis("-y").as_deref(), Some("[0, -1, 0]"));
        assert_eq!(
            square("4x4").and_then(|(_, text)| text).as_deref(),
            Some("4")
        );
        assert_eq!(square("4x3"), None);
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
