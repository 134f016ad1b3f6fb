//! The proof of images and textures: pixels for all of the width and height, images that exist.

use super::check::{Check, place};
use crate::diag::Diagnostic;
use crate::diag::codes;
use crate::ir::{self, Field, Noun};
use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;

/// A picture of 8 bits a channel, at least one pixel.
#[derive(Clone, Debug)]
pub struct Image {
    /// Width in pixels, at least 1.
    pub width: u32,
    /// Height in pixels, at least 1.
    pub height: u32,
    /// Rows from the top: red, green, blue.
    pub pixels: Vec<[u8; 3]>,
}

/// A texture of any kind.
#[derive(Clone, Copy, Debug)]
pub enum Texture {
    /// The colour (u, 0, v).
    Uv,
    /// An image: an index into [`super::ValidScene::images`].
    Image(usize),
}

pub(super) fn image(image: &ir::Image, index: usize, check: &mut Check<'_>) -> Option<Image> {
    let ir::Image { name: _, width, height, pixels } = image;
    let mut refuse = |message: String| {
        check.report(place(Noun::Image, index, Field::Whole), "", Diagnostic::new(&codes::BAD_IMAGE, message));
    };
    let Ok(bytes) = STANDARD.decode(pixels) else {
        refuse("the pixels of an image are not Base64".to_owned());
        return None;
    };
    let wanted = (u64::from(*width) * u64::from(*height)).saturating_mul(3);
    if wanted == 0 || bytes.len() as u64 != wanted {
        refuse(format!("an image of {width} × {height} pixels has {} bytes of {wanted}", bytes.len()));
        return None;
    }
    let pixels = bytes.as_chunks().0.to_vec();
    Some(Image { width: *width, height: *height, pixels })
}

pub(super) fn texture(texture: &ir::Texture, index: usize, images: usize, check: &mut Check<'_>) -> Option<Texture> {
    match texture {
        ir::Texture::Uv => Some(Texture::Uv),
        ir::Texture::Image(image) => {
            check.handle(image.0, images, "image", place(Noun::Texture, index, Field::Whole)).map(Texture::Image)
        }
    }
}
