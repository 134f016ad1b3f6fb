//! The images of textures and of the environment.

use super::Lowering;
use crate::exchange::SpannedText;
use crate::exchange::color::encoded;
use crate::exchange::number::{NumberCoding, NumberSource};
use crate::pixels::{self, PICTURES, PixelDecodeError};
use rtc_color::srgb_decoded;
use rtc_image::{OpacityUse, is_radiance};
use rtc_ir::{EntityKind, Filter, Image, ImageId, Pixels, Sampled, TextureId, Wrap};
use rtc_source::{FileKind, Span};

/// The replacement of an image.
const INSTEAD: &str = "grey replaces the texture";

/// The formats of textures.
const TEXTURES: FileKind = FileKind {
    extensions: &[
        "png", "jpg", "jpeg", "webp", "exr", "hdr", "tga", "tif", "tiff", "bmp", "qoi", "pfm",
    ],
    begins: |_| true,
};

/// What distinguishes images: the path, whether it is linear, whether it is inverted, and its use.
pub(super) type ImageKey = (String, bool, bool, ImageUse);

/// What the texels of an image are used as.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum ImageUse {
    Colors,
    /// Numbers: alpha, or without it the mean of the channels.
    Numbers,
}

/// A file with its sampler.
#[derive(Clone, Debug)]
pub(super) struct ImageMap {
    pub(super) path: SpannedText,
    pub(super) wrap: Wrap,
    pub(super) filter: Filter,
    /// Whether its bytes are linear, not sRGB.
    pub(super) is_linear: bool,
    pub(super) is_inverted: bool,
}

impl Lowering<'_> {
    /// The texture of an image; `None` without its file, which is reported once.
    pub(super) fn image_map(&mut self, map: &ImageMap, usage: ImageUse) -> Option<TextureId> {
        let key = (map.path.text.clone(), map.is_linear, map.is_inverted, usage);
        let image = match self.images.get(&key) {
            Some(known) => *known,
            None => {
                let image = self.read_image(map, usage);
                self.images.insert(key, image);
                image
            }
        }?;
        Some(self.sampled(image, map.wrap, map.filter, map.path.span))
    }

    fn read_image(&mut self, map: &ImageMap, usage: ImageUse) -> Option<ImageId> {
        let bytes = self.file(&map.path, &TEXTURES, INSTEAD)?;
        let image = match usage {
            ImageUse::Numbers => self.number_image(&bytes, map),
            ImageUse::Colors if is_radiance(&bytes) => {
                pixels::environment(&map.path.text, &bytes, self.map.budget())
            }
            ImageUse::Colors => self.picture(&bytes, map),
        };
        match image {
            Ok(image) => Some(self.add_image(image, map.path.span)),
            Err(fault) => {
                self.reject(&fault, &map.path, INSTEAD);
                None
            }
        }
    }

    /// A picture of 8 bits. Its bytes become sRGB, as the IR reads them.
    fn picture(&self, bytes: &[u8], map: &ImageMap) -> Result<Image, PixelDecodeError> {
        let decoded = pixels::decode(bytes, OpacityUse::Dropped, self.map.budget())?;
        let mut pixels = decoded.bytes;
        if map.is_linear || map.is_inverted {
            let table: [u8; 256] = std::array::from_fn(|byte| {
                let value = byte as f64 / 255.0;
                let value = if map.is_linear {
                    value
                } else {
                    srgb_decoded(value)
                };
                encoded(if map.is_inverted { 1.0 - value } else { value })
            });
            for byte in &mut pixels {
                *byte = table[usize::from(*byte)];
            }
        }
        Ok(Image {
            name: map.path.text.clone(),
            width: decoded.width,
            height: decoded.height,
            kind: Pixels::Rgb8,
            pixels: pixels.into(),
        })
    }

    /// The numbers of an image.
    fn number_image(&self, bytes: &[u8], map: &ImageMap) -> Result<Image, PixelDecodeError> {
        let budget = self.map.budget();
        let image = if is_radiance(bytes) {
            pixels::environment(&map.path.text, bytes, budget)?
        } else {
            let decoded = pixels::decode(bytes, OpacityUse::Kept, budget)?;
            Image {
                name: map.path.text.clone(),
                width: decoded.width,
                height: decoded.height,
                kind: match decoded.has_alpha {
                    true => Pixels::Rgba8,
                    false => Pixels::Rgb8,
                },
                pixels: decoded.bytes.into(),
            }
        };
        let coding = NumberCoding {
            source: NumberSource::AlphaOrMean,
            is_linear: map.is_linear,
            is_inverted: map.is_inverted,
            channel: None,
        };
        coding
            .image(&image, budget)
            .map_err(PixelDecodeError::Limit)
    }

    pub(super) fn reject(&mut self, fault: &PixelDecodeError, path: &SpannedText, instead: &str) {
        let what = format!("the image `{}`", rtc_diag::clip_path(&path.text));
        let formats = "textures are PNG, JPEG, WebP, EXR or HDR";
        let diagnostic = pixels::rejection(fault, &what, formats);
        self.without(diagnostic, path.span, instead);
    }

    pub(super) fn add_image(&mut self, image: Image, span: Span) -> ImageId {
        let id = self.scene.add_image(image);
        self.record(EntityKind::Image, id.0 as usize, span);
        id
    }

    /// The map of normals of a file.
    pub(super) fn normal_map(&mut self, path: &SpannedText) -> Option<TextureId> {
        let image = match self.normal_images.get(&path.text) {
            Some(known) => *known,
            None => {
                let image = self.read_normals(path);
                self.normal_images.insert(path.text.clone(), image);
                image
            }
        }?;
        Some(self.sampled(image, Wrap::Repeat, Filter::Linear, path.span))
    }

    fn read_normals(&mut self, path: &SpannedText) -> Option<ImageId> {
        const INSTEAD: &str = "the surface is shown smooth";
        let bytes = self.file(path, &PICTURES, INSTEAD)?;
        let decoded = pixels::decode(&bytes, OpacityUse::Dropped, self.map.budget());
        let decoded = match decoded {
            Ok(decoded) => decoded,
            Err(fault) => {
                self.reject(&fault, path, INSTEAD);
                return None;
            }
        };
        let image = Image {
            name: path.text.clone(),
            width: decoded.width,
            height: decoded.height,
            kind: Pixels::Rgb8,
            pixels: decoded.bytes.into(),
        };
        Some(self.add_image(image, path.span))
    }

    /// The texture of an image, one for each way in which it is looked up.
    fn sampled(&mut self, image: ImageId, wrap: Wrap, filter: Filter, span: Span) -> TextureId {
        let sampled = Sampled {
            image,
            wrap: [wrap; 2],
            filter,
        };
        let into = (&mut self.scene, &mut self.source_spans);
        self.textures.add(sampled, span, into)
    }
}
