//! Textures as glTF samples them: wrapping, filtering, and which of them hold colours.

use crate::color::srgb_decoded;
use crate::valid::{Filter, Image, Map, Texels, Texture, ValidScene, Wrap};
use std::sync::LazyLock;

/// What the numbers of a texture are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Content {
    /// Colours, coded by sRGB where they are bytes.
    Color,
    /// Numbers.
    Linear,
}

/// Where on a surface textures are looked up: its two sets of coordinates.
pub(super) type Places = [Option<[f64; 2]>; 2];

/// What a map shows, red, green, blue and alpha in [0, 1], or as they are for float images; `None` without coordinates.
pub(super) fn look_up(scene: &ValidScene, map: &Map, places: &Places, content: Content) -> Option<[f64; 4]> {
    let [u, v] = places[map.set as usize]?;
    let uv = match map.texture_from_surface {
        None => [u, v],
        Some(rows) => rows.map(|[a, b, c]| a * u + b * v + c),
    };
    let value = match &scene.textures()[map.texture.0 as usize] {
        Texture::Uv => [uv[0].clamp(0.0, 1.0), 0.0, uv[1].clamp(0.0, 1.0), 1.0],
        // The course counts v upwards.
        Texture::Image(image) => {
            let image = &scene.images()[*image];
            sample(image, [uv[0], 1.0 - uv[1]], [Wrap::Repeat; 2], Filter::Linear, content)
        }
        Texture::Sampled(sampled) => {
            let image = &scene.images()[sampled.image.0 as usize];
            sample(image, uv, sampled.wrap, sampled.filter, content)
        }
    };
    Some(value)
}

/// The texel or the mean of the four around a place, v = 0 at the top, texel middles half a texel inside.
pub(super) fn sample(image: &Image, uv: [f64; 2], wrap: [Wrap; 2], filter: Filter, content: Content) -> [f64; 4] {
    let size = [image.width, image.height];
    let place = [0, 1].map(|axis| within(uv[axis], wrap[axis]) * f64::from(size[axis]));
    let at = |[x, y]: [i64; 2]| {
        let [column, row] = [wrapped(x, size[0], wrap[0]), wrapped(y, size[1], wrap[1])];
        texel(&image.pixels, row * size[0] as usize + column, content)
    };
    if filter == Filter::Nearest {
        return at(place.map(|place| whole(place.floor())));
    }
    let corner = place.map(|place| (place - 0.5).floor());
    let [x, y] = corner.map(whole);
    let [s, t] = [0, 1].map(|axis| place[axis] - 0.5 - corner[axis]);
    let (a, b, c, d) = (at([x, y]), at([x + 1, y]), at([x, y + 1]), at([x + 1, y + 1]));
    let blend = |k: usize| {
        let (top, bottom) = (a[k] + (b[k] - a[k]) * s, c[k] + (d[k] - c[k]) * s);
        top + (bottom - top) * t
    };
    [blend(0), blend(1), blend(2), blend(3)]
}

/// The coordinate brought near the unit interval, or to [0, 2] where each other image is mirrored.
fn within(coordinate: f64, wrap: Wrap) -> f64 {
    match wrap {
        Wrap::Repeat => coordinate - coordinate.floor(),
        Wrap::Mirror => coordinate - 2.0 * (coordinate * 0.5).floor(),
        Wrap::Clamp => coordinate.clamp(-1.0, 2.0),
    }
}

/// The texel that stands for one beside a place that [`within`] gave.
#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "brought into the image")]
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

#[expect(clippy::cast_possible_truncation, reason = "an image has at most 2³² columns")]
fn whole(place: f64) -> i64 {
    place as i64
}

fn texel(pixels: &Texels, index: usize, content: Content) -> [f64; 4] {
    let byte = |byte: u8| match content {
        Content::Color => decoded()[usize::from(byte)],
        Content::Linear => f64::from(byte) / 255.0,
    };
    match pixels {
        Texels::Rgb8(pixels) => {
            let [r, g, b] = pixels[index].map(byte);
            [r, g, b, 1.0]
        }
        Texels::Rgba8(pixels) => {
            let [r, g, b, a] = pixels[index];
            [byte(r), byte(g), byte(b), f64::from(a) / 255.0]
        }
        Texels::Rgb32f(pixels) => {
            let [r, g, b] = pixels[index].map(f64::from);
            [r, g, b, 1.0]
        }
    }
}

/// The linear value of each byte of sRGB.
fn decoded() -> &'static [f64; 256] {
    static DECODED: LazyLock<[f64; 256]> =
        LazyLock::new(|| std::array::from_fn(|byte| srgb_decoded(byte as f64 / 255.0)));
    &DECODED
}

#[cfg(test)]
mod tests {
    use super::*;

    fn row() -> Image {
        Image { width: 2, height: 1, pixels: Texels::Rgb8(vec![[255, 0, 0], [0, 255, 0]]) }
    }

    fn red(u: f64, wrap: Wrap, filter: Filter) -> f64 {
        sample(&row(), [u, 0.5], [wrap; 2], filter, Content::Linear)[0]
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
        for (wrap, before, after, far) in
            [(Wrap::Repeat, 0.5, 0.5, 0.0), (Wrap::Mirror, 1.0, 0.0, 0.0), (Wrap::Clamp, 1.0, 0.0, 0.0)]
        {
            assert_eq!(red(0.0, wrap, Filter::Linear), before, "{wrap:?}");
            assert_eq!(red(1.0, wrap, Filter::Linear), after, "{wrap:?}");
            assert_eq!(red(-5.25, wrap, Filter::Linear), if wrap == Wrap::Clamp { 1.0 } else { far }, "{wrap:?}");
        }
    }

    #[test]
    fn only_colours_are_decoded_and_alpha_never_is() {
        let image = Image { width: 1, height: 1, pixels: Texels::Rgba8(vec![[128; 4]]) };
        let value = |content| sample(&image, [0.5; 2], [Wrap::Repeat; 2], Filter::Linear, content);
        let [r, _, _, a] = value(Content::Color);
        assert!((r - 0.215_860_5).abs() < 1e-6 && a == 128.0 / 255.0);
        assert_eq!(value(Content::Linear), [128.0 / 255.0; 4]);
    }
}
