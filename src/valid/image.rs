//! Validates the images: every image has a pixel for each column and row.

use super::check::Checker;
use rtc_diag::Diagnostic;
use rtc_diag::codes;
use rtc_image::Texels;
use rtc_ir::{self as ir, EntityField, EntityKind, ValuePath};
use rtc_math::Id;
use std::num::NonZeroU32;

/// The id of an image of a [`ValidScene`](crate::ValidScene).
pub type ImageId = Id<Image>;

/// An image of at least one pixel.
#[derive(Clone, Debug)]
pub struct Image {
    /// Width in pixels.
    pub width: NonZeroU32,
    /// Height in pixels.
    pub height: NonZeroU32,
    /// All pixels in rows from the top; floats are finite and at least 0.
    pub texels: Texels,
}

pub(super) fn image(image: &ir::Image, index: usize, check: &mut Checker<'_>) -> Option<Image> {
    let ir::Image {
        name: _,
        width,
        height,
        kind,
        pixels,
    } = image;
    let mut reject = |message: String| {
        check.report(
            ValuePath::new(EntityKind::Image, index, EntityField::Whole),
            "",
            Diagnostic::new(&codes::BAD_IMAGE, message),
        );
    };
    // Check the number of bytes.
    let expected = (u64::from(*width) * u64::from(*height)).saturating_mul(kind.bytes() as u64);
    let sides = NonZeroU32::new(*width).zip(NonZeroU32::new(*height));
    let Some((valid_width, valid_height)) = sides.filter(|_| pixels.len() as u64 == expected)
    else {
        reject(format!(
            "an image of {width} × {height} pixels has {} bytes of {expected}",
            pixels.len()
        ));
        return None;
    };
    // Check the values.
    let pixels = pixels.clone();
    let texels = match kind {
        ir::Pixels::Rgb8 => Texels::Rgb8(pixels),
        ir::Pixels::Rgba8 => Texels::Rgba8(pixels),
        ir::Pixels::Rgb32f => Texels::Rgb32f(pixels),
    };
    if !texels.are_light() {
        reject("an image has a pixel that is negative or not finite".to_owned());
        return None;
    }
    Some(Image {
        width: valid_width,
        height: valid_height,
        texels,
    })
}
