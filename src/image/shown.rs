//! Picture files as display values: pixel files as stored, up to 16 bits per channel, and linear
//! pictures encoded as sRGB. Decoded pictures keep their compact type.

use super::decode::{CodedPixels, DecodeCost, DecodeError, PixelFile};
use super::{Image, OpacityUse, RadianceFile, is_radiance};
use rtc_color::Tone;

/// A picture file whose header was read.
pub struct DisplayedFile<'a>(DisplaySource<'a>);

enum DisplaySource<'a> {
    Pixels(PixelFile<'a>),
    Light(RadianceFile<'a>),
}

/// A picture as it is shown on black.
#[derive(Clone, Debug, PartialEq)]
pub struct DisplayedPicture {
    size: [u32; 2],
    values: DisplayValues,
}

/// The pixels, row by row.
#[derive(Clone, Debug, PartialEq)]
enum DisplayValues {
    /// Display values.
    Display(Vec<[f64; 3]>),
    /// As a pixel file codes them.
    Coded(CodedPixels),
    /// Red, green and blue of light, as little-endian 32-bit floats.
    Light(Vec<u8>),
}

impl<'a> DisplayedFile<'a> {
    /// Reads the header of a PNG, JPEG, WebP, HDR or EXR of at most this many pixels.
    ///
    /// # Errors
    /// If the bytes are no such file, its header is damaged or has more pixels.
    pub fn open(bytes: &'a [u8], most_pixels: u64) -> Result<Self, DecodeError> {
        Ok(Self(if is_radiance(bytes) {
            DisplaySource::Light(RadianceFile::open(bytes, most_pixels)?)
        } else {
            DisplaySource::Pixels(PixelFile::open(bytes, OpacityUse::Kept, most_pixels)?)
        }))
    }

    /// Its width and height in pixels; of an EXR those of the largest layer.
    #[must_use]
    pub fn size(&self) -> [u32; 2] {
        match &self.0 {
            DisplaySource::Pixels(file) => file.size(),
            DisplaySource::Light(file) => file.size(),
        }
    }

    /// Whether it has linear values.
    #[must_use]
    pub fn holds_light(&self) -> bool {
        matches!(self.0, DisplaySource::Light(_))
    }

    /// What decoding it will take.
    #[must_use]
    pub fn cost(&self) -> DecodeCost {
        match &self.0 {
            DisplaySource::Pixels(file) => file.cost(),
            DisplaySource::Light(file) => file.cost(),
        }
    }

    /// Decodes it; of an EXR the first layer with red, green and blue, without its opacity, and 0
    /// for negative values.
    ///
    /// # Errors
    /// If the file is damaged, or there is no memory for it.
    pub fn decode(self) -> Result<DisplayedPicture, DecodeError> {
        let size = self.size();
        match self.0 {
            DisplaySource::Pixels(file) => Ok(DisplayedPicture {
                size,
                values: DisplayValues::Coded(file.decode_coded()?),
            }),
            DisplaySource::Light(file) => file.decode().map(|light| DisplayedPicture {
                size: [light.width, light.height],
                values: DisplayValues::Light(light.bytes),
            }),
        }
    }
}

impl DisplayedPicture {
    /// An opaque picture of display values.
    #[must_use]
    pub fn of(display: Image) -> Self {
        Self {
            size: [display.width, display.height],
            values: DisplayValues::Display(display.pixels),
        }
    }

    /// Reads a file of at most this many pixels, as [`DisplayedFile`] does.
    ///
    /// # Errors
    /// As of [`DisplayedFile::open`] and [`DisplayedFile::decode`].
    pub fn read(bytes: &[u8], most_pixels: u64) -> Result<Self, DecodeError> {
        DisplayedFile::open(bytes, most_pixels)?.decode()
    }

    /// Its width and height in pixels.
    #[must_use]
    pub fn size(&self) -> [u32; 2] {
        self.size
    }

    /// Its number of pixels.
    #[must_use]
    pub fn pixels(&self) -> usize {
        self.size[0] as usize * self.size[1] as usize
    }

    /// The display values of a pixel from 0 to 1, multiplied with the opacity.
    #[must_use]
    pub fn display(&self, index: usize) -> [f64; 3] {
        match &self.values {
            DisplayValues::Display(pixels) => pixels[index],
            DisplayValues::Coded(coded) => {
                let [r, g, b, opacity] = coded.values(index);
                [r, g, b].map(|value| value * opacity)
            }
            DisplayValues::Light(bytes) => Tone::Srgb.display(light(bytes, index)),
        }
    }

    /// The linear value of a pixel, if the file has them.
    #[must_use]
    pub fn light(&self, index: usize) -> Option<[f64; 3]> {
        match &self.values {
            DisplayValues::Display(_) | DisplayValues::Coded(_) => None,
            DisplayValues::Light(bytes) => Some(light(bytes, index)),
        }
    }

    /// The opacity of a pixel in [0, 1].
    #[must_use]
    pub fn opacity(&self, index: usize) -> f64 {
        match &self.values {
            DisplayValues::Display(_) | DisplayValues::Light(_) => 1.0,
            DisplayValues::Coded(coded) => coded.values(index)[3],
        }
    }

    /// Whether all its pixels, at least two, have one value.
    #[must_use]
    pub fn is_flat(&self) -> bool {
        let first = (self.pixels() > 1).then(|| self.display(0));
        first.is_some_and(|first| (1..self.pixels()).all(|index| self.display(index) == first))
    }

    /// The display values of a part: its first column and row, and its width and height, all within
    /// the picture.
    #[must_use]
    pub fn part(&self, [left, top]: [u32; 2], [width, height]: [u32; 2]) -> Image {
        let rows = (top..top + height).map(|y| y as usize * self.size[0] as usize + left as usize);
        let pixels = rows.flat_map(|first| first..first + width as usize);
        Image {
            width,
            height,
            pixels: pixels.map(|index| self.display(index)).collect(),
        }
    }

    /// The display values of all pixels.
    #[must_use]
    pub fn image(&self) -> Image {
        self.part([0, 0], self.size)
    }
}

/// The light of a pixel.
fn light(bytes: &[u8], index: usize) -> [f64; 3] {
    let (values, _) = bytes.as_chunks::<4>();
    [0, 1, 2].map(|channel| f64::from(f32::from_le_bytes(values[3 * index + channel])))
}
