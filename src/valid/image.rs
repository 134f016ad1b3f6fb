//! The proof of images and textures: pixels for all of the width and height, images that exist.

use super::check::{Check, place};
use crate::diag::Diagnostic;
use crate::diag::codes;
use crate::ir::{self, Field, Noun};

/// A picture of at least one pixel.
#[derive(Clone, Debug)]
pub struct Image {
    /// Width in pixels, at least 1.
    pub width: u32,
    /// Height in pixels, at least 1.
    pub height: u32,
    /// Rows from the top.
    pub pixels: Texels,
}

/// The pixels of an image.
#[derive(Clone, Debug, PartialEq)]
pub enum Texels {
    /// Red, green, blue.
    Rgb8(Vec<[u8; 3]>),
    /// Red, green, blue, alpha.
    Rgba8(Vec<[u8; 4]>),
    /// Red, green, blue, linear, finite and at least 0.
    Rgb32f(Vec<[f32; 3]>),
}

impl Texels {
    /// The texel in units of the full byte, with alpha.
    #[must_use]
    #[inline]
    pub fn get(&self, index: usize) -> [f64; 4] {
        match self {
            Self::Rgb8(pixels) => {
                let [r, g, b] = pixels[index].map(f64::from);
                [r, g, b, 255.0]
            }
            Self::Rgba8(pixels) => pixels[index].map(f64::from),
            Self::Rgb32f(pixels) => {
                let [r, g, b] = pixels[index].map(|channel| f64::from(channel) * 255.0);
                [r, g, b, 255.0]
            }
        }
    }

    /// Whether all texels are equal.
    #[must_use]
    pub fn is_even(&self) -> bool {
        match self {
            Self::Rgb8(pixels) => pixels.iter().all(|pixel| *pixel == pixels[0]),
            Self::Rgba8(pixels) => pixels.iter().all(|pixel| *pixel == pixels[0]),
            Self::Rgb32f(pixels) => pixels.iter().all(|pixel| *pixel == pixels[0]),
        }
    }

    fn new(kind: ir::Pixels, bytes: &[u8]) -> Self {
        match kind {
            ir::Pixels::Rgb8 => Self::Rgb8(bytes.as_chunks().0.to_vec()),
            ir::Pixels::Rgba8 => Self::Rgba8(bytes.as_chunks().0.to_vec()),
            ir::Pixels::Rgb32f => {
                let channel = |bytes: &[u8; 4]| f32::from_le_bytes(*bytes);
                let channels = bytes.as_chunks::<4>().0.iter().map(channel).collect::<Vec<_>>();
                Self::Rgb32f(channels.as_chunks().0.to_vec())
            }
        }
    }

    fn is_light(&self) -> bool {
        match self {
            Self::Rgb8(_) | Self::Rgba8(_) => true,
            Self::Rgb32f(pixels) => pixels.as_flattened().iter().all(|channel| (0.0..=f32::MAX).contains(channel)),
        }
    }
}

/// A texture of any kind.
#[derive(Clone, Debug)]
pub enum Texture {
    /// The colour (u, 0, v).
    Uv,
    /// An image: an index into [`super::ValidScene::images`].
    Image(usize),
    /// An image as glTF samples it, its index in range.
    Sampled(ir::Sampled),
}

pub(super) fn image(image: &ir::Image, index: usize, check: &mut Check<'_>) -> Option<Image> {
    let ir::Image { name: _, width, height, kind, pixels } = image;
    let mut refuse = |message: String| {
        check.report(place(Noun::Image, index, Field::Whole), "", Diagnostic::new(&codes::BAD_IMAGE, message));
    };
    let wanted = (u64::from(*width) * u64::from(*height)).saturating_mul(kind.bytes() as u64);
    if wanted == 0 || pixels.len() as u64 != wanted {
        refuse(format!("an image of {width} × {height} pixels has {} bytes of {wanted}", pixels.len()));
        return None;
    }
    let pixels = Texels::new(*kind, pixels);
    if !pixels.is_light() {
        refuse("an image has a pixel that is negative or not finite".to_owned());
        return None;
    }
    Some(Image { width: *width, height: *height, pixels })
}

pub(super) fn texture(texture: &ir::Texture, index: usize, images: usize, check: &mut Check<'_>) -> Option<Texture> {
    let mut exists =
        |image: ir::ImageId| check.handle(image.0, images, "image", place(Noun::Texture, index, Field::Whole));
    match texture {
        ir::Texture::Uv => Some(Texture::Uv),
        ir::Texture::Image(image) => exists(*image).map(Texture::Image),
        ir::Texture::Sampled(sampled) => exists(sampled.image).map(|_| Texture::Sampled(sampled.clone())),
    }
}
