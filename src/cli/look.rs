//! From film to file: which kind of file, which values the film must hold for it, and the bytes.

use super::Failure;
use super::args::{self, BitDepth};
use super::parse::Exposure;
use crate::color::Tone;
use crate::image::{self, Association, BackgroundFill, Image, Lost, Origin, Picture};
use crate::render::{Aov, Background, Values};
use crate::valid::Mode;
use std::path::Path;

/// The look of a picture, as asked for.
pub(super) struct OutputLook {
    kind: OutputFormat,
    tone: Option<Tone>,
    /// The exposure asked for.
    asked: Option<Exposure>,
    /// The exposure in stops; 0 until an automatic one is found.
    stops: f64,
    background: BackgroundFill,
    /// The layers wanted, each once.
    pub(super) aovs: Vec<Aov>,
}

/// A kind of pixel file.
#[derive(Clone, Copy, PartialEq, Eq)]
enum OutputFormat {
    Png8,
    Png16,
    Exr,
}

impl OutputLook {
    pub(super) fn new(args: &args::LookArgs, output: &Path) -> Result<Self, Failure> {
        let kind = kind(output, args.bits)?;
        let tone = args.tonemap.map(Tone::from);
        if kind == OutputFormat::Exr && tone.is_some_and(|tone| tone != Tone::None) {
            return Err(Failure::Trouble(
                "`--tonemap` is for PNG; an EXR holds linear values".to_owned(),
            ));
        }
        if kind == OutputFormat::Exr && args.exposure == Some(Exposure::Auto) {
            return Err(Failure::Trouble(
                "`--exposure auto` is for PNG; an EXR holds linear values".to_owned(),
            ));
        }
        let mut aovs: Vec<Aov> = Vec::new();
        for aov in args.aov.iter().map(|layer| Aov::from(*layer)) {
            if !aovs.contains(&aov) {
                aovs.push(aov);
            }
        }
        if kind != OutputFormat::Exr && !aovs.is_empty() {
            return Err(Failure::Trouble(
                "`--aov` is for EXR; a PNG holds colours alone".to_owned(),
            ));
        }
        Ok(Self {
            kind,
            tone,
            asked: args.exposure,
            stops: match args.exposure {
                Some(Exposure::Stops(stops)) => stops,
                Some(Exposure::Auto) | None => 0.0,
            },
            background: args.background,
            aovs,
        })
    }

    /// Shows a glTF asset by itself, unless another tone map is asked for: its whites keep their
    /// shades, and its colours stay those that its maker chose.
    pub(super) fn show_asset(&mut self) {
        if self.kind != OutputFormat::Exr {
            self.tone = self.tone.or(Some(Tone::PbrNeutral));
        }
    }

    /// Whether the exposure is to be found: if it is asked for, or for the PNG of an asset with
    /// lights of its own.
    pub(super) fn finds_exposure(&self, is_lit_asset: bool) -> bool {
        match self.asked {
            Some(Exposure::Auto) => true,
            Some(Exposure::Stops(_)) => false,
            None => is_lit_asset && self.kind != OutputFormat::Exr,
        }
    }

    /// Sets the exposure that was found, in stops.
    pub(super) fn expose(&mut self, stops: f64) {
        self.stops = stops;
    }

    /// The exposure in stops, if it was found and changes the picture; never that of an EXR.
    pub(super) fn found_exposure(&self) -> Option<f64> {
        let is_asked = matches!(self.asked, Some(Exposure::Stops(_)));
        (!is_asked && self.stops != 0.0).then_some(self.stops)
    }

    /// How values are shown, and what they are multiplied by before; linear ones as sRGB shows them.
    pub(super) fn display(&self, mode: &Mode) -> (Tone, f64) {
        let tone = match self.tone(mode) {
            Tone::None | Tone::Srgb => Tone::Srgb,
            tone @ (Tone::Agx | Tone::PbrNeutral) => tone,
        };
        (tone, image::exposure(self.stops))
    }

    /// The tone map of a picture of this mode.
    fn tone(&self, mode: &Mode) -> Tone {
        match self.kind {
            OutputFormat::Exr => Tone::None,
            OutputFormat::Png8 | OutputFormat::Png16 => self.tone.unwrap_or(mode.tone()),
        }
    }

    /// Which values a film of this mode must hold.
    pub(super) fn values(&self, mode: &Mode) -> Values {
        let is_plain = self.kind != OutputFormat::Exr && self.stops == 0.0;
        // Display values of the course are clamped sample by sample, as only its untouched pictures
        // want it.
        if is_plain && mode.tone() == Tone::None && self.tone(mode) == Tone::None {
            Values::Display
        } else {
            Values::Linear
        }
    }

    /// What the film must show behind all surfaces.
    pub(super) fn background(&self) -> Background {
        if self.background == BackgroundFill::Film {
            Background::Environment
        } else {
            Background::Nothing
        }
    }

    /// Adds the settings of the look that differ from the default to the origin of a picture.
    pub(super) fn describe(&self, settings: &mut serde_json::Value) {
        if self.stops != 0.0 {
            settings["exposure"] = self.stops.into();
        }
        if let Some(tone) = self.tone {
            settings["tonemap"] = tone.name().into();
        }
        match self.background {
            BackgroundFill::Film => {}
            BackgroundFill::Transparent => settings["background"] = "transparent".into(),
            BackgroundFill::Color(color) => settings["background"] = color.to_vec().into(),
        }
    }

    /// The most bytes that a pixel takes on its way into the file: as numbers, packed, and in the
    /// file, which grows by doubling.
    pub(super) fn memory(&self) -> usize {
        let channel = match self.kind {
            OutputFormat::Png8 => 1,
            OutputFormat::Png16 => 2,
            OutputFormat::Exr => 4,
        };
        let layers: usize = self.aovs.iter().map(|aov| aov.channels().len()).sum();
        4 * channel * (4 + layers)
    }

    /// The picture of a film.
    pub(super) fn develop(&self, film: Image, coverage: Vec<f32>, mode: &Mode) -> Picture {
        let association = match self.kind {
            OutputFormat::Exr => Association::Associated,
            OutputFormat::Png8 | OutputFormat::Png16 => Association::Straight,
        };
        image::Look {
            stops: self.stops,
            tone: self.tone(mode),
            background: self.background,
        }
        .develop(film, coverage, association)
    }

    /// What the file can't hold; a PNG clamps all colours alike.
    pub(super) fn lost(&self, picture: &Picture) -> Lost {
        let lost = picture.lost();
        if self.kind == OutputFormat::Exr {
            lost
        } else {
            Lost {
                beyond: Vec::new(),
                ..lost
            }
        }
    }

    /// The bytes of the file.
    pub(super) fn encode(
        &self,
        picture: &Picture,
        origin: impl FnOnce() -> Origin,
    ) -> Result<Vec<u8>, Failure> {
        let form = match self.kind {
            OutputFormat::Png8 => image::FileFormat::Png8,
            OutputFormat::Png16 => image::FileFormat::Png16,
            OutputFormat::Exr => image::FileFormat::Exr(origin()),
        };
        let bytes = picture
            .encode(&form)
            .map_err(|error| Failure::Trouble(error.to_string()))?;
        Ok(match self.found_exposure() {
            Some(stops) => image::commented(&bytes, &format!("exposure {stops:.4} stops")),
            None => bytes,
        })
    }
}

fn kind(output: &Path, bits: Option<BitDepth>) -> Result<OutputFormat, Failure> {
    let extension = output
        .extension()
        .map(|extension| extension.to_string_lossy().to_lowercase());
    let is_stdout = output.as_os_str() == "-";
    match (extension.as_deref(), bits) {
        (Some("exr"), None) => Ok(OutputFormat::Exr),
        (Some("exr"), Some(_)) => Err(Failure::Trouble(
            "`--bits` is for PNG; an EXR holds 32-bit floats".to_owned(),
        )),
        (Some("png"), Some(BitDepth::Sixteen)) => Ok(OutputFormat::Png16),
        (Some("png"), Some(BitDepth::Eight) | None) => Ok(OutputFormat::Png8),
        (None, Some(BitDepth::Sixteen)) if is_stdout => Ok(OutputFormat::Png16),
        (None, Some(BitDepth::Eight) | None) if is_stdout => Ok(OutputFormat::Png8),
        _ => Err(Failure::Trouble(format!(
            "can't tell what `{}` is to be; name it .png or .exr",
            output.display()
        ))),
    }
}
