//! The parameters of a directive: `"type name" value` or `"type name" [ values ]`.

use super::token::{PbrtToken, PbrtTokenKind, TokenReader};
use crate::exchange::SpannedText;
use rtc_diag::{Diagnostic, clip, codes};
use rtc_source::Span;
use std::cell::RefCell;
use std::collections::BTreeMap;
use std::collections::btree_map::Entry;
use std::rc::Rc;

/// The type of a parameter.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum ParameterType {
    Float,
    Integer,
    Bool,
    String,
    Rgb,
    Xyz,
    Blackbody,
    Spectrum,
    Texture,
    /// Points, vectors and normals of `n` numbers.
    Tuple(usize),
}

impl ParameterType {
    /// The type by its name in version 3 or 4.
    fn parse(name: &str) -> Option<Self> {
        Some(match name {
            "float" => Self::Float,
            "integer" => Self::Integer,
            "bool" => Self::Bool,
            "string" => Self::String,
            "rgb" | "color" => Self::Rgb,
            "xyz" => Self::Xyz,
            "blackbody" => Self::Blackbody,
            "spectrum" => Self::Spectrum,
            "texture" => Self::Texture,
            "point2" | "vector2" => Self::Tuple(2),
            "point" | "point3" | "vector" | "vector3" | "normal" | "normal3" => Self::Tuple(3),
            _ => return None,
        })
    }

    /// Its name in version 4.
    pub(super) fn name(self) -> &'static str {
        match self {
            Self::Float => "float",
            Self::Integer => "integer",
            Self::Bool => "bool",
            Self::String => "string",
            Self::Rgb => "rgb",
            Self::Xyz => "xyz",
            Self::Blackbody => "blackbody",
            Self::Spectrum => "spectrum",
            Self::Texture => "texture",
            Self::Tuple(2) => "point2",
            Self::Tuple(_) => "point3",
        }
    }

    /// Whether this many numbers are a value of the type.
    fn fits(self, count: usize) -> bool {
        match self {
            Self::Rgb | Self::Xyz => count > 0 && count.is_multiple_of(3),
            Self::Blackbody => count > 0,
            Self::Spectrum => count > 0 && count.is_multiple_of(2),
            Self::Tuple(size) => count.is_multiple_of(size),
            _ => true,
        }
    }
}

/// The values of a parameter.
#[derive(Clone, Debug)]
pub(super) enum ParameterValues {
    Numbers(Vec<f64>),
    Strings(Vec<SpannedText>),
    Flags(Vec<bool>),
}

/// A parameter.
#[derive(Clone, Debug)]
pub(super) struct PluginParameter {
    pub(super) name: SpannedText,
    pub(super) kind: ParameterType,
    pub(super) values: ParameterValues,
}

/// Parameters by name, which `Attribute` gives to all plugins of a kind.
pub(super) type DefaultParameters = BTreeMap<String, Rc<PluginParameter>>;

/// The parameters of a directive. They record which ones were read.
#[derive(Clone, Debug, Default)]
pub(super) struct Parameters {
    pub(super) list: Vec<Rc<PluginParameter>>,
    /// What the list lacks.
    pub(super) defaults: Option<Rc<DefaultParameters>>,
    looked_up: RefCell<Vec<&'static str>>,
    /// Those looked up whose values were taken.
    read: RefCell<Vec<&'static str>>,
}

impl Parameters {
    /// A parameter whose value is not taken yet.
    pub(super) fn find(&self, name: &'static str) -> Option<&PluginParameter> {
        note(&self.looked_up, name);
        let mut list = self.list.iter();
        let own = list.find(|parameter| parameter.name.text == name);
        let default = || self.defaults.as_ref()?.get(name);
        own.or_else(default).map(Rc::as_ref)
    }

    /// Notes that the value of a parameter was taken.
    pub(super) fn take(&self, name: &'static str) {
        note(&self.read, name);
    }

    pub(super) fn get(&self, name: &'static str) -> Option<&PluginParameter> {
        self.take(name);
        self.find(name)
    }

    /// What `pick` makes of a parameter, which is taken if that is something.
    fn pick<'p, T>(
        &'p self,
        name: &'static str,
        pick: impl FnOnce(&'p ParameterValues) -> Option<T>,
    ) -> Option<T> {
        let picked = pick(&self.find(name)?.values)?;
        self.take(name);
        Some(picked)
    }

    /// Marks parameters as read whose values have no effect here.
    pub(super) fn skip(&self, names: &[&'static str]) {
        for name in names {
            self.get(name);
        }
    }

    /// The parameters that were not read, and the names that were looked up.
    pub(super) fn unused(&self) -> (Vec<&PluginParameter>, Vec<&'static str>) {
        let read = self.read.borrow();
        let is_unused =
            |parameter: &&Rc<PluginParameter>| !read.contains(&parameter.name.text.as_str());
        let unused = self.list.iter().filter(is_unused).map(Rc::as_ref);
        (unused.collect(), self.looked_up.borrow().clone())
    }

    pub(super) fn numbers(&self, name: &'static str) -> Option<&[f64]> {
        self.pick(name, |values| match values {
            ParameterValues::Numbers(numbers) => Some(numbers.as_slice()),
            _ => None,
        })
    }

    pub(super) fn number(&self, name: &'static str) -> Option<f64> {
        self.numbers(name)?.first().copied()
    }

    /// A count: a number that is rounded, and 0 if it is negative.
    pub(super) fn count(&self, name: &'static str) -> Option<u32> {
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "the cast saturates"
        )]
        self.number(name).map(|number| number.round() as u32)
    }

    pub(super) fn flag(&self, name: &'static str) -> Option<bool> {
        self.pick(name, |values| match values {
            ParameterValues::Flags(flags) => flags.first().copied(),
            _ => None,
        })
    }

    pub(super) fn strings(&self, name: &'static str) -> Option<&[SpannedText]> {
        self.pick(name, |values| match values {
            ParameterValues::Strings(strings) => Some(strings.as_slice()),
            _ => None,
        })
    }

    pub(super) fn string(&self, name: &'static str) -> Option<&SpannedText> {
        self.strings(name)?.first()
    }

    /// The string in lower case, or a default.
    pub(super) fn word(&self, name: &'static str, default: &str) -> String {
        let word = self.string(name).map_or(default, |text| text.text.as_str());
        word.to_ascii_lowercase()
    }

    pub(super) fn vector(&self, name: &'static str) -> Option<[f64; 3]> {
        match *self.numbers(name)? {
            [x, y, z] => Some([x, y, z]),
            _ => None,
        }
    }

    /// Vectors of `N` numbers each, a rest left out.
    pub(super) fn tuples<const N: usize>(&self, name: &'static str) -> Option<&[[f64; N]]> {
        Some(self.numbers(name)?.as_chunks().0)
    }
}

/// Reads the parameters that follow. A mistake is handed to `report`, and its parameter left out.
pub(super) fn read(reader: &mut TokenReader, report: &mut dyn FnMut(Diagnostic)) -> Parameters {
    let mut parameters = Parameters::default();
    let mut given: BTreeMap<String, usize> = BTreeMap::new();
    while let Some(head) = reader.next_if(PbrtTokenKind::Quoted) {
        let parameter = match parameter(reader, head) {
            Ok(parameter) => parameter,
            Err(diagnostic) => {
                report(*diagnostic);
                continue;
            }
        };
        let index = parameters.list.len();
        match given.entry(parameter.name.text.clone()) {
            Entry::Vacant(vacant) => {
                vacant.insert(index);
                parameters.list.push(Rc::new(parameter));
            }
            // The last one counts.
            Entry::Occupied(known) => {
                let earlier = &mut parameters.list[*known.get()];
                let name = clip(&parameter.name.text);
                let message = format!("`{name}` is given twice: the last one counts");
                let diagnostic = Diagnostic::new(&codes::PBRT_DOUBTFUL, message);
                let at = earlier.name.span;
                report(
                    diagnostic
                        .at(parameter.name.span, "")
                        .also(at, "given here first"),
                );
                *earlier = Rc::new(parameter);
            }
        }
    }
    parameters
}

/// Adds a name to a list of few, once.
fn note(names: &RefCell<Vec<&'static str>>, name: &'static str) {
    let mut names = names.borrow_mut();
    if !names.contains(&name) {
        names.push(name);
    }
}

/// Passes the tokens of a value to `take`: one, or those between brackets. Returns their number,
/// and the first one that is rejected or stands instead of the closing bracket. A directive ends
/// the value.
fn each_value(
    reader: &mut TokenReader,
    mut take: impl FnMut(&TokenReader, PbrtToken) -> bool,
) -> (usize, Option<PbrtToken>) {
    let open = reader.next_if(PbrtTokenKind::Open);
    let (mut count, mut refused) = (0, None);
    while let Some(token) = reader.peek() {
        let is_directive = || {
            reader
                .bytes(token)
                .first()
                .is_some_and(u8::is_ascii_uppercase)
        };
        match token.kind {
            PbrtTokenKind::Word if is_directive() => {}
            PbrtTokenKind::Quoted | PbrtTokenKind::Word => {
                count += 1;
                if !take(reader, token) {
                    refused = refused.or(Some(token));
                }
                reader.next();
                match open {
                    Some(_) => continue,
                    None => return (count, refused),
                }
            }
            PbrtTokenKind::Close if open.is_some() => {
                reader.next();
                return (count, refused);
            }
            PbrtTokenKind::Open | PbrtTokenKind::Close | PbrtTokenKind::Unterminated => {}
        }
        // The value is missing, or its list is not closed.
        return (count, refused.or(open.and(Some(token))));
    }
    (count, refused.or(open))
}

/// A parameter of its head, `type name`, and the value that follows.
fn parameter(
    reader: &mut TokenReader,
    head: PbrtToken,
) -> Result<PluginParameter, Box<Diagnostic>> {
    // A parameter has a type and a name in one string.
    let SpannedText { text, span } = reader.text(head);
    let mut words = text.split_ascii_whitespace();
    let (Some(kind), Some(name), None) = (words.next(), words.next(), words.next()) else {
        each_value(reader, |_, _| true);
        let message = format!("`{}` is no type and name of a parameter", clip(&text));
        let label = "a parameter is written \"type name\" and then its value";
        let diagnostic = Diagnostic::new(&codes::PBRT_SYNTAX, message).at(span, label);
        return Err(Box::new(diagnostic));
    };
    let Some(kind) = ParameterType::parse(kind) else {
        each_value(reader, |_, _| true);
        let message = format!("`{}` is not a type of a parameter", clip(kind));
        let diagnostic = Diagnostic::new(&codes::PBRT_IGNORED, message).at(span, "is ignored");
        return Err(Box::new(diagnostic));
    };
    // Its values follow.
    let (values, count, refused) = values(reader, kind);
    let mistake = |message: String, at: Span| {
        let diagnostic = Diagnostic::new(&codes::PBRT_VALUE, message).at(at, "the wrong value");
        Err(Box::new(diagnostic))
    };
    if let Some(token) = refused {
        let word = reader.text(token);
        let message = format!("`{}` is not a value of `{}`", clip(&word.text), clip(&text));
        return mistake(message, word.span);
    }
    // Their number must fit the type.
    match values {
        ParameterValues::Numbers(_) if !kind.fits(count) => {
            let numbers = match count {
                1 => "1 number".to_owned(),
                _ => format!("{count} numbers"),
            };
            mistake(
                format!("`{}` cannot be made of {numbers}", clip(&text)),
                span,
            )
        }
        ParameterValues::Strings(_) | ParameterValues::Flags(_) if count == 0 => {
            mistake(format!("`{}` has no value", clip(&text)), span)
        }
        values => Ok(PluginParameter {
            name: SpannedText {
                text: name.to_owned(),
                span,
            },
            kind,
            values,
        }),
    }
}

/// The values that follow, their number, and the first token that is none.
fn values(
    reader: &mut TokenReader,
    kind: ParameterType,
) -> (ParameterValues, usize, Option<PbrtToken>) {
    let is_file = |reader: &TokenReader| {
        let mut ahead = reader.clone();
        ahead.next_if(PbrtTokenKind::Open);
        ahead.next_if(PbrtTokenKind::Quoted).is_some()
    };
    let is_text = match kind {
        ParameterType::String | ParameterType::Texture => true,
        ParameterType::Spectrum => is_file(reader),
        _ => false,
    };
    if is_text {
        let mut strings = Vec::new();
        let (count, refused) = each_value(reader, |reader, token| {
            let is_string = token.kind == PbrtTokenKind::Quoted;
            if is_string {
                strings.push(reader.text(token));
            }
            is_string
        });
        return (ParameterValues::Strings(strings), count, refused);
    }
    if kind == ParameterType::Bool {
        let mut flags = Vec::new();
        // They are quoted in version 3.
        let (count, refused) = each_value(reader, |reader, token| {
            let flag = match reader.bytes(token) {
                b"true" => Some(true),
                b"false" => Some(false),
                _ => None,
            };
            flags.extend(flag);
            flag.is_some()
        });
        return (ParameterValues::Flags(flags), count, refused);
    }
    let mut numbers = Vec::new();
    let (count, refused) = each_value(reader, |reader, token| {
        let number = reader.number(token);
        numbers.extend(number);
        number.is_some()
    });
    (ParameterValues::Numbers(numbers), count, refused)
}

#[cfg(test)]
mod tests {
    use super::*;
    use rtc_source::SourceMap;

    fn parameters(text: &str) -> (Parameters, Vec<&'static str>) {
        let mut codes = Vec::new();
        let file = SourceMap::default().add("text", Vec::new());
        let mut reader = TokenReader::new(file, std::sync::Arc::new(text.into()));
        let report = &mut |diagnostic: Diagnostic| codes.push(diagnostic.code.id);
        (read(&mut reader, report), codes)
    }

    #[test]
    fn values_of_each_type_are_read_with_and_without_brackets() {
        let (parameters, codes) = parameters(
            "\"float a\" 1 \"integer b\" [ 2 3 ] \"bool c\" \"true\" \"bool d\" [ false ] \
             \"color e\" [ 1 2 3 ] \"string f\" [ \"x\" ] \"point P\" [ 0 0 0 1 1 1 ]",
        );
        assert_eq!(codes, Vec::<&str>::new());
        assert_eq!(
            (parameters.number("a"), parameters.count("b")),
            (Some(1.0), Some(2))
        );
        assert_eq!(
            (parameters.flag("c"), parameters.flag("d")),
            (Some(true), Some(false))
        );
        assert_eq!(parameters.vector("e"), Some([1.0, 2.0, 3.0]));
        assert_eq!(parameters.word("f", ""), "x");
        assert_eq!(parameters.tuples::<3>("P").map(<[_]>::len), Some(2));
        assert!(parameters.unused().0.is_empty());
    }

    #[test]
    fn a_value_of_another_type_is_not_read_and_the_last_of_two_counts() {
        let (parameters, codes) =
            parameters("\"string a\" \"1\" \"float b\" 1 \"float b\" 2 \"float c\" 3");
        assert_eq!(codes, ["PB006"]);
        assert_eq!(
            (parameters.number("a"), parameters.number("b")),
            (None, Some(2.0))
        );
        let (unused, looked_up) = parameters.unused();
        let unused: Vec<&str> = unused.iter().map(|own| own.name.text.as_str()).collect();
        assert_eq!((unused, looked_up), (vec!["a", "c"], vec!["a", "b"]));
    }

    #[test]
    fn each_mistake_is_reported_and_the_rest_is_read() {
        let (parameters, codes) = parameters(
            "\"floating a\" 1 \"rgb b\" [ 1 2 ] \"float c\" [ x ] \"d\" 1 \"bool e\" 1 \
             \"string f\" 7 \"float g\" 9",
        );
        assert_eq!(
            codes,
            ["PB005", "PB002", "PB002", "PB001", "PB002", "PB002"]
        );
        assert_eq!(parameters.number("g"), Some(9.0));
    }
}
