//! The texels of a lookup: wrap modes and filters by the rules of glTF.

use super::{Filter, Wrap};
use rtc_math::Lanes;

/// What decides, with the texture coordinates, which texels a look-up reads.
#[derive(Clone, Copy, PartialEq)]
pub(super) struct TexelLayout {
    /// The index into the sets.
    pub(super) set: usize,
    pub(super) size: [u32; 2],
    pub(super) wrap: [Wrap; 2],
    pub(super) filter: Filter,
}

/// The texels that a look-up reads, and their weights.
#[derive(Clone, Copy)]
pub(super) struct TexelFootprint {
    /// The indices of the upper left, upper right, lower left and lower right texel.
    texels: [usize; 4],
    /// The weights of the right and of the lower texels; `None` to read the first texel alone.
    weights: Option<[f32; 2]>,
}

impl TexelFootprint {
    #[inline]
    pub(super) fn new(layout: &TexelLayout, [u, v]: [f64; 2]) -> Self {
        let ([width, height], wrap) = (layout.size, layout.wrap);
        let is_linear = layout.filter == Filter::Linear;
        let ([left, right], s) = neighbors(u, width, wrap[0], is_linear);
        let ([top, bottom], t) = neighbors(v, height, wrap[1], is_linear);
        let [top, bottom] = [top, bottom].map(|row| row * width as usize);
        Self {
            texels: [top + left, top + right, bottom + left, bottom + right],
            weights: is_linear.then_some([s, t]),
        }
    }

    /// Interpolates bilinearly between the texels read.
    #[inline]
    pub(super) fn blend<T: Copy>(&self, texels: &[T], decoded: impl Fn(T) -> Lanes) -> Lanes {
        let [a, b, c, d] = self.texels;
        let at = |index: usize| decoded(texels[index]);
        let Some([s, t]) = self.weights else {
            return at(a);
        };
        let (a, b, c, d) = (at(a), at(b), at(c), at(d));
        let (top, bottom) = (a + (b - a) * s, c + (d - c) * s);
        top + (bottom - top) * t
    }
}

/// The texels on both sides of a coordinate along an axis of `size` texels, and the interpolation
/// weight of the second; without interpolation, the first is the one that contains the coordinate.
#[inline]
fn neighbors(coordinate: f64, size: u32, wrap: Wrap, is_linear: bool) -> ([usize; 2], f32) {
    let place = within(coordinate, wrap) * f64::from(size);
    let corner = floor(if is_linear { place - 0.5 } else { place });
    let first = whole(corner);
    let texels = [first, first + 1].map(|texel| wrapped(texel, size, wrap));
    (texels, single(place - 0.5 - corner))
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
pub(super) fn single(fraction: f64) -> f32 {
    fraction as f32
}

#[cfg(test)]
mod tests {
    use super::*;

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
}
