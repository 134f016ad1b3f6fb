//! A picture, and what its file says of it.

use super::merkle::TileHash;

/// A picture: rows from the top, each from the left; red, green, blue.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Image {
    /// Width in pixels.
    pub width: u32,
    /// Height in pixels.
    pub height: u32,
    /// `width * height` values.
    pub pixels: Vec<[f64; 3]>,
}

/// The contents of a pixel file.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Picture {
    /// The colours.
    pub image: Image,
    /// The opacity of each pixel in [0, 1], if not all are opaque.
    pub alpha: Option<Vec<f32>>,
    /// The additional channels of an EXR; other formats have none.
    pub layers: PixelLayers,
    /// The hashes of the tiles of the film that it shows, which its file keeps; none, if the file
    /// is to keep none.
    pub tiles: Vec<TileHash>,
}

/// Further numbers of each pixel of a picture.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PixelLayers {
    /// The name of each channel, layer and channel separated by a dot, as `normal.X`; all are
    /// distinct.
    pub names: Vec<&'static str>,
    /// The values of all channels, pixel after pixel.
    pub values: Vec<f32>,
}

impl Picture {
    /// A picture of colours alone.
    #[must_use]
    pub fn opaque(image: Image) -> Self {
        Self {
            image,
            alpha: None,
            layers: PixelLayers::default(),
            tiles: Vec::new(),
        }
    }
}

/// The provenance in a file: in a PNG as international text (`iTXt`), in an EXR as text attributes,
/// in a WebP as XMP.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PictureMetadata {
    /// The program and its version: `Software` in a PNG, the standard attribute `software`.
    pub software: String,
    /// The hash of the scene: `rtc:scene`.
    pub scene: String,
    /// The settings of the render that decide the pixels: `rtc:settings`.
    pub settings: String,
    /// The view, of an EXR alone: the standard attribute `worldToCamera`.
    pub world_to_camera: Option<WorldToCamera>,
    /// The layer of a PNG, and the meaning of its values: `rtc:layer`; empty for colours.
    pub layer: String,
}

impl PictureMetadata {
    /// The meaning of the pixels, without their provenance.
    #[must_use]
    pub fn meaning(self) -> Self {
        Self {
            world_to_camera: self.world_to_camera,
            layer: self.layer,
            ..Self::default()
        }
    }

    /// The texts that are present, by name.
    pub(super) fn texts(&self) -> impl Iterator<Item = (&'static str, &str)> {
        let texts = [
            ("Software", &self.software),
            ("rtc:scene", &self.scene),
            ("rtc:settings", &self.settings),
            ("rtc:layer", &self.layer),
        ];
        let texts = texts.into_iter().filter(|(_, text)| !text.is_empty());
        texts.map(|(name, text)| (name, text.as_str()))
    }
}

/// From world to camera coordinates (the camera looks along -z, y up): a row-major matrix for row
/// vectors, as in EXR.
pub type WorldToCamera = [f32; 16];
