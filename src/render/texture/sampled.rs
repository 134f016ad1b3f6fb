//! Texture sampling by the rules of glTF: wrap modes, filters and colour spaces.

use super::{Filter, Image, Texture, Wrap};
use crate::color::srgb_decoded;
use crate::image::Texel;
use crate::math::Lanes;
use std::sync::LazyLock;

/// The colour space of a texture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::render) enum ColorSpace {
    /// Colours; bytes are encoded with sRGB.
    Srgb,
    /// Numbers, without an encoding.
    Linear,
}

/// The two sets of texture coordinates at a point; `None` for a missing set.
pub(in crate::render) type UvSets = [Option<[f64; 2]>; 2];

/// A texture in a glTF material: its texture coordinates and its colour space.
#[derive(Clone, Debug)]
pub(in crate::render) struct Map {
    pub(in crate::render) texture: Texture,
    /// The index into [`UvSets`].
    pub(in crate::render) set: usize,
    /// The rows of the affine map from the surface's coordinates to the texture's; `None` for the
    /// identity.
    pub(in crate::render) texture_from_surface: Option<[[f64; 3]; 2]>,
    pub(in crate::render) color_space: ColorSpace,
}

impl Map {
    /// Looks the texture up: red, green, blue and alpha, in [0, 1] except for float images. `None`
    /// without texture coordinates.
    pub(in crate::render) fn look_up(&self, uvs: &UvSets) -> Option<[f64; 4]> {
        let [u, v] = uvs[self.set]?;
        let uv = match self.texture_from_surface {
            None => [u, v],
            Some([[a, b, c], [d, e, f]]) => [a * u + b * v + c, d * u + e * v + f],
        };
        let value = match &self.texture {
            Texture::Uv => [uv[0].clamp(0.0, 1.0), 0.0, uv[1].clamp(0.0, 1.0), 1.0],
            // In the course, v grows upwards.
            Texture::Image(image) => {
                let uv = [uv[0], 1.0 - uv[1]];
                sample(
                    image,
                    uv,
                    [Wrap::Repeat; 2],
                    Filter::Linear,
                    self.color_space,
                )
            }
            Texture::Sampled {
                image,
                wrap,
                filter,
            } => sample(image, uv, *wrap, *filter, self.color_space),
        };
        Some(value)
    }
}

/// Samples an image: v = 0 is its top edge, texel centers lie half a texel inside.
pub(in crate::render) fn sample(
    image: &Image,
    uv: [f64; 2],
    wrap: [Wrap; 2],
    filter: Filter,
    color_space: ColorSpace,
) -> [f64; 4] {
    let uvs = |axis: usize, size: u32| {
        let place = within(uv[axis], wrap[axis]) * f64::from(size);
        let corner = floor(if filter == Filter::Nearest {
            place
        } else {
            place - 0.5
        });
        let first = whole(corner);
        (
            wrapped(first, size, wrap[axis]),
            wrapped(first + 1, size, wrap[axis]),
            single(place - 0.5 - corner),
        )
    };
    let (left, right, s) = uvs(0, image.width);
    let (top, bottom, t) = uvs(1, image.height);
    let at = |column: usize, row: usize| decoded(image.texel(column, row), color_space);
    let value = if filter == Filter::Nearest {
        at(left, top)
    } else {
        let (a, b, c, d) = (
            at(left, top),
            at(right, top),
            at(left, bottom),
            at(right, bottom),
        );
        let (top, bottom) = (a + (b - a) * s, c + (d - c) * s);
        top + (bottom - top) * t
    };
    value.as_dvec4().to_array()
}

/// Wraps a coordinate to the unit interval, or to [0, 2] for mirrored repetition.
fn within(coordinate: f64, wrap: Wrap) -> f64 {
    match wrap {
        Wrap::Repeat => coordinate - floor(coordinate),
        Wrap::Mirror => coordinate - 2.0 * floor(coordinate * 0.5),
        Wrap::Clamp => coordinate.clamp(-1.0, 2.0),
    }
}

/// Wraps the index of a texel next to a coordinate from [`within`].
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "brought into the image"
)]
fn wrapped(texel: i64, count: u32, wrap: Wrap) -> usize {
    let count = i64::from(count);
    let inside = match wrap {
        Wrap::Repeat if texel < 0 => texel + count,
        Wrap::Repeat if texel >= count => texel - count,
        Wrap::Mirror if texel >= count => 2 * count - 1 - texel,
        Wrap::Repeat | Wrap::Mirror | Wrap::Clamp => texel,
    };
    inside.clamp(0, count - 1) as usize
}

/// The largest integer not above a number, without a call where the machine has no instruction for
/// it.
#[inline]
fn floor(x: f64) -> f64 {
    /// 2⁵², from which on all numbers are integers.
    const INTEGERS: f64 = 4_503_599_627_370_496.0;
    if x.abs() >= INTEGERS {
        return x;
    }
    let towards_zero = whole(x) as f64;
    if towards_zero > x {
        towards_zero - 1.0
    } else {
        towards_zero
    }
}

#[expect(
    clippy::cast_possible_truncation,
    reason = "columns, of which an image has at most 2³², or a number below 2⁵²"
)]
fn whole(place: f64) -> i64 {
    place as i64
}

#[expect(
    clippy::cast_possible_truncation,
    reason = "a share, of which 24 bits are enough"
)]
fn single(fraction: f64) -> f32 {
    fraction as f32
}

/// Red, green, blue and alpha.
#[inline]
fn decoded(texel: Texel, color_space: ColorSpace) -> Lanes {
    let ([r, g, b], alpha) = match texel {
        Texel::Rgb8(color) => (color, 255),
        Texel::Rgba8([r, g, b, a]) => ([r, g, b], a),
        Texel::Rgb32f([r, g, b]) => return Lanes::new(r, g, b, 1.0),
    };
    let alpha = f32::from(alpha) / 255.0;
    match color_space {
        ColorSpace::Srgb => {
            let decoded: &[f32; 256] = &DECODED;
            Lanes::new(
                decoded[usize::from(r)],
                decoded[usize::from(g)],
                decoded[usize::from(b)],
                alpha,
            )
        }
        ColorSpace::Linear => {
            (Lanes::new(f32::from(r), f32::from(g), f32::from(b), 0.0) / 255.0).with_w(alpha)
        }
    }
}

/// The linear value of each byte of sRGB.
static DECODED: LazyLock<[f32; 256]> =
    LazyLock::new(|| std::array::from_fn(|byte| single(srgb_decoded(byte as f64 / 255.0))));

#[cfg(test)]
mod tests {
    use super::*;
    use crate::image::Texels;

    #[test]
    fn the_floor_is_that_of_std() {
        for x in [
            0.0,
            0.5,
            1.0,
            -0.25,
            -1.0,
            -1.5,
            4_503_599_627_370_495.5,
            -4_503_599_627_370_495.5,
            1e60,
            -1e60,
        ] {
            assert_eq!(floor(x), x.floor(), "{x}");
        }
    }

    fn row() -> Image {
        Image {
            width: 2,
            height: 1,
            texels: Texels::Rgb8(vec![255, 0, 0, 0, 255, 0].into()),
        }
    }

    fn red(u: f64, wrap: Wrap, filter: Filter) -> f64 {
        sample(&row(), [u, 0.5], [wrap; 2], filter, ColorSpace::Linear)[0]
    }

    #[test]
    fn texels_have_their_middles_inside() {
        assert_eq!(red(0.25, Wrap::Repeat, Filter::Linear), 1.0);
        assert_eq!(red(0.75, Wrap::Repeat, Filter::Linear), 0.0);
        assert_eq!(red(0.5, Wrap::Repeat, Filter::Linear), 0.5);
        assert_eq!(red(0.49, Wrap::Repeat, Filter::Nearest), 1.0);
        assert_eq!(red(0.51, Wrap::Repeat, Filter::Nearest), 0.0);
    }

    #[test]
    fn what_lies_beyond_is_repeated_mirrored_or_the_edge() {
        for (wrap, before, after, far) in [
            (Wrap::Repeat, 0.5, 0.5, 0.0),
            (Wrap::Mirror, 1.0, 0.0, 0.0),
            (Wrap::Clamp, 1.0, 0.0, 0.0),
        ] {
            assert_eq!(red(0.0, wrap, Filter::Linear), before, "{wrap:?}");
            assert_eq!(red(1.0, wrap, Filter::Linear), after, "{wrap:?}");
            assert_eq!(
                red(-5.25, wrap, Filter::Linear),
                if wrap == Wrap::Clamp { 1.0 } else { far },
                "{wrap:?}"
            );
        }
    }

    #[test]
    fn only_colours_are_decoded_and_alpha_never_is() {
        let image = Image {
            width: 1,
            height: 1,
            texels: Texels::Rgba8(vec![128; 4].into()),
        };
        let value = |color_space| {
            sample(
                &image,
                [0.5; 2],
                [Wrap::Repeat; 2],
                Filter::Linear,
                color_space,
            )
        };
        let [r, _, _, a] = value(ColorSpace::Srgb);
        assert!((r - 0.215_860_5).abs() < 1e-6 && a == f64::from(128.0_f32 / 255.0));
        assert_eq!(value(ColorSpace::Linear), [f64::from(128.0_f32 / 255.0); 4]);
    }
}
