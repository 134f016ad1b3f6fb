//! MTL, the materials of an OBJ (Wavefront, "Advanced Visualizer", appendix B1): a `newmtl`, and
//! after it one statement a line.
//!
//! No fault makes a file worthless: what is not understood is left out, and told with its place.

use super::material_use::name;
use super::{MAX_FAULTS, Unread, WordSpan, first_lines};
use crate::words::{Lines, Word, WordFault};
use rtc_source::{Budget, Resource};
use std::collections::BTreeMap;

/// The materials of a file, and what is wrong with it.
#[derive(Debug, Default)]
pub struct Library {
    /// The materials by name; of two of one name the later.
    pub materials: BTreeMap<String, MtlMaterial>,
    /// Statements that can't be read, the first ones.
    pub faults: Vec<WordFault>,
    /// Statements that ask for what is not shown: the first, and how many.
    pub not_shown: Option<(WordFault, usize)>,
}

/// A value, and where it is written.
#[derive(Clone, Debug, PartialEq)]
pub struct Said<T> {
    /// The value.
    pub value: T,
    /// The statement.
    pub at: WordSpan,
}

/// A material as its file says it; what is not said is `None`.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct MtlMaterial {
    /// Its name in the file.
    pub at: WordSpan,
    /// `Ka`, the ambient reflectance, each channel in 0..=1e6.
    pub ambient: Option<Said<[f64; 3]>>,
    /// `Kd`, the diffuse reflectance, each channel in 0..=1e6.
    pub diffuse: Option<Said<[f64; 3]>>,
    /// `Ks`, the specular reflectance, each channel in 0..=1e6.
    pub specular: Option<Said<[f64; 3]>>,
    /// `Ns`, the exponent of the highlight, in 0..=1e6.
    pub exponent: Option<Said<f64>>,
    /// `d`, or 1 − `Tr`: how much it hides what is behind it, in 0..=1.
    pub opacity: Option<Said<f64>>,
    /// `Ni`, the index of refraction, in 0..=1e6.
    pub index: Option<Said<f64>>,
    /// `illum`, the number of the illumination model, 0 to 10.
    pub model: Option<Said<u8>>,
    /// `map_Kd`.
    pub color_map: Option<Said<String>>,
    /// `map_Ks`.
    pub specular_map: Option<Said<String>>,
    /// `norm`.
    pub normal_map: Option<Said<String>>,
    /// `map_Bump` or `bump`.
    pub bump: Option<Said<String>>,
}

/// True if a file that begins so has materials: its first statement is `newmtl`.
#[must_use]
pub fn is_mtl(head: &[u8]) -> bool {
    let mut words = Vec::new();
    first_lines(head).next(&mut words) && words[0].bytes.eq_ignore_ascii_case(b"newmtl")
}

/// Reads the materials of a file.
///
/// # Errors
/// If they would take more than the budget has.
pub fn parse(bytes: &[u8], budget: &Budget) -> Result<Library, Unread> {
    // A word of two bytes takes 24 while its line is read, in a list that grows by doubling.
    budget.has(Resource::Memory, 24 * bytes.len() as u64)?;
    let mut reader = Reader {
        file: bytes,
        library: Library::default(),
        current: None,
    };
    let (mut lines, mut words) = (Lines::new(bytes), Vec::new());
    while lines.next(&mut words) {
        if words[0].bytes.eq_ignore_ascii_case(b"newmtl") {
            let longest = size_of::<MtlMaterial>()
                + 2 * words[0]
                    .through(words.last().unwrap_or(&words[0]), bytes)
                    .bytes
                    .len();
            budget.charge(Resource::Memory, longest as u64)?;
            reader.begin(&words);
        } else if let Err(fault) = reader.statement(&words) {
            reader.fault(fault);
        }
    }
    reader.end();
    Ok(reader.library)
}

struct Reader<'a> {
    file: &'a [u8],
    library: Library,
    /// The material that statements are of.
    current: Option<(String, MtlMaterial)>,
}

/// What a statement does.
#[derive(Clone, Copy)]
enum Statement {
    Color(fn(&mut MtlMaterial) -> &mut Option<Said<[f64; 3]>>),
    Number(fn(&mut MtlMaterial) -> &mut Option<Said<f64>>),
    Map(fn(&mut MtlMaterial) -> &mut Option<Said<String>>),
    Opacity,
    Transparency,
    Model,
    /// It shows nothing if all its numbers are this.
    Nothing(f64),
    /// It repeats the map of the diffuse colour, or says what is not shown.
    AmbientMap,
    /// It changes no picture.
    Silent,
}

/// The statements, in lower case.
const STATEMENTS: &[(&str, Statement)] = &[
    ("ka", Statement::Color(|m| &mut m.ambient)),
    ("kd", Statement::Color(|m| &mut m.diffuse)),
    ("ks", Statement::Color(|m| &mut m.specular)),
    ("ns", Statement::Number(|m| &mut m.exponent)),
    ("ni", Statement::Number(|m| &mut m.index)),
    ("d", Statement::Opacity),
    ("tr", Statement::Transparency),
    ("illum", Statement::Model),
    ("map_kd", Statement::Map(|m| &mut m.color_map)),
    ("map_ks", Statement::Map(|m| &mut m.specular_map)),
    ("norm", Statement::Map(|m| &mut m.normal_map)),
    ("map_bump", Statement::Map(|m| &mut m.bump)),
    ("bump", Statement::Map(|m| &mut m.bump)),
    ("map_ka", Statement::AmbientMap),
    ("ke", Statement::Nothing(0.0)),
    ("tf", Statement::Nothing(1.0)),
    ("sharpness", Statement::Silent),
    ("map_aat", Statement::Silent),
];

/// The largest number that is read; exponents end at 1000 in the files of programs.
const LARGEST: f64 = 1e6;

impl Reader<'_> {
    fn begin(&mut self, words: &[Word<'_>]) {
        self.end();
        match name(&words[1..], self.file) {
            Some(name) => {
                let material = MtlMaterial {
                    at: name.at,
                    ..MtlMaterial::default()
                };
                self.current = Some((name.text, material));
            }
            None => self.fault(words[0].fault("the material has no name", "left out")),
        }
    }

    fn end(&mut self) {
        self.library.materials.extend(self.current.take());
    }

    fn fault(&mut self, fault: WordFault) {
        if self.library.faults.len() < MAX_FAULTS {
            self.library.faults.push(fault);
        }
    }

    fn skip(&mut self, word: &Word<'_>, why: String) {
        let first = || (word.fault(why, "the first one"), 0);
        self.library.not_shown.get_or_insert_with(first).1 += 1;
    }

    fn not_shown(&mut self, head: &Word<'_>, is_nothing: bool) {
        if !is_nothing {
            self.skip(head, format!("`{}` is not shown", head.text()));
        }
    }

    fn statement(&mut self, words: &[Word<'_>]) -> Result<(), WordFault> {
        let (head, rest) = (words[0], &words[1..]);
        let Some(statement) = known(&head) else {
            self.skip(&head, format!("`{}` is not read", head.text()));
            return Ok(());
        };
        let at = rest
            .last()
            .map_or(head, |last| head.through(last, self.file))
            .place();
        let Some((_, material)) = &mut self.current else {
            return Ok(());
        };
        match statement {
            Statement::Color(slot) => {
                *slot(material) = Some(Said {
                    value: color(&head, rest)?,
                    at,
                })
            }
            Statement::Number(slot) => {
                let value = number(&head, rest.first(), LARGEST)?;
                *slot(material) = Some(Said { value, at });
            }
            Statement::Opacity => {
                let value = number(&head, after_halo(rest).first(), 1.0)?;
                material.opacity = Some(Said { value, at });
            }
            Statement::Transparency => {
                let value = 1.0 - number(&head, rest.first(), 1.0)?;
                // Where both are said, the opacity counts.
                material.opacity.get_or_insert(Said { value, at });
            }
            Statement::Model => {
                material.model = Some(Said {
                    value: model(&head, rest.first())?,
                    at,
                });
            }
            Statement::Map(slot) => {
                let (value, option) = map(&head, rest, self.file)?;
                *slot(material) = Some(Said { value, at });
                if let Some(option) = option {
                    self.skip(
                        &option,
                        format!("the option `{}` is not read", option.text()),
                    );
                }
            }
            Statement::Nothing(nothing) => {
                let is_nothing = |word: &Word<'_>| word.number().ok() == Some(nothing);
                self.not_shown(&head, rest.iter().all(is_nothing));
            }
            Statement::AmbientMap => {
                let (file, _) = map(&head, rest, self.file)?;
                let color = material.color_map.as_ref();
                let is_shown = color.is_none_or(|color| color.value == file);
                self.not_shown(&head, is_shown);
            }
            Statement::Silent => {}
        }
        Ok(())
    }
}

/// What the statement of this head does.
fn known(head: &Word<'_>) -> Option<Statement> {
    let is_meant =
        |(word, _): &&(&str, Statement)| head.bytes.eq_ignore_ascii_case(word.as_bytes());
    Some(STATEMENTS.iter().find(is_meant)?.1)
}

/// Three numbers, or one that stands for all.
fn color(head: &Word<'_>, rest: &[Word<'_>]) -> Result<[f64; 3], WordFault> {
    let first = rest.first();
    if let Some(kind) = first.filter(|word| matches!(word.bytes, b"spectral" | b"xyz")) {
        let message = format!("colours by `{}` are not read", kind.text());
        return Err(kind.fault(message, "left out"));
    }
    let red = number(head, first, LARGEST)?;
    match rest {
        [_] => Ok([red; 3]),
        _ => Ok([
            red,
            number(head, rest.get(1), LARGEST)?,
            number(head, rest.get(2), LARGEST)?,
        ]),
    }
}

/// A number from 0 to `most`.
fn number(head: &Word<'_>, word: Option<&Word<'_>>, most: f64) -> Result<f64, WordFault> {
    let missing = || head.fault(format!("`{}` has too few numbers", head.text()), "left out");
    let word = word.ok_or_else(missing)?;
    let number = word.number()?;
    if (0.0..=most).contains(&number) {
        return Ok(number);
    }
    let message = format!(
        "`{}` must be from 0 to {most}, not {}",
        head.text(),
        word.text()
    );
    Err(word.fault(message, "left out"))
}

/// The number of an illumination model.
fn model(head: &Word<'_>, word: Option<&Word<'_>>) -> Result<u8, WordFault> {
    let number = number(head, word, 10.0)?;
    let model = (0..=10).find(|model| f64::from(*model) == number);
    model.ok_or_else(|| head.fault("`illum` is a whole number from 0 to 10", "left out"))
}

/// What follows `-halo`, an opacity at the rims that is read as one everywhere.
fn after_halo<'w, 'a>(rest: &'w [Word<'a>]) -> &'w [Word<'a>] {
    match rest {
        [
            Word {
                bytes: b"-halo", ..
            },
            rest @ ..,
        ] => rest,
        _ => rest,
    }
}

/// The file of a map, and its first option that would change the picture.
fn map<'a>(
    head: &Word<'a>,
    rest: &[Word<'a>],
    file: &[u8],
) -> Result<(String, Option<Word<'a>>), WordFault> {
    let (mut rest, mut changes) = (rest, None);
    while let Some((option, others)) = rest.split_first() {
        let Some(plain) = plain_values(option.bytes) else {
            break;
        };
        // The trailing numbers of offsets and scales may be left out; the file follows.
        let most = plain.len().min(others.len().saturating_sub(1));
        let is_value = |(word, plain): &(&Word<'_>, &&str)| {
            word.number().is_ok() || plain.parse::<f64>().is_err()
        };
        let values = others[..most].iter().zip(plain).take_while(is_value);
        let (mut count, mut is_plain) = (0, true);
        for (word, plain) in values {
            let is_same = word.bytes == plain.as_bytes()
                || word
                    .number()
                    .ok()
                    .is_some_and(|number| plain.parse() == Ok(number));
            (count, is_plain) = (count + 1, is_plain && is_same);
        }
        if !is_plain {
            changes.get_or_insert(*option);
        }
        rest = &others[count..];
    }
    let missing = || head.fault(format!("`{}` names no file", head.text()), "left out");
    let named = name(rest, file).ok_or_else(missing)?;
    Ok((named.text, changes))
}

/// The values of an option of a map that leave it as it is.
fn plain_values(option: &[u8]) -> Option<&'static [&'static str]> {
    match option {
        b"-bm" => Some(&["1"]),
        b"-mm" => Some(&["0", "1"]),
        b"-o" | b"-t" => Some(&["0", "0", "0"]),
        b"-s" => Some(&["1", "1", "1"]),
        b"-boost" => Some(&["0"]),
        b"-blendu" | b"-blendv" => Some(&["on"]),
        b"-cc" | b"-clamp" => Some(&["off"]),
        b"-imfchan" => Some(&["l"]),
        b"-texres" | b"-type" => Some(&["as it is"]),
        _ => None,
    }
}
