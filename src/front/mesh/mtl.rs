//! MTL, the materials of an OBJ (Wavefront, "Advanced Visualizer", appendix B1): a `newmtl`, and
//! after it one statement a line.
//!
//! No error makes a file useless: unknown statements are skipped, and reported with their spans.

mod map;

pub use map::MtlMap;

use super::material_use::name;
use super::{MAX_FAULTS, TextParseError, WordSpan, first_lines};
use crate::words::{Word, WordError, WordLines};
use rtc_source::{Budget, Resource};
use std::collections::BTreeMap;

/// The materials of a file, and its errors.
#[derive(Debug, Default)]
pub struct MtlLibrary {
    /// The materials by name; of two of one name the later.
    pub materials: BTreeMap<String, MtlMaterial>,
    /// Statements that can't be read, the first ones.
    pub faults: Vec<WordError>,
    /// Statements for unsupported features: the first, and how many.
    pub not_shown: Option<(WordError, usize)>,
}

/// A value of a statement, and the location of the statement.
#[derive(Clone, Debug, PartialEq)]
pub struct MtlValue<T> {
    /// The value.
    pub value: T,
    /// The statement.
    pub at: WordSpan,
}

/// A material as in its file; missing values are `None`.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct MtlMaterial {
    /// Its name in the file.
    pub at: WordSpan,
    /// `Ka`, the ambient reflectance, each channel in 0..=1e6.
    pub ambient: Option<MtlValue<[f64; 3]>>,
    /// `Kd`, the diffuse reflectance, each channel in 0..=1e6.
    pub diffuse: Option<MtlValue<[f64; 3]>>,
    /// `Ks`, the specular reflectance, each channel in 0..=1e6.
    pub specular: Option<MtlValue<[f64; 3]>>,
    /// `Ns`, the exponent of the highlight, in 0..=1e6.
    pub exponent: Option<MtlValue<f64>>,
    /// `d`, or 1 − `Tr`: the opacity, in 0..=1.
    pub opacity: Option<MtlValue<f64>>,
    /// `Ni`, the index of refraction, in 0..=1e6.
    pub index: Option<MtlValue<f64>>,
    /// `illum`, the number of the illumination model, 0 to 10.
    pub model: Option<MtlValue<u8>>,
    /// `Ke`, the radiance, each channel in 0..=1e6.
    pub emissive: Option<MtlValue<[f64; 3]>>,
    /// `Tf`, the colour that light has behind it, each channel in 0..=1e6.
    pub filter: Option<MtlValue<[f64; 3]>>,
    /// `Pr`, the roughness, in 0..=1.
    pub roughness: Option<MtlValue<f64>>,
    /// `Pm`, how much of it is metal, in 0..=1.
    pub metallic: Option<MtlValue<f64>>,
    /// `Ps`, its sheen, in 0..=1.
    pub sheen: Option<MtlValue<f64>>,
    /// `Pc`, how much of it is under a clear coat, in 0..=1.
    pub clearcoat: Option<MtlValue<f64>>,
    /// `Pcr`, how rough the coat is, in 0..=1.
    pub clearcoat_roughness: Option<MtlValue<f64>>,
    /// `aniso`, how much the mirror image is drawn out, in 0..=1.
    pub anisotropy: Option<MtlValue<f64>>,
    /// `anisor`, in which direction, in turns from that of u, in 0..=1.
    pub anisotropy_rotation: Option<MtlValue<f64>>,
    /// `map_Kd`.
    pub color_map: Option<MtlValue<MtlMap>>,
    /// `map_Ks`.
    pub specular_map: Option<MtlValue<MtlMap>>,
    /// `norm`.
    pub normal_map: Option<MtlValue<MtlMap>>,
    /// `map_Bump` or `bump`.
    pub bump: Option<MtlValue<MtlMap>>,
    /// `map_d`.
    pub opacity_map: Option<MtlValue<MtlMap>>,
    /// `map_Ke`.
    pub emissive_map: Option<MtlValue<MtlMap>>,
    /// `map_Pr`.
    pub roughness_map: Option<MtlValue<MtlMap>>,
    /// `map_Pm`.
    pub metallic_map: Option<MtlValue<MtlMap>>,
    /// Whether the opacity is given by `Tr 1` alone, which some programs write for opaque
    /// materials.
    pub is_transparency_1: bool,
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
/// If they exceed the budget.
pub fn parse(bytes: &[u8], budget: &Budget) -> Result<MtlLibrary, TextParseError> {
    // A word of two bytes takes 24 while its line is read, in a list that grows by doubling.
    budget.has(Resource::Memory, 24 * bytes.len() as u64)?;
    let mut reader = MtlReader {
        file: bytes,
        library: MtlLibrary::default(),
        current: None,
    };
    let (mut lines, mut words) = (WordLines::new(bytes), Vec::new());
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

struct MtlReader<'a> {
    file: &'a [u8],
    library: MtlLibrary,
    /// The material that statements are of.
    current: Option<(String, MtlMaterial)>,
}

/// The effect of a statement.
#[derive(Clone, Copy)]
enum MtlStatement {
    Color(fn(&mut MtlMaterial) -> &mut Option<MtlValue<[f64; 3]>>),
    Number(fn(&mut MtlMaterial) -> &mut Option<MtlValue<f64>>),
    /// A number from 0 to 1.
    Fraction(fn(&mut MtlMaterial) -> &mut Option<MtlValue<f64>>),
    Map(fn(&mut MtlMaterial) -> &mut Option<MtlValue<MtlMap>>),
    Opacity,
    Transparency,
    Model,
    /// It repeats the map of the diffuse colour, or has an unsupported effect.
    AmbientMap,
    /// It changes no picture.
    Silent,
}

/// The statements, in lower case.
const STATEMENTS: &[(&str, MtlStatement)] = &[
    ("ka", MtlStatement::Color(|m| &mut m.ambient)),
    ("kd", MtlStatement::Color(|m| &mut m.diffuse)),
    ("ks", MtlStatement::Color(|m| &mut m.specular)),
    ("ns", MtlStatement::Number(|m| &mut m.exponent)),
    ("ni", MtlStatement::Number(|m| &mut m.index)),
    ("d", MtlStatement::Opacity),
    ("tr", MtlStatement::Transparency),
    ("illum", MtlStatement::Model),
    ("map_kd", MtlStatement::Map(|m| &mut m.color_map)),
    ("map_ks", MtlStatement::Map(|m| &mut m.specular_map)),
    ("norm", MtlStatement::Map(|m| &mut m.normal_map)),
    ("map_bump", MtlStatement::Map(|m| &mut m.bump)),
    ("bump", MtlStatement::Map(|m| &mut m.bump)),
    ("map_ka", MtlStatement::AmbientMap),
    ("ke", MtlStatement::Color(|m| &mut m.emissive)),
    ("tf", MtlStatement::Color(|m| &mut m.filter)),
    ("pr", MtlStatement::Fraction(|m| &mut m.roughness)),
    ("pm", MtlStatement::Fraction(|m| &mut m.metallic)),
    ("ps", MtlStatement::Fraction(|m| &mut m.sheen)),
    ("pc", MtlStatement::Fraction(|m| &mut m.clearcoat)),
    (
        "pcr",
        MtlStatement::Fraction(|m| &mut m.clearcoat_roughness),
    ),
    ("aniso", MtlStatement::Fraction(|m| &mut m.anisotropy)),
    (
        "anisor",
        MtlStatement::Fraction(|m| &mut m.anisotropy_rotation),
    ),
    ("map_d", MtlStatement::Map(|m| &mut m.opacity_map)),
    ("map_ke", MtlStatement::Map(|m| &mut m.emissive_map)),
    ("map_emissive", MtlStatement::Map(|m| &mut m.emissive_map)),
    ("map_pr", MtlStatement::Map(|m| &mut m.roughness_map)),
    ("map_pm", MtlStatement::Map(|m| &mut m.metallic_map)),
    ("map_norm", MtlStatement::Map(|m| &mut m.normal_map)),
    ("map_kn", MtlStatement::Map(|m| &mut m.normal_map)),
    ("sharpness", MtlStatement::Silent),
    ("map_aat", MtlStatement::Silent),
];

/// The largest number that is read; exponents end at 1000 in the files of programs.
const LARGEST: f64 = 1e6;

impl MtlReader<'_> {
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

    fn fault(&mut self, fault: WordError) {
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

    fn statement(&mut self, words: &[Word<'_>]) -> Result<(), WordError> {
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
            MtlStatement::Color(slot) => {
                *slot(material) = Some(MtlValue {
                    value: color(&head, rest)?,
                    at,
                })
            }
            MtlStatement::Number(slot) => {
                let value = number(&head, rest.first(), LARGEST)?;
                *slot(material) = Some(MtlValue { value, at });
            }
            MtlStatement::Fraction(slot) => {
                let value = number(&head, rest.first(), 1.0)?;
                *slot(material) = Some(MtlValue { value, at });
            }
            MtlStatement::Opacity => {
                let value = number(&head, after_halo(rest).first(), 1.0)?;
                material.opacity = Some(MtlValue { value, at });
                material.is_transparency_1 = false;
            }
            MtlStatement::Transparency => {
                let value = 1.0 - number(&head, rest.first(), 1.0)?;
                // If both are given, the opacity wins.
                if material.opacity.is_none() {
                    material.opacity = Some(MtlValue { value, at });
                    material.is_transparency_1 = value == 0.0;
                }
            }
            MtlStatement::Model => {
                material.model = Some(MtlValue {
                    value: model(&head, rest.first())?,
                    at,
                });
            }
            MtlStatement::Map(_) | MtlStatement::AmbientMap => {
                return self.map(statement, head, rest);
            }
            MtlStatement::Silent => {}
        }
        Ok(())
    }

    /// A statement of a map.
    fn map(
        &mut self,
        statement: MtlStatement,
        head: Word<'_>,
        rest: &[Word<'_>],
    ) -> Result<(), WordError> {
        let at = rest
            .last()
            .map_or(head, |last| head.through(last, self.file));
        let (value, unread) = map::read(&head, rest, self.file)?;
        let Some((_, material)) = &mut self.current else {
            return Ok(());
        };
        if let MtlStatement::Map(slot) = statement {
            let at = at.place();
            *slot(material) = Some(MtlValue { value, at });
            if let Some(option) = unread {
                let why = format!("the option `{}` is not read", option.text());
                self.skip(&option, why);
            }
        } else {
            let color = material.color_map.as_ref();
            let is_shown = color.is_none_or(|color| color.value.file == value.file);
            self.not_shown(&head, is_shown);
        }
        Ok(())
    }
}

/// The effect of a statement with this keyword.
fn known(head: &Word<'_>) -> Option<MtlStatement> {
    let is_meant =
        |(word, _): &&(&str, MtlStatement)| head.bytes.eq_ignore_ascii_case(word.as_bytes());
    Some(STATEMENTS.iter().find(is_meant)?.1)
}

/// Three numbers, or one for all three.
fn color(head: &Word<'_>, rest: &[Word<'_>]) -> Result<[f64; 3], WordError> {
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
fn number(head: &Word<'_>, word: Option<&Word<'_>>, most: f64) -> Result<f64, WordError> {
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
fn model(head: &Word<'_>, word: Option<&Word<'_>>) -> Result<u8, WordError> {
    let number = number(head, word, 10.0)?;
    let model = (0..=10).find(|model| f64::from(*model) == number);
    model.ok_or_else(|| head.fault("`illum` is a whole number from 0 to 10", "left out"))
}

/// The text after `-halo`: an opacity at grazing angles, which is read as a constant one.
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
