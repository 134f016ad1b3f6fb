//! The proof of images and textures: pixels for all of the width and height, images that exist.

use super::check::{Check, place};
use crate::diag::Diagnostic;
use crate::diag::codes;
use crate::ir::{self, Field, Noun, Pixels, Shared};
use crate::math::Vec3;

/// A picture of at least one pixel.
#[derive(Clone, Debug)]
pub struct Image {
    /// Width in pixels, at least 1.
    pub width: u32,
    /// Height in pixels, at least 1.
    pub height: u32,
    /// What a pixel is made of.
    pub kind: Pixels,
    /// All pixels in rows from the top, those of the scene itself; floats are finite and at least
    /// 0.
    pub pixels: Shared<u8>,
}

/// A pixel of an image.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Texel {
    /// Red, green, blue.
    Rgb8([u8; 3]),
    /// Red, green, blue, alpha.
    Rgba8([u8; 4]),
    /// Red, green, blue, linear.
    Rgb32f([f32; 3]),
}

impl Image {
    /// The pixel of an index.
    #[must_use]
    #[inline]
    pub fn texel(&self, index: usize) -> Texel {
        match self.kind {
            Pixels::Rgb8 => Texel::Rgb8(self.pixels.as_chunks().0[index]),
            Pixels::Rgba8 => Texel::Rgba8(self.pixels.as_chunks().0[index]),
            Pixels::Rgb32f => {
                let [r, g, b] = self.pixels.as_chunks().0.as_chunks().0[index];
                Texel::Rgb32f([r, g, b].map(f32::from_le_bytes))
            }
        }
    }

    /// Whether all pixels are equal.
    #[must_use]
    pub fn is_even(&self) -> bool {
        let mut pixels = self.pixels.chunks_exact(self.kind.bytes());
        let first = pixels.next();
        pixels.all(|pixel| Some(pixel) == first)
    }

    fn is_light(&self) -> bool {
        let is_light = |channel: &[u8; 4]| (0.0..=f32::MAX).contains(&f32::from_le_bytes(*channel));
        self.kind != Pixels::Rgb32f || self.pixels.as_chunks().0.iter().all(is_light)
    }
}

impl Texel {
    /// Red, green and blue in units of the full byte.
    #[must_use]
    #[inline]
    pub fn color(self) -> Vec3 {
        match self {
            Self::Rgb8([r, g, b]) | Self::Rgba8([r, g, b, _]) => {
                Vec3::from_array([r, g, b].map(f64::from))
            }
            Self::Rgb32f(color) => {
                Vec3::from_array(color.map(|channel| f64::from(channel) * 255.0))
            }
        }
    }
}

/// A texture of any kind.
#[derive(Clone, Debug)]
pub enum Texture {
    /// The colour (u, 0, v).
    Uv,
    /// An image: an index into [`super::Proof::images`].
    Image(usize),
    /// An image as glTF samples it, its index in range.
    Sampled(ir::Sampled),
}

pub(super) fn image(image: &ir::Image, index: usize, check: &mut Check<'_>) -> Option<Image> {
    let ir::Image {
        name: _,
        width,
        height,
        kind,
        pixels,
    } = image;
    let mut refuse = |message: String| {
        check.report(
            place(Noun::Image, index, Field::Whole),
            "",
            Diagnostic::new(&codes::BAD_IMAGE, message),
        );
    };
    let wanted = (u64::from(*width) * u64::from(*height)).saturating_mul(kind.bytes() as u64);
    if wanted == 0 || pixels.len() as u64 != wanted {
        refuse(format!(
            "an image of {width} × {height} pixels has {} bytes of {wanted}",
            pixels.len()
        ));
        return None;
    }
    let image = Image {
        width: *width,
        height: *height,
        kind: *kind,
        pixels: pixels.clone(),
    };
    if !image.is_light() {
        refuse("an image has a pixel that is negative or not finite".to_owned());
        return None;
    }
    Some(image)
}

pub(super) fn texture(
    texture: &ir::Texture,
    index: usize,
    images: usize,
    check: &mut Check<'_>,
) -> Option<Texture> {
    let mut exists = |image: ir::ImageId| {
        check.handle(
            image.0,
            images,
            "image",
            place(Noun::Texture, index, Field::Whole),
        )
    };
    match texture {
        ir::Texture::Uv => Some(Texture::Uv),
        ir::Texture::Image(image) => exists(*image).map(Texture::Image),
        ir::Texture::Sampled(sampled) => {
            exists(sampled.image).map(|_| Texture::Sampled(sampled.clone()))
        }
    }
}
