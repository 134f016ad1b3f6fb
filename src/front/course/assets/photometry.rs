//! Loads photometric profiles: IES files (LM-63, 1986 to 2019) of type C.

use super::text_file::TextFileKind;
use super::{AssetLoader, FileCache, MissingAssetPolicy, PendingAsset};
use crate::over_limit;
use crate::words::{TextParseError, Word, WordError, WordLines};
use rtc_diag::codes;
use rtc_ir::{Light, LoweredScene, Photometry, Punctual, PunctualKind};
use rtc_source::{Budget, FileKind, Resource};

/// The file formats of profiles.
pub(super) const TEXT: TextFileKind = TextFileKind {
    entity: "profile",
    is_not: "no IES profile",
    code: &codes::BAD_PHOTOMETRY,
    policy: MissingAssetPolicy::Light,
    max_bytes: 1 << 24,
    file: FileKind {
        extensions: &["ies"],
        begins: is_profile,
    },
};

/// Loads the profile of a photometric light. If that fails, the light emits nothing.
pub(super) fn load(
    light: usize,
    pending: &PendingAsset,
    lowered: &mut LoweredScene,
    cache: &mut FileCache<Photometry>,
    loader: &mut AssetLoader<'_>,
) {
    let Some(found) = loader.find(pending, TEXT.policy) else {
        return;
    };
    let read = || Some(loader.read_text(&found, pending, &TEXT, parse)?.1);
    let Some(profile) = cache.get_or_load(&found, read) else {
        return;
    };
    // Each light has its own copy of the profile, in the scene and in the validated scene.
    let memory = 16 * profile.candela.len() as u64;
    if let Err(fault) = loader.map.budget().charge(Resource::Memory, memory) {
        let what = format!("the profile `{}`", found.shown.display());
        let diagnostic = over_limit(&what, &fault).at(pending.span, "named here");
        loader.reject(diagnostic, TEXT.policy);
        return;
    }
    if let Some(Light::Punctual(Punctual { emitter, .. })) = lowered.scene.lights.get_mut(light)
        && let PunctualKind::Photometric { photometry, .. } = emitter
    {
        let name = std::mem::take(&mut photometry.name);
        **photometry = Photometry {
            name,
            ..profile.clone()
        };
    }
}

/// Whether the first bytes of a file are those of a profile: one line starts with `TILT=`.
fn is_profile(head: &[u8]) -> bool {
    head.windows(TILT.len()).any(|word| word == TILT)
}

/// The start of the line before the numbers.
const TILT: &[u8] = b"TILT=";

/// Parses a profile; its name is empty.
fn parse(bytes: &[u8], budget: &Budget) -> Result<Photometry, TextParseError> {
    // A number of two bytes becomes one of eight, in a list that grows by doubling; the profile of
    // a quadrant is unfolded to four.
    budget.charge(Resource::Memory, 32 * bytes.len() as u64)?;
    let mut numbers = IesNumberReader::open(bytes).map_err(fault)?;
    let photometry = numbers.photometry().map_err(fault)?;
    Ok(photometry)
}

fn fault(fault: WordError) -> TextParseError {
    TextParseError::Faults(vec![fault])
}

/// Reads the numbers after the `TILT=` line.
struct IesNumberReader<'a> {
    lines: WordLines<'a>,
    /// The tokens of the current line in reverse order.
    words: Vec<Word<'a>>,
    /// The last token read.
    last: Word<'a>,
}

impl<'a> IesNumberReader<'a> {
    fn open(bytes: &'a [u8]) -> Result<Self, WordError> {
        let (mut lines, mut words) = (WordLines::new(bytes), Vec::new());
        let mut last = Word::START;
        while lines.next(&mut words) {
            last = words[0];
            let mut line = words.iter().copied();
            let Some(tilt) = line.find(|word| word.bytes.starts_with(TILT)) else {
                continue;
            };
            if tilt.bytes != b"TILT=NONE" {
                let message = format!("`{}` is not supported", tilt.text());
                return Err(tilt.fault(message, "only `TILT=NONE` is"));
            }
            words.clear();
            return Ok(Self {
                lines,
                words,
                last: tilt,
            });
        }
        Err(last.fault("the profile has no line `TILT=`", "the file ends here"))
    }

    /// The next token. Tokens are separated by white space and commas; line ends have no meaning.
    fn word(&mut self) -> Result<Word<'a>, WordError> {
        while self.words.is_empty() {
            let mut line = Vec::new();
            if !self.lines.next(&mut line) {
                return Err(self
                    .last
                    .fault("the profile ends too early", "the last number"));
            }
            let parts = line.into_iter().flat_map(|word| word.split(b','));
            self.words = parts.filter(|word| !word.bytes.is_empty()).collect();
            self.words.reverse();
        }
        self.last = self.words.pop().unwrap_or(self.last);
        Ok(self.last)
    }

    fn number(&mut self) -> Result<f64, WordError> {
        self.word()?.number()
    }

    /// Reads a count of at least `min`.
    fn count(&mut self, min: usize, entity: &str) -> Result<usize, WordError> {
        let word = self.word()?;
        let count = usize::try_from(word.integer()?).ok();
        count.filter(|count| *count >= min).ok_or_else(|| {
            let message = format!("there can't be {} {entity}", word.text());
            word.fault(message, format!("at least {min}"))
        })
    }

    /// Reads `count` numbers. Memory grows with the file, not with the count it claims.
    fn list(&mut self, count: usize) -> Result<Vec<f64>, WordError> {
        let mut list = Vec::new();
        for _ in 0..count {
            list.push(self.number()?);
        }
        Ok(list)
    }

    /// Reads angles in ascending order.
    fn angles(&mut self, count: usize) -> Result<Vec<f64>, WordError> {
        let mut angles = Vec::new();
        for _ in 0..count {
            let angle = self.number()?;
            if angles.last().is_some_and(|before| *before >= angle) {
                let message = format!("the angle {angle} follows a larger one");
                return Err(self.last.fault(message, "angles must ascend"));
            }
            angles.push(angle);
        }
        Ok(angles)
    }

    /// Reads the numbers of LM-63-2002, section 5, from the number of lamps on.
    fn photometry(&mut self) -> Result<Photometry, WordError> {
        let _lamps = self.number()?;
        let _lumens = self.number()?;
        let mut factor = self.number()?;
        let rows = self.count(2, "vertical angles")?;
        let columns = self.count(1, "horizontal angles")?;
        if self.number()? != 1.0 {
            let fault = self
                .last
                .fault("the photometry is not of type C", "type 1 is C");
            return Err(fault);
        }
        // Units, width, length and height of the lamp, which is rendered as a point.
        self.list(4)?;
        // The ballast factor, and the ballast-lamp factor, which is 1 since 1995.
        factor *= self.number()?;
        factor *= self.number()?;
        let _watts = self.number()?;
        let vertical = self.angles(rows)?;
        let horizontal = self.angles(columns)?;
        let symmetry = LateralSymmetry::of(&horizontal, &self.last)?;
        let mut profile = Vec::new();
        for _ in 0..columns {
            profile.push(self.candela(rows, factor)?);
        }
        Ok(symmetry.photometry(vertical, &horizontal, &profile))
    }

    /// Reads the intensities at one horizontal angle.
    fn candela(&mut self, rows: usize, factor: f64) -> Result<Vec<f64>, WordError> {
        let mut candela = Vec::new();
        for _ in 0..rows {
            let value = self.number()? * factor;
            if value < 0.0 {
                let message = format!("the intensity {value} is negative");
                return Err(self.last.fault(message, "must be at least 0"));
            }
            candela.push(value.abs());
        }
        Ok(candela)
    }
}

/// The lateral symmetry of a profile: the measured range of horizontal angles, from which the rest
/// is mirrored (LM-63-2002, section 5.14).
#[derive(Clone, Copy)]
enum LateralSymmetry {
    /// Rotationally symmetric: one plane.
    All,
    /// Symmetric in each quadrant: 0° to 90°.
    Quarter,
    /// Bilaterally symmetric: 0° to 180°.
    Half,
    /// Bilaterally symmetric: 90° to 270°.
    OtherHalf,
    /// Not symmetric: 0° to 360°.
    Whole,
}

impl LateralSymmetry {
    fn of(angles: &[f64], last: &Word<'_>) -> Result<Self, WordError> {
        match angles {
            [_] => Ok(Self::All),
            [0.0, .., 90.0] => Ok(Self::Quarter),
            [0.0, .., 180.0] => Ok(Self::Half),
            [90.0, .., 270.0] => Ok(Self::OtherHalf),
            [0.0, .., 360.0] => Ok(Self::Whole),
            _ => Err(last.fault(
                "the horizontal angles neither end at 90, 180 or 360 nor run from 90 to 270",
                "the last one",
            )),
        }
    }

    /// The profile, mirrored to all horizontal angles.
    fn photometry(self, vertical: Vec<f64>, angles: &[f64], profile: &[Vec<f64>]) -> Photometry {
        let columns = angles.iter().copied().zip(profile);
        let mut all: Vec<(f64, &Vec<f64>)> = match self {
            Self::All => vec![(0.0, &profile[0])],
            Self::Quarter => {
                let quarter = columns.clone();
                let half: Vec<_> = columns
                    .chain(quarter.map(|(angle, values)| (180.0 - angle, values)))
                    .collect();
                let back = half.iter().map(|(angle, values)| (360.0 - angle, *values));
                half.iter().copied().chain(back).collect()
            }
            Self::Half => {
                let back = columns
                    .clone()
                    .map(|(angle, values)| (360.0 - angle, values));
                columns.chain(back).collect()
            }
            Self::OtherHalf => {
                // 0° is the mirror image of 180°.
                let mirrored = columns
                    .clone()
                    .map(|(angle, values)| (540.0 - angle, values));
                let wrapped = mirrored
                    .clone()
                    .map(|(angle, values)| (angle - 360.0, values));
                let all = columns.chain(mirrored).chain(wrapped);
                all.filter(|(angle, _)| (0.0..=360.0).contains(angle))
                    .collect()
            }
            Self::Whole => columns.collect(),
        };
        all.sort_by(|(a, _), (b, _)| a.total_cmp(b));
        all.dedup_by(|(a, _), (b, _)| a == b);
        Photometry {
            name: String::new(),
            vertical,
            horizontal: all.iter().map(|(angle, _)| *angle).collect(),
            candela: all
                .iter()
                .flat_map(|(_, values)| values.iter().copied())
                .collect(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rtc_source::Limits;

    fn read(text: &str) -> Result<Photometry, TextParseError> {
        parse(text.as_bytes(), &Budget::new(Limits::default()))
    }

    /// The horizontal angles and intensities of a profile with two vertical angles and these
    /// measured horizontal ones.
    fn symmetry(angles: &[f64]) -> Vec<(f64, f64)> {
        let list = |values: &[f64]| {
            values
                .iter()
                .map(|value| format!("{value} "))
                .collect::<String>()
        };
        let candela: Vec<f64> = angles.iter().flat_map(|angle| [angle + 1.0, 0.0]).collect();
        let text = format!(
            "TILT=NONE\n1 -1 2 2 {} 1 1 0 0 0 0.5 1 60\n0 90\n{}\n{}",
            angles.len(),
            list(angles),
            list(&candela)
        );
        let Photometry {
            horizontal,
            candela,
            ..
        } = read(&text).expect("a sound profile");
        horizontal
            .into_iter()
            .zip(candela.into_iter().step_by(2))
            .collect()
    }

    #[test]
    fn what_was_not_measured_is_mirrored() {
        assert_eq!(symmetry(&[0.0]), [(0.0, 1.0)]);
        let quarter = [
            (0.0, 1.0),
            (30.0, 31.0),
            (90.0, 91.0),
            (150.0, 31.0),
            (180.0, 1.0),
        ];
        let back = [(210.0, 31.0), (270.0, 91.0), (330.0, 31.0), (360.0, 1.0)];
        assert_eq!(symmetry(&[0.0, 30.0, 90.0]), [&quarter[..], &back].concat());
        let half = [
            (0.0, 1.0),
            (60.0, 61.0),
            (180.0, 181.0),
            (300.0, 61.0),
            (360.0, 1.0),
        ];
        assert_eq!(symmetry(&[0.0, 60.0, 180.0]), half);
        let other = [
            (0.0, 181.0),
            (90.0, 91.0),
            (180.0, 181.0),
            (270.0, 271.0),
            (360.0, 181.0),
        ];
        assert_eq!(symmetry(&[90.0, 180.0, 270.0]), other);
        assert_eq!(
            symmetry(&[0.0, 100.0, 360.0]),
            [(0.0, 1.0), (100.0, 101.0), (360.0, 361.0)]
        );
    }

    #[test]
    fn numbers_stand_wherever_lines_end_and_factors_count() {
        let text = "IESNA91\r\n[LAMP] a #5, TILTED\r\nTILT=NONE\r\n1,1000,2,3\r\n1 1 2 0 0 0\r\n\
                    0.5 3 10 0,45,\r\n90 0 1 2\r\n3";
        let found = read(text).expect("a sound profile");
        assert_eq!(
            (found.vertical, found.candela),
            (vec![0.0, 45.0, 90.0], vec![3.0, 6.0, 9.0])
        );
    }

    #[test]
    fn a_profile_is_charged_before_it_is_read() {
        let mut limits = Limits::default();
        limits.set(Resource::Memory, 1000);
        let text = format!("TILT=NONE {}", " 1".repeat(100));
        let found = parse(text.as_bytes(), &Budget::new(limits));
        assert!(matches!(found, Err(TextParseError::Limit(_))));
    }
}
