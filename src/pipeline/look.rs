//! From film to file: which kind of file, which values the film must hold for it, and the bytes.

use super::findings;
use rtc_color::Tone;
use rtc_diag::Diagnostic;
use rtc_image::{
    self as image, Association, BackgroundFill, EncodeError, FileFormat, Image, Layers, Origin,
    Picture, PictureHead, RangeClipping,
};
use rtc_ir::Display;
use rtc_plan::Arithmetic;
use rtc_render::{Aov, Background, Values};
use rtc_valid::Mode;
use serde::{Deserialize, Serialize};

/// An exposure.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Exposure {
    /// By what is seen.
    Auto,
    /// In stops.
    Stops(f64),
}

/// The look of a picture, as asked for.
#[derive(Clone, Debug)]
pub struct OutputTransform {
    /// The kind of file that it is for.
    pub kind: FileFormat,
    /// The tone map asked for.
    tone: Option<Tone>,
    /// The exposure asked for.
    asked: Option<Exposure>,
    /// The exposure in stops; that of the scene until an automatic one is found.
    stops: f64,
    background: BackgroundFill,
    /// The layers wanted, each once.
    pub aovs: Vec<Aov>,
    /// Whether a PNG or an EXR says what made it.
    pub has_metadata: bool,
}

impl OutputTransform {
    /// A look for a kind of file: tone map, exposure, background, layers.
    ///
    /// # Errors
    /// What the kind of file does not hold.
    pub fn new(
        kind: FileFormat,
        tone: Option<Tone>,
        asked: Option<Exposure>,
        background: BackgroundFill,
        layers: &[Aov],
    ) -> Result<Self, &'static str> {
        let is_linear = kind.is_linear();
        if is_linear && tone.is_some_and(|tone| tone != Tone::None) {
            return Err("`--tonemap` is for PNG; an EXR holds linear values");
        }
        if is_linear && asked == Some(Exposure::Auto) {
            return Err("`--exposure auto` is for PNG; an EXR holds linear values");
        }
        if kind == FileFormat::Jpeg && background == BackgroundFill::Transparent {
            return Err("a JPEG has no opacity; name the picture .png or .webp");
        }
        let mut aovs: Vec<Aov> = Vec::new();
        for aov in layers {
            if !aovs.contains(aov) {
                aovs.push(*aov);
            }
        }
        Ok(Self {
            kind,
            tone,
            asked,
            stops: match asked {
                Some(Exposure::Stops(stops)) => stops,
                Some(Exposure::Auto) | None => 0.0,
            },
            background,
            aovs,
            has_metadata: true,
        })
    }

    /// Shows a glTF asset by itself, unless another tone map is asked for: its whites keep their
    /// shades, and its colours stay those that its maker chose.
    pub fn show_asset(&mut self) {
        if !self.kind.is_linear() {
            self.tone = self.tone.or(Some(Tone::PbrNeutral));
        }
    }

    /// Shows a scene as it asks for, where nothing else is asked for.
    pub fn show_as(&mut self, display: &Display) {
        let Display { exposure, tone } = display;
        if !self.kind.is_linear() {
            self.tone = self.tone.or(*tone);
            if self.asked.is_none() {
                self.stops = *exposure;
            }
        }
    }

    /// The same as a scene asks for it, with all that was found.
    #[must_use]
    pub fn as_display(&self) -> Display {
        Display {
            exposure: self.stops,
            tone: self.tone,
        }
    }

    /// Whether the exposure is to be found: if it is asked for, or for the PNG of an asset with
    /// lights of its own.
    pub fn finds_exposure(&self, is_lit_asset: bool) -> bool {
        match self.asked {
            Some(Exposure::Auto) => true,
            Some(Exposure::Stops(_)) => false,
            None => is_lit_asset && !self.kind.is_linear(),
        }
    }

    /// Sets the exposure that was found, in stops.
    pub fn expose(&mut self, stops: f64) {
        self.stops = stops;
    }

    /// The exposure in stops, if nobody asked for it here and it changes the picture; never that of an
    /// EXR.
    pub fn found_exposure(&self) -> Option<f64> {
        let is_asked = matches!(self.asked, Some(Exposure::Stops(_)));
        (!is_asked && self.stops != 0.0).then_some(self.stops)
    }

    /// How values are shown, and what they are multiplied by before; linear ones as sRGB shows them.
    pub fn display(&self, mode: &Mode) -> (Tone, f64) {
        let tone = match self.tone(mode) {
            Tone::None | Tone::Srgb => Tone::Srgb,
            tone @ (Tone::Agx | Tone::PbrNeutral) => tone,
        };
        (tone, image::exposure(self.stops))
    }

    /// The tone map of a picture of this mode.
    fn tone(&self, mode: &Mode) -> Tone {
        if self.kind.is_linear() {
            Tone::None
        } else {
            self.tone.unwrap_or(mode.tone())
        }
    }

    /// Which values a film of this mode must hold.
    pub fn values(&self, mode: &Mode) -> Values {
        let is_plain = !self.kind.is_linear() && self.stops == 0.0;
        // Display values of the course are clamped sample by sample, as only its untouched pictures
        // want it.
        if is_plain && mode.tone() == Tone::None && self.tone(mode) == Tone::None {
            Values::Display
        } else {
            Values::Linear
        }
    }

    /// What the film must show behind all surfaces.
    pub fn background(&self) -> Background {
        if self.background == BackgroundFill::Film {
            Background::Environment
        } else {
            Background::Nothing
        }
    }

    /// Adds the settings of the look that differ from the default to the origin of a picture.
    pub fn describe(&self, settings: &mut serde_json::Value) {
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
    pub fn memory(&self) -> usize {
        let channel = match self.kind {
            FileFormat::Png8 | FileFormat::Jpeg | FileFormat::Webp => 1,
            FileFormat::Png16 => 2,
            FileFormat::Exr | FileFormat::ExrHalf => 4,
        };
        let layers: usize = self.aovs.iter().map(|aov| aov.channels().len()).sum();
        4 * channel * (4 + layers)
    }

    /// The look as it is for a scene of this mode, with all that was found.
    #[must_use]
    pub fn settled(&self, mode: &Mode) -> ResolvedOutputTransform {
        ResolvedOutputTransform {
            kind: self.kind,
            stops: self.stops,
            tone: self.tone(mode),
            background: self.background,
            has_metadata: self.has_metadata,
        }
    }
}

/// A look of which nothing is still to be found.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
pub struct ResolvedOutputTransform {
    /// The kind of file that it is for.
    pub kind: FileFormat,
    stops: f64,
    tone: Tone,
    background: BackgroundFill,
    /// Whether the file says what made it.
    has_metadata: bool,
}

impl ResolvedOutputTransform {
    /// The picture of a film.
    fn develop(&self, film: Image, coverage: Vec<f32>) -> Picture {
        let association = if self.kind.is_linear() {
            Association::Associated
        } else {
            Association::Straight
        };
        image::Look {
            stops: self.stops,
            tone: self.tone,
            background: self.background,
        }
        .develop(film, coverage, association)
    }

    /// The picture of a film, given with its coverage and how many values are no numbers, and of its
    /// layers; and what is found in it.
    #[must_use]
    pub fn finish(
        &self,
        (image, coverage, unnumbered): (Image, Vec<f32>, u64),
        layers: Layers,
        arithmetic: Arithmetic,
    ) -> (Picture, Vec<Diagnostic>) {
        let mut losses = Losses::default();
        let picture = self.show(image, coverage, layers, &mut losses);
        (picture, losses.findings(unnumbered, self.kind, arithmetic))
    }

    /// The picture of a film or of some rows of one, with its coverage and layers; what its file can't
    /// hold is counted.
    pub(super) fn show(
        &self,
        image: Image,
        coverage: Vec<f32>,
        layers: Layers,
        losses: &mut Losses,
    ) -> Picture {
        losses.film += image.unnumbered();
        let mut picture = self.develop(image, coverage);
        picture.layers = layers;
        let RangeClipping { unnumbered, beyond } = self.lost(&picture);
        losses.shown.unnumbered += unnumbered;
        let known = std::mem::take(&mut losses.shown.beyond);
        let names = ["R", "G", "B"].into_iter();
        let names = names.chain(picture.layers.names.iter().copied());
        let is_beyond = |name: &&'static str| known.contains(name) || beyond.contains(name);
        losses.shown.beyond = names.filter(is_beyond).collect();
        picture
    }

    /// What the file can't hold; a PNG clamps all colours alike.
    fn lost(&self, picture: &Picture) -> RangeClipping {
        let lost = picture.lost(self.kind);
        if self.kind.is_linear() {
            lost
        } else {
            RangeClipping {
                beyond: Vec::new(),
                ..lost
            }
        }
    }

    /// The bytes of the file.
    ///
    /// # Errors
    /// If the picture is larger than the format can hold.
    pub fn encode(
        &self,
        picture: &Picture,
        origin: impl FnOnce() -> Origin,
    ) -> Result<Vec<u8>, EncodeError> {
        let head = PictureHead {
            origin: self.origin(origin()),
            ..PictureHead::of(picture, self.kind)
        };
        head.encode(picture)
    }

    /// What is known of the file before any pixel is, given its size and the layers wanted.
    pub(super) fn head(
        &self,
        size: [u32; 2],
        aovs: &[Aov],
        origin: impl FnOnce() -> Origin,
    ) -> PictureHead {
        PictureHead {
            size,
            has_alpha: self.background == BackgroundFill::Transparent,
            layers: aovs
                .iter()
                .flat_map(|aov| aov.channels())
                .copied()
                .collect(),
            form: self.kind,
            is_color: true,
            origin: self.origin(origin()),
        }
    }

    /// What the file says of where it came from.
    pub(super) fn origin(&self, origin: Origin) -> Origin {
        if self.has_metadata {
            origin
        } else {
            origin.meaning()
        }
    }
}

/// What files of a picture don't show as it is, counted strip by strip.
#[derive(Default)]
pub(super) struct Losses {
    /// Pixels of the film that are no number.
    film: u64,
    /// What is lost of the picture.
    shown: RangeClipping,
}

impl Losses {
    /// What to say of it, given how many values of rays are no number.
    pub(super) fn findings(
        self,
        unnumbered: u64,
        form: FileFormat,
        arithmetic: Arithmetic,
    ) -> Vec<Diagnostic> {
        // Where samples are clamped, and where a tone map follows, no more is seen of what is no
        // number.
        let lost = RangeClipping {
            unnumbered: self.shown.unnumbered.max(self.film).max(unnumbered),
            ..self.shown
        };
        findings::unholdable(&lost, form, arithmetic)
    }
}
