//! The size of a picture, and the buffer for it.

use super::error::DecodeError;

/// Width and height in pixels, each at least 1.
#[derive(Clone, Copy)]
pub(crate) struct ImageSize {
    pub(crate) width: u32,
    pub(crate) height: u32,
}

impl ImageSize {
    /// A size, if it has at most this many pixels.
    pub(crate) fn within(most_pixels: u64, width: u32, height: u32) -> Result<Self, DecodeError> {
        if width == 0 || height == 0 {
            return Err(DecodeError::Damaged("it has no pixels".to_owned()));
        }
        let size = Self { width, height };
        if size.pixels() > most_pixels {
            Err(size.too_large())
        } else {
            Ok(size)
        }
    }

    pub(crate) fn pixels(self) -> u64 {
        u64::from(self.width) * u64::from(self.height)
    }

    pub(crate) fn too_large(self) -> DecodeError {
        DecodeError::TooLarge {
            width: self.width,
            height: self.height,
        }
    }

    /// A buffer with this many bytes per pixel, if there is memory for it.
    pub(crate) fn buffer(self, pixel: usize) -> Result<Vec<u8>, DecodeError> {
        let bytes = usize::try_from(self.pixels())
            .ok()
            .and_then(|pixels| pixels.checked_mul(pixel));
        let bytes = bytes.ok_or(self.too_large())?;
        let mut buffer = Vec::new();
        buffer
            .try_reserve_exact(bytes)
            .map_err(|_| self.too_large())?;
        buffer.resize(bytes, 0);
        Ok(buffer)
    }
}
