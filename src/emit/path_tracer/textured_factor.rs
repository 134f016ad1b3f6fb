//! The values of materials that textures may vary: a factor, times a channel of a texture.

use crate::picture::ColorCoding;
use rtc_ir::{Map, Standard};

/// A value of a material: a factor, times a texture if there is one.
#[derive(Clone, Copy)]
pub(crate) struct TexturedFactor<'m> {
    pub(crate) factor: [f64; 3],
    pub(crate) map: Option<&'m Map>,
    pub(crate) channel: TextureChannel,
}

/// What is taken of a texture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum TextureChannel {
    /// Its colour.
    Color,
    /// The colours of the corners of the mesh, which hold the factor already.
    Corners,
    /// The opacity of the corners of the mesh, which holds the factor already.
    CornerOpacity,
    Red,
    Green,
    /// Green, squared after the factor: the width of the distribution of a roughness.
    GreenSquared,
    Blue,
    Alpha,
    /// 1 where alpha is at least this, else 0.
    AlphaCut(f64),
    /// 1 where red is at least this, else 0.
    RedCut(f64),
    /// A direction, of whose red and green this much counts.
    Normal(f64),
}

impl<'m> TexturedFactor<'m> {
    /// The base colour of a material.
    pub(crate) fn color(material: &'m Standard, has_colors: bool) -> Self {
        let [r, g, b, _] = material.base_color;
        let map = material.base_color_map.as_ref();
        Self {
            factor: [r, g, b],
            map,
            channel: match has_colors && map.is_none() {
                true => TextureChannel::Corners,
                false => TextureChannel::Color,
            },
        }
    }

    /// The normal of a material that has a map of them.
    pub(crate) fn normal(material: &'m Standard) -> Option<Self> {
        let map = material.normal_map.as_ref()?;
        Some(Self {
            factor: [1.0; 3],
            map: Some(map),
            channel: TextureChannel::Normal(material.normal_scale),
        })
    }

    /// The heights of a material, without their scale.
    pub(crate) fn heights(material: &'m Standard) -> Option<Self> {
        let map = material.bump_map.as_ref()?;
        Some(Self {
            factor: [1.0; 3],
            map: Some(map),
            channel: TextureChannel::Red,
        })
    }

    /// The value without a texture, of a channel that is a number.
    pub(crate) fn number(&self) -> f64 {
        let [value, ..] = self.channel.pixel(self.factor, [1.0; 4]);
        value
    }
}

impl TextureChannel {
    pub(crate) fn coding(self) -> ColorCoding {
        let is_color = matches!(self, Self::Color | Self::Corners);
        if is_color {
            ColorCoding::Srgb
        } else {
            ColorCoding::Linear
        }
    }

    /// A texel as a pixel of the bitmap.
    pub(crate) fn pixel(self, factor: [f64; 3], [r, g, b, a]: [f64; 4]) -> [f64; 3] {
        match self {
            Self::Color | Self::Corners => [r * factor[0], g * factor[1], b * factor[2]],
            Self::Red => [r * factor[0]; 3],
            Self::Green => [g * factor[0]; 3],
            Self::GreenSquared => [g * factor[0] * g * factor[0]; 3],
            Self::Blue => [b * factor[0]; 3],
            Self::Alpha | Self::CornerOpacity => [a * factor[0]; 3],
            Self::AlphaCut(cutoff) => [f64::from(u8::from(a * factor[0] >= cutoff)); 3],
            Self::RedCut(cutoff) => [f64::from(u8::from(r * factor[0] >= cutoff)); 3],
            Self::Normal(scale) => {
                let part = |value: f64| (value * 2.0 - 1.0) * scale / 2.0 + 0.5;
                [part(r), part(g), b]
            }
        }
    }
}
