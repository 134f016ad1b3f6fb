//! Bounds on the values of a texture within a rectangle of texture coordinates.

use crate::image::Texel;
use crate::valid::{Image, Map, Proof, Texture, Wrap};
use std::ops::Range;

/// A rectangle of texture coordinates, from minimum to maximum.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Area([[f64; 2]; 2]);

/// The margin in texels, for rounding and for the neighbours that filters blend in.
const MARGIN: f64 = 2.0;

/// An area of more repetitions than this counts as the whole image.
const FAR: f64 = 1e6;

impl Area {
    /// The empty area.
    pub(super) const NONE: Self = Self([[f64::INFINITY, f64::NEG_INFINITY]; 2]);

    /// The unit square.
    pub(super) const UNIT: Self = Self([[0.0, 1.0]; 2]);

    /// The bounding rectangle of points.
    pub(super) fn of(places: impl Iterator<Item = [f64; 2]>) -> Self {
        places.fold(Self::NONE, |area, [u, v]| {
            area.around(Self([[u, u], [v, v]]))
        })
    }

    /// The union with another area.
    pub(super) fn around(self, Self(other): Self) -> Self {
        let Self(own) = self;
        Self([0, 1].map(|axis| {
            let ([low, high], [other_low, other_high]) = (own[axis], other[axis]);
            [low.min(other_low), high.max(other_high)]
        }))
    }

    /// The bounds of the area after an affine map with the rows `(a, b, c)` for `a·u + b·v + c`.
    fn mapped(self, rows: &[[f64; 3]; 2]) -> Self {
        let Self([[u0, u1], [v0, v1]]) = self;
        let corners = [[u0, v0], [u1, v0], [u0, v1], [u1, v1]];
        let place = |[u, v]: [f64; 2]| rows.map(|[a, b, c]| a * u + b * v + c);
        Self::of(corners.into_iter().map(place))
    }
}

/// The least and the largest that a map shows on an area, channel by channel (red, green, blue,
/// alpha), bytes in units of 255, colours as they are stored; what filtering blends lies between.
pub(super) fn show(map: &Map, area: Area, scene: &Proof) -> [[f64; 2]; 4] {
    let area = area.mapped(&map.texture_from_surface);
    match &scene.textures()[map.texture] {
        Texture::Uv => [[0.0, 1.0], [0.0, 0.0], [0.0, 1.0], [1.0, 1.0]],
        Texture::Image(image) => {
            let image = &scene.images()[*image];
            extremes(image, 0..image.width.get(), 0..image.height.get())
        }
        Texture::Sampled(sampled) => {
            let image = &scene.images()[sampled.image];
            let Area([us, vs]) = area;
            let columns = texels(us, image.width.get(), sampled.wrap[0]);
            let rows = texels(vs, image.height.get(), sampled.wrap[1]);
            extremes(image, columns, rows)
        }
    }
}

/// Whether a map is constant.
pub(super) fn is_even(map: &Map, scene: &Proof) -> bool {
    match &scene.textures()[map.texture] {
        Texture::Uv => false,
        Texture::Image(image) => scene.images()[*image].texels.are_even(),
        Texture::Sampled(sampled) => scene.images()[sampled.image].texels.are_even(),
    }
}

/// The columns or rows that coordinates from `low` to `high` may show; all in doubt.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "clamped to the image"
)]
fn texels([low, high]: [f64; 2], count: u32, wrap: Wrap) -> Range<u32> {
    let size = f64::from(count);
    let is_near = low.abs() < FAR && high.abs() < FAR && low <= high;
    let (low, high) = match wrap {
        _ if !is_near => return 0..count,
        Wrap::Repeat => (low - low.floor(), high - low.floor()),
        Wrap::Mirror | Wrap::Clamp => (low, high),
    };
    let (first, last) = (low * size - MARGIN, high * size + MARGIN);
    if wrap != Wrap::Clamp && (first < 0.0 || last > size) {
        return 0..count;
    }
    // Outside of the unit square, a clamped image repeats its outermost texels.
    let first = first.clamp(0.0, size - 1.0).floor() as u32;
    let last = last.clamp(1.0, size).ceil() as u32;
    first..last.max(first + 1)
}

/// The least and the largest of each channel of a part of an image.
fn extremes(image: &Image, columns: Range<u32>, rows: Range<u32>) -> [[f64; 2]; 4] {
    let mut range = [[f64::INFINITY, f64::NEG_INFINITY]; 4];
    for row in rows {
        for column in columns.clone() {
            let texel = image
                .texels
                .at(row as usize * image.width.get() as usize + column as usize);
            for (channel, value) in range.iter_mut().zip(channels(texel)) {
                *channel = [channel[0].min(value), channel[1].max(value)];
            }
        }
    }
    range
}

fn channels(texel: Texel) -> [f64; 4] {
    let byte = |byte: u8| f64::from(byte) / 255.0;
    match texel {
        Texel::Rgb8([r, g, b]) => [byte(r), byte(g), byte(b), 1.0],
        Texel::Rgba8(channels) => channels.map(byte),
        Texel::Rgb32f([r, g, b]) => [f64::from(r), f64::from(g), f64::from(b), 1.0],
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_area_shows_its_texels_and_their_neighbours() {
        assert_eq!(texels([0.5, 0.5], 64, Wrap::Repeat), 30..34);
        assert_eq!(
            texels([7.5, 7.5], 64, Wrap::Repeat),
            30..34,
            "seven images on"
        );
        assert_eq!(texels([0.5, 1.0], 64, Wrap::Clamp), 30..64);
        assert_eq!(
            texels([3.0, 4.0], 64, Wrap::Clamp),
            63..64,
            "the edge alone"
        );
        assert_eq!(texels([-4.0, -3.0], 64, Wrap::Clamp), 0..1);
    }

    #[test]
    fn what_may_wrap_around_shows_all() {
        assert_eq!(texels([0.0, 0.5], 64, Wrap::Repeat), 0..64);
        assert_eq!(texels([0.5, 1.5], 64, Wrap::Repeat), 0..64);
        assert_eq!(texels([1.4, 1.5], 64, Wrap::Mirror), 0..64);
        assert_eq!(texels([1e7, 1e7], 64, Wrap::Clamp), 0..64);
        let Area([none, _]) = Area::NONE;
        assert_eq!(texels(none, 64, Wrap::Clamp), 0..64, "no place known");
    }

    #[test]
    fn an_affine_map_turns_and_moves_an_area() {
        let turned = Area::UNIT.mapped(&[[0.0, 2.0, 1.0], [-1.0, 0.0, 0.0]]);
        assert_eq!(turned, Area([[1.0, 3.0], [-1.0, 0.0]]));
    }
}
