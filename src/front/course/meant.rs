//! What was meant by a value of the wrong type: colours as the web writes them, units, fractions,
//! decimal commas, round brackets, missing dashes.

use rtc_math::shortest;
use rtc_source::Span;
use rtc_source::tree::{NodeContent, NodeId, Tree};

/// A hint, and the text to put in place of the value of a key, if that is known; `what` are the words
/// for what the value must be.
pub(super) fn of(
    tree: &Tree<'_>,
    key: Option<Span>,
    node: NodeId,
    what: &str,
) -> Option<(String, Option<String>)> {
    let takes_triple = what.contains("list of three numbers");
    let takes_pair = what.contains("list of two whole numbers");
    let takes_number = !takes_triple && !takes_pair && what.contains("number");
    match tree.shape(node) {
        NodeContent::Map if what == "a list" => {
            let hint = "each item of a list begins with a dash: `- type: sphere`";
            Some((hint.to_owned(), None))
        }
        NodeContent::Word("") if what == "a list" => {
            Some(("an empty list is written `[]`".to_owned(), None))
        }
        NodeContent::Word("") => {
            let rest = tree.rest_of_line(key?).trim_start_matches(':').trim();
            let comment = rest.starts_with('#').then_some(rest)?;
            let hint = "`#` starts a comment".to_owned();
            Some(match color(comment).filter(|_| takes_triple) {
                Some(color) => (format!("{hint}; as numbers the colour is `{color}`"), None),
                None => (format!("{hint}; put text in quotes"), None),
            })
        }
        NodeContent::Word(text) | NodeContent::Text(text) if takes_triple => {
            let hint = "a list stands in square brackets, with commas: `[1, 2, 3]`".to_owned();
            if let Some(list) = listed(text, 3) {
                return Some((hint, Some(list)));
            }
            if text.starts_with('(') {
                return Some((hint, None));
            }
            let color = color(text)?;
            Some(("a colour is three numbers".to_owned(), Some(color)))
        }
        NodeContent::Word(text) | NodeContent::Text(text) if takes_pair => {
            let list = listed(text, 2)?;
            Some((
                "two numbers stand in square brackets".to_owned(),
                Some(list),
            ))
        }
        NodeContent::Word(text) | NodeContent::Text(text) if takes_number => number(text),
        NodeContent::Word(_) | NodeContent::Text(_) | NodeContent::List | NodeContent::Map => None,
    }
}

/// So many numbers with anything but commas and square brackets about them, as a list.
pub(super) fn listed(text: &str, count: usize) -> Option<String> {
    let is_between = |c: char| c.is_whitespace() || ",;()[]{}x×".contains(c);
    let parts: Vec<_> = text
        .split(is_between)
        .filter(|part| !part.is_empty())
        .take(count + 1)
        .collect();
    let are_numbers = parts
        .iter()
        .all(|part| part.parse::<f64>().is_ok_and(f64::is_finite));
    (parts.len() == count && are_numbers).then(|| format!("[{}]", parts.join(", ")))
}

/// The colours that people write by their names.
const NAMED: &[(&str, &str)] = &[
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

/// A name, `#rrggbb` or `#rgb` as three numbers from 0 to 1.
fn color(text: &str) -> Option<String> {
    let named = NAMED
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
    let part = |value: u32| shortest((f64::from(value) / 255.0 * 1e3).round() / 1e3);
    Some(format!("[{}, {}, {}]", part(r), part(g), part(b)))
}

/// A number with a decimal comma, a unit, an end as in a program, or as a fraction.
fn number(text: &str) -> Option<(String, Option<String>)> {
    let read = |part: &str| {
        part.trim()
            .parse::<f64>()
            .ok()
            .filter(|number| number.is_finite())
    };
    if let Some((before, comment)) = text.split_once("//") {
        read(before)?;
        let text = format!("{} #{comment}", before.trim());
        return Some(("`#` starts a comment".to_owned(), Some(text)));
    }
    if let Some(before) = text.strip_suffix([';', ',']) {
        read(before)?;
        return Some((
            "nothing follows a value".to_owned(),
            Some(before.trim().to_owned()),
        ));
    }
    if let Some((whole, decimals)) = text.split_once(',') {
        let is_decimal = !decimals.is_empty() && decimals.bytes().all(|byte| byte.is_ascii_digit());
        let point = format!("{whole}.{decimals}");
        read(&point).filter(|_| is_decimal)?;
        return Some(("decimals stand behind a point".to_owned(), Some(point)));
    }
    if let Some((above, below)) = text.split_once('/') {
        let quotient = read(above)? / read(below)?;
        let quotient = quotient.is_finite().then(|| shortest(quotient))?;
        return Some(("a number is written out".to_owned(), Some(quotient)));
    }
    let number = text.trim_end_matches(|c: char| c.is_alphabetic() || matches!(c, '°' | '%' | ' '));
    read(number).filter(|_| number.len() < text.len())?;
    Some(("a number has no unit".to_owned(), Some(number.to_owned())))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_and_colours_are_read_as_people_write_them() {
        let meant = |text: &str| number(text).and_then(|(_, meant)| meant);
        for (text, expected) in [
            ("0,2", Some("0.2")),
            ("-1,25", Some("-1.25")),
            ("50cm", Some("50")),
            ("45°", Some("45")),
            ("100/2", Some("50")),
            ("1/0", None),
            ("1,2,3", None),
            ("much", None),
            ("12", None),
            ("nan", None),
            ("3;", Some("3")),
            ("3 // the radius", Some("3 # the radius")),
        ] {
            assert_eq!(meant(text).as_deref(), expected, "{text}");
        }
        assert_eq!(color("#1e90ff").as_deref(), Some("[0.118, 0.565, 1]"));
        assert_eq!(color("#f00").as_deref(), Some("[1, 0, 0]"));
        assert_eq!(color("#1e90f"), None);
        assert_eq!(color("Red").as_deref(), Some("[1, 0, 0]"));
        assert_eq!(
            listed("(90, 320, 100)", 3).as_deref(),
            Some("[90, 320, 100]")
        );
        assert_eq!(listed("40x30", 2).as_deref(), Some("[40, 30]"));
        assert_eq!((listed("1 0", 3), listed("1 0 up", 3)), (None, None));
    }
}
