//! Texels: the pixels of a picture that is looked up, as bytes that are shared with its scene.

use rtc_math::{SharedList, Vec3};

/// Texels in rows from the top.
#[derive(Clone, Debug)]
pub enum Texels {
    /// Three bytes each: red, green, blue.
    Rgb8(SharedList<u8>),
    /// Four bytes each: red, green, blue, alpha.
    Rgba8(SharedList<u8>),
    /// Three little-endian 32-bit floats each: red, green, blue, linear.
    Rgb32f(SharedList<u8>),
}

/// One of them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Texel {
    /// Red, green, blue.
    Rgb8([u8; 3]),
    /// Red, green, blue, alpha.
    Rgba8([u8; 4]),
    /// Red, green, blue, linear.
    Rgb32f([f32; 3]),
}

impl Texels {
    /// The texel of an index.
    #[must_use]
    #[inline]
    pub fn at(&self, index: usize) -> Texel {
        match self {
            Self::Rgb8(bytes) => Texel::Rgb8(bytes.as_chunks().0[index]),
            Self::Rgba8(bytes) => Texel::Rgba8(bytes.as_chunks().0[index]),
            Self::Rgb32f(bytes) => {
                let [r, g, b] = bytes.as_chunks().0.as_chunks().0[index];
                Texel::Rgb32f([r, g, b].map(f32::from_le_bytes))
            }
        }
    }

    /// Whether all are equal.
    #[must_use]
    pub fn are_even(&self) -> bool {
        let (bytes, size) = match self {
            Self::Rgb8(bytes) => (bytes, 3),
            Self::Rgba8(bytes) => (bytes, 4),
            Self::Rgb32f(bytes) => (bytes, 12),
        };
        let mut texels = bytes.chunks_exact(size);
        let first = texels.next();
        texels.all(|texel| Some(texel) == first)
    }

    /// Whether none is negative or not finite.
    #[must_use]
    pub fn are_light(&self) -> bool {
        let is_light = |channel: &[u8; 4]| (0.0..=f32::MAX).contains(&f32::from_le_bytes(*channel));
        match self {
            Self::Rgb8(_) | Self::Rgba8(_) => true,
            Self::Rgb32f(bytes) => bytes.as_chunks().0.iter().all(is_light),
        }
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
