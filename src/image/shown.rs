//! Picture files read for what they show: pixel files as they are stored, to 16 bits a channel, and
//! pictures of light by the code of sRGB.

use super::decode::{DecodeError, PixelFile};
use super::{Image, Opacity, RadianceFile, is_radiance};
use rtc_color::Tone;

/// A picture as it is shown on black.
#[derive(Clone, Debug, PartialEq)]
pub struct ShownPicture {
    /// Display values from 0 to 1, multiplied with the opacity.
    pub display: Image,
    /// The values of light, if the file holds those.
    pub linear: Option<Image>,
    /// The opacity of each pixel in [0, 1], if not all are opaque.
    pub alpha: Option<Vec<f64>>,
}

impl ShownPicture {
    /// An opaque picture of display values.
    #[must_use]
    pub fn of(display: Image) -> Self {
        Self {
            display,
            linear: None,
            alpha: None,
        }
    }

    /// Reads PNG, JPEG, WebP, HDR or EXR of at most so many pixels; of an EXR the first layer with red,
    /// green and blue, without its opacity, and 0 for negative values.
    ///
    /// # Errors
    /// If the bytes are no such file, it is damaged or has more pixels, or there is no memory for it.
    pub fn read(bytes: &[u8], most_pixels: u64) -> Result<Self, DecodeError> {
        if is_radiance(bytes) {
            light(bytes, most_pixels)
        } else {
            let (display, alpha) =
                PixelFile::open(bytes, Opacity::Kept, most_pixels)?.decode_wide()?;
            Ok(Self {
                display,
                linear: None,
                alpha,
            })
        }
    }
}

fn light(bytes: &[u8], most_pixels: u64) -> Result<ShownPicture, DecodeError> {
    let light = RadianceFile::open(bytes, most_pixels)?.decode()?;
    let (values, _) = light.bytes.as_chunks::<4>();
    let (pixels, _) = values.as_chunks::<3>();
    let value = |bytes: [u8; 4]| f64::from(f32::from_le_bytes(bytes));
    let linear = Image {
        width: light.width,
        height: light.height,
        pixels: pixels.iter().map(|pixel| pixel.map(value)).collect(),
    };
    let shown = linear.pixels.iter().map(|pixel| Tone::Srgb.display(*pixel));
    let display = Image {
        width: light.width,
        height: light.height,
        pixels: shown.collect(),
    };
    Ok(ShownPicture {
        display,
        linear: Some(linear),
        alpha: None,
    })
}
