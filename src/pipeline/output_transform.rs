//! From film to file: the file format, the values that the film must hold for it, and the bytes.

use super::picture_diagnostics;
use rtc_color::Tone;
use rtc_diag::Diagnostic;
use rtc_image::{
    self as image, AlphaAssociation, BackgroundFill, EncodeError, FileFormat, FormatTraits, Image,
    Picture, PictureHeader, PictureMetadata, PixelLayers, RangeClipping,
};
use rtc_ir::{Display, Scene};
use rtc_plan::Arithmetic;
use rtc_render::{Aov, Background, FilmMonitor, Values};
use rtc_valid::Mode;
use serde::{Deserialize, Serialize};
use std::borrow::Cow;

/// An exposure.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Exposure {
    /// Automatic.
    Auto,
    /// In stops.
    Stops(f64),
}

/// The output transform of a picture, as requested.
#[derive(Clone, Debug)]
pub struct OutputTransform {
    /// The file format.
    pub kind: FileFormat,
    /// The requested tone map.
    tone: Option<Tone>,
    /// The requested exposure.
    requested: Option<Exposure>,
    /// The exposure in stops; that of the scene until the automatic one is found.
    stops: f64,
    background: BackgroundFill,
    /// The requested layers, without duplicates.
    pub aovs: Vec<Aov>,
    /// Whether the file contains metadata about the program and scene.
    pub has_metadata: bool,
}

impl OutputTransform {
    /// An output transform for a file format: tone map, exposure, background, layers.
    ///
    /// # Errors
    /// If the format does not support one of them.
    pub fn new(
        kind: FileFormat,
        tone: Option<Tone>,
        requested: Option<Exposure>,
        background: BackgroundFill,
        layers: &[Aov],
    ) -> Result<Self, &'static str> {
        // Reject settings that the format does not support.
        let is_linear = kind.is_linear();
        if is_linear && tone.is_some_and(|tone| tone != Tone::None) {
            return Err("`--tonemap` is for PNG; an EXR holds linear values");
        }
        if is_linear && requested == Some(Exposure::Auto) {
            return Err("`--exposure auto` is for PNG; an EXR holds linear values");
        }
        if !kind.traits().has_alpha && background == BackgroundFill::Transparent {
            return Err("this form of file has no opacity; name the picture .png, .webp or .exr");
        }
        // Drop duplicate layers.
        let mut aovs: Vec<Aov> = Vec::new();
        for aov in layers {
            if !aovs.contains(aov) {
                aovs.push(*aov);
            }
        }
        // Layers of first hits come first, as their values do.
        aovs.sort_by_key(|aov| aov.is_of_samples());
        Ok(Self {
            kind,
            tone,
            requested,
            stops: match requested {
                Some(Exposure::Stops(stops)) => stops,
                Some(Exposure::Auto) | None => 0.0,
            },
            background,
            aovs,
            has_metadata: true,
        })
    }

    /// Uses the default tone map for a glTF asset, unless another is requested: it keeps highlights
    /// and base colours.
    pub fn show_asset(&mut self) {
        if !self.kind.is_linear() {
            self.tone = self.tone.or(Some(Tone::PbrNeutral));
        }
    }

    /// Uses the display settings and the background of a scene where nothing is requested.
    pub fn show_as(&mut self, scene: &Scene) {
        let Display { exposure, tone } = &scene.display;
        if let (BackgroundFill::Film, Some(color)) = (self.background, scene.settings.background) {
            self.background = BackgroundFill::Color(color);
        }
        if !self.kind.is_linear() {
            self.tone = self.tone.or(*tone);
            if self.requested.is_none() {
                self.stops = *exposure;
            }
        }
    }

    /// The transform of the same form by the display settings of a scene alone.
    pub(super) fn unasked(&self, scene: &Scene) -> Self {
        let mut plain = Self {
            tone: None,
            requested: None,
            stops: 0.0,
            background: BackgroundFill::Film,
            ..self.clone()
        };
        plain.show_as(scene);
        plain
    }

    /// The current exposure and tone map as display settings.
    #[must_use]
    pub fn as_display(&self) -> Display {
        Display {
            exposure: self.stops,
            tone: self.tone,
        }
    }

    /// Whether the exposure must be measured: if requested, or for the display image of an asset
    /// with lights.
    pub fn finds_exposure(&self, is_lit_asset: bool) -> bool {
        match self.requested {
            Some(Exposure::Auto) => true,
            Some(Exposure::Stops(_)) => false,
            None => is_lit_asset && !self.kind.is_linear(),
        }
    }

    /// Sets the measured exposure, in stops.
    pub fn expose(&mut self, stops: f64) {
        self.stops = stops;
    }

    /// The exposure in stops, if it was not requested and is not 0.
    pub fn found_exposure(&self) -> Option<f64> {
        let is_asked = matches!(self.requested, Some(Exposure::Stops(_)));
        (!is_asked && self.stops != 0.0).then_some(self.stops)
    }

    /// The tone map and the exposure factor for displaying the picture; linear values are displayed
    /// as sRGB.
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

    /// The values that the film must hold.
    pub fn values(&self, mode: &Mode) -> Values {
        let is_plain = !self.kind.is_linear() && self.stops == 0.0;
        // Display values of the course are clamped per sample, as its unmodified pictures require.
        if is_plain && mode.tone() == Tone::None && self.tone(mode) == Tone::None {
            Values::Display
        } else {
            Values::Linear
        }
    }

    /// The background that the film must hold.
    pub fn background(&self) -> Background {
        if self.background == BackgroundFill::Film {
            Background::Environment
        } else {
            Background::Nothing
        }
    }

    /// Whether pixels without a surface are transparent.
    #[must_use]
    pub fn is_transparent(&self) -> bool {
        self.background == BackgroundFill::Transparent
    }

    /// Adds the settings that are not defaults to the metadata of a picture.
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

    /// The maximum number of bytes per pixel while encoding: as numbers, packed, and in the growing
    /// file.
    pub fn memory(&self) -> usize {
        let channel = match self.kind.traits() {
            // Layers have 32 bits.
            FormatTraits {
                is_linear: true, ..
            } => 4,
            FormatTraits { bits, .. } => bits as usize / 8,
        };
        let layers: usize = self.aovs.iter().map(|aov| aov.channels().len()).sum();
        4 * channel * (4 + layers)
    }

    /// The output transform for this mode, with everything resolved.
    #[must_use]
    pub fn resolve(&self, mode: &Mode) -> ResolvedOutputTransform {
        ResolvedOutputTransform {
            kind: self.kind,
            stops: self.stops,
            tone: self.tone(mode),
            background: self.background,
            has_metadata: self.has_metadata,
        }
    }
}

/// An output transform in which everything is resolved.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
pub struct ResolvedOutputTransform {
    /// The file format.
    pub kind: FileFormat,
    stops: f64,
    tone: Tone,
    background: BackgroundFill,
    /// Whether the file contains metadata about the program and scene.
    has_metadata: bool,
}

impl ResolvedOutputTransform {
    /// The picture of a film.
    fn develop(&self, film: Image, coverage: Vec<f32>) -> Picture {
        let association = if self.kind.is_linear() {
            AlphaAssociation::Associated
        } else {
            AlphaAssociation::Straight
        };
        image::DisplayTransform {
            stops: self.stops,
            tone: self.tone,
            background: self.background,
        }
        .develop(film, coverage, association)
    }

    /// The picture of a film with its coverage, its number of NaN values and its layers; and the
    /// diagnostics about it.
    #[must_use]
    pub fn finish(
        &self,
        (image, coverage, unnumbered): (Image, Vec<f32>, u64),
        layers: PixelLayers,
        arithmetic: Arithmetic,
    ) -> (Picture, Vec<Diagnostic>) {
        let mut losses = ClippedValues::default();
        let picture = self.show(image, coverage, layers, &mut losses);
        (
            picture,
            losses.picture_diagnostics(unnumbered, self.kind, arithmetic),
        )
    }

    /// The picture of a film or of some of its rows; values that the file can't hold are counted.
    pub(super) fn show(
        &self,
        image: Image,
        coverage: Vec<f32>,
        layers: PixelLayers,
        losses: &mut ClippedValues,
    ) -> Picture {
        losses.film += image.unnumbered();
        let tiles = match self.has_tiles() {
            true => image::tile_hashes(&image, &coverage),
            false => Vec::new(),
        };
        let mut picture = self.develop(image, coverage);
        picture.layers = layers;
        picture.tiles = tiles;
        let RangeClipping { unnumbered, beyond } = self.clipping(&picture);
        losses.picture.unnumbered += unnumbered;
        let known = std::mem::take(&mut losses.picture.beyond);
        let channel_names = ["R", "G", "B"].into_iter();
        let channel_names = channel_names.chain(picture.layers.names.iter().copied());
        let is_beyond = |name: &&'static str| known.contains(name) || beyond.contains(name);
        losses.picture.beyond = channel_names.filter(is_beyond).collect();
        picture
    }

    /// The same, without metadata of the program and scene.
    #[must_use]
    pub fn without_metadata(self) -> Self {
        Self {
            has_metadata: false,
            ..self
        }
    }

    /// The picture of a film that is being rendered: pixels that are not final are transparent.
    /// `None` if the monitor has none.
    #[must_use]
    pub fn unfinished(&self, monitor: &FilmMonitor) -> Option<Picture> {
        let (film, finished) = monitor.film()?;
        let all = self.develop(film.image, film.coverage);
        let pixels = all.image.pixels.len();
        let mut alpha = vec![0.0; pixels];
        let mut picture = Picture::opaque(Image {
            pixels: vec![[0.0; 3]; pixels],
            ..all.image
        });
        for area in finished {
            for row in area.y..area.y + area.height {
                let first = row as usize * all.image.width as usize + area.x as usize;
                let row = first..first + area.width as usize;
                picture.image.pixels[row.clone()].copy_from_slice(&all.image.pixels[row.clone()]);
                match &all.alpha {
                    Some(own) => alpha[row.clone()].copy_from_slice(&own[row]),
                    None => alpha[row].fill(1.0),
                }
            }
        }
        picture.alpha = Some(alpha);
        Some(picture)
    }

    /// The values that the file can't hold. For PNG, clamping of colours is normal and not counted.
    fn clipping(&self, picture: &Picture) -> RangeClipping {
        let clipping = picture.lost(self.kind);
        if self.kind.is_linear() {
            clipping
        } else {
            RangeClipping {
                beyond: Vec::new(),
                ..clipping
            }
        }
    }

    /// The bytes of the file.
    ///
    /// # Errors
    /// If the picture is larger than the format allows.
    pub fn encode(
        &self,
        picture: &Picture,
        metadata: impl FnOnce() -> PictureMetadata,
    ) -> Result<Vec<u8>, EncodeError> {
        self.head_of(picture, metadata()).encode(picture)
    }

    /// The bytes of the PNG file, for programs that write no other format.
    ///
    /// # Errors
    /// If it is made for another format, or the picture is larger than the format allows.
    pub fn encode_png(
        &self,
        picture: &Picture,
        metadata: PictureMetadata,
    ) -> Result<Vec<u8>, EncodeError> {
        self.head_of(picture, metadata).encode_png(picture)
    }

    fn head_of(&self, picture: &Picture, metadata: PictureMetadata) -> PictureHeader {
        PictureHeader {
            metadata: self.metadata(metadata),
            ..PictureHeader::of(picture, self.kind)
        }
    }

    /// The properties of the file before rendering, given its size and layers.
    pub(super) fn head(
        &self,
        size: [u32; 2],
        aovs: &[Aov],
        metadata: impl FnOnce() -> PictureMetadata,
    ) -> PictureHeader {
        PictureHeader {
            size,
            has_alpha: self.background == BackgroundFill::Transparent,
            layers: aovs
                .iter()
                .flat_map(|aov| aov.channels())
                .map(|name| Cow::Borrowed(*name))
                .collect(),
            form: self.kind,
            is_color: true,
            metadata: self.metadata(metadata()),
            has_tiles: self.has_tiles(),
        }
    }

    /// Whether the file stores the hashes of its film tiles.
    fn has_tiles(&self) -> bool {
        self.has_metadata && self.kind.traits().has_metadata
    }

    /// Whether the file contains metadata about the program and scene.
    pub(super) fn has_metadata(&self) -> bool {
        self.has_metadata
    }

    /// The metadata of the file.
    pub(super) fn metadata(&self, metadata: PictureMetadata) -> PictureMetadata {
        if self.has_metadata {
            metadata
        } else {
            metadata.meaning()
        }
    }
}

/// Counts of values that the file can't hold, accumulated over strips.
#[derive(Default)]
pub(super) struct ClippedValues {
    /// Pixels of the film that are NaN.
    film: u64,
    /// Losses of the picture.
    picture: RangeClipping,
}

impl ClippedValues {
    /// The diagnostics, given the number of NaN values of rays.
    pub(super) fn picture_diagnostics(
        self,
        unnumbered: u64,
        form: FileFormat,
        arithmetic: Arithmetic,
    ) -> Vec<Diagnostic> {
        // Clamping and tone mapping can hide NaN values.
        let clipping = RangeClipping {
            unnumbered: self.picture.unnumbered.max(self.film).max(unnumbered),
            ..self.picture
        };
        picture_diagnostics::out_of_range(&clipping, form, arithmetic)
    }
}
