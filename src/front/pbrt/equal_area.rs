//! Environment maps of version 4: squares on which equal areas are equal solid angles (Clarberg
//! 2008, "Fast equal-area mapping of the (hemi)sphere using SIMD").

use rtc_ir::Image;
use rtc_math::{Vec3, atan2, sin_cos};
use std::f64::consts::{FRAC_PI_2, PI, TAU};

/// The point of the unit square that represents a direction.
fn square(direction: Vec3) -> [f64; 2] {
    let Vec3 { x, y, z } = direction;
    let [ax, ay, az] = [x.abs(), y.abs(), z.abs()];
    let radius = (1.0 - az).max(0.0).sqrt();
    // The azimuth within the first quadrant, from 0 to 1.
    let phi = atan2(ay, ax) / FRAC_PI_2;
    let (mut v, mut u) = (phi * radius, radius - phi * radius);
    if z < 0.0 {
        (u, v) = (1.0 - v, 1.0 - u);
    }
    let signed = |value: f64, sign: f64| value.copysign(sign);
    [(signed(u, x) + 1.0) / 2.0, (signed(v, y) + 1.0) / 2.0]
}

/// The picture of longitude and latitude of one of equal areas. Its pole is +z of the light, its
/// middle −x, and y is mirrored if `is_mirrored` says so.
pub(super) fn to_equirectangular(image: &Image, is_mirrored: bool) -> Image {
    let side = image.width;
    let (width, height) = (2 * side, side);
    let mut pixels = Vec::with_capacity(12 * width as usize * height as usize);
    for row in 0..height {
        let (sin_theta, cos_theta) = sin_cos((f64::from(row) + 0.5) / f64::from(height) * PI);
        for column in 0..width {
            // The longitude from −z of the picture, which is −x of the light, towards its +x, which
            // is +y of the light.
            let turn = ((f64::from(column) + 0.5) / f64::from(width) - 0.5) * TAU;
            let (sin_turn, cos_turn) = sin_cos(turn);
            let y = sin_theta * sin_turn;
            let y = if is_mirrored { -y } else { y };
            let x = -sin_theta * cos_turn;
            let [u, v] = square(Vec3::new(x, y, cos_theta));
            for channel in looked_up(image, u, v) {
                pixels.extend(channel.to_le_bytes());
            }
        }
    }
    Image {
        name: image.name.clone(),
        width,
        height,
        kind: image.kind,
        pixels: pixels.into(),
    }
}

/// The bilinear value of a square picture of 32-bit floats; its edges are joined as those of an
/// octahedron.
fn looked_up(image: &Image, u: f64, v: f64) -> [f32; 3] {
    let side = i64::from(image.width);
    let (x, y) = (
        u * f64::from(image.width) - 0.5,
        v * f64::from(image.width) - 0.5,
    );
    let (left, top) = (x.floor(), y.floor());
    let (dx, dy) = (x - left, y - top);
    #[expect(clippy::cast_possible_truncation, reason = "texels within the image")]
    let (left, top) = (left as i64, top as i64);
    let mut sum = [0.0; 3];
    for (ox, wx) in [(0, 1.0 - dx), (1, dx)] {
        for (oy, wy) in [(0, 1.0 - dy), (1, dy)] {
            let texel = texel(image, joined(left + ox, top + oy, side));
            for (sum, channel) in sum.iter_mut().zip(texel) {
                *sum += f64::from(channel) * wx * wy;
            }
        }
    }
    #[expect(
        clippy::cast_possible_truncation,
        reason = "the precision of the picture"
    )]
    sum.map(|channel| channel as f32)
}

/// The texel at which one beyond an edge is found.
fn joined(mut x: i64, mut y: i64, side: i64) -> [i64; 2] {
    if x < 0 || x >= side {
        x = if x < 0 { -1 - x } else { 2 * side - 1 - x };
        y = side - 1 - y;
    }
    if y < 0 || y >= side {
        y = if y < 0 { -1 - y } else { 2 * side - 1 - y };
        x = side - 1 - x;
    }
    [x.clamp(0, side - 1), y.clamp(0, side - 1)]
}

fn texel(image: &Image, [x, y]: [i64; 2]) -> [f32; 3] {
    let at = usize::try_from(y * i64::from(image.width) + x).unwrap_or(0);
    let bytes = image.pixels.get(12 * at..12 * at + 12).unwrap_or(&[0; 12]);
    let channels = bytes.as_chunks::<4>().0;
    std::array::from_fn(|channel| {
        channels
            .get(channel)
            .map_or(0.0, |b| f32::from_le_bytes(*b))
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use rtc_ir::Pixels;

    #[test]
    fn the_axes_lie_in_the_middle_and_on_the_diagonals_of_the_square() {
        let near = |direction, [u, v]: [f64; 2]| {
            let [x, y] = square(direction);
            assert!((x - u).abs() < 1e-12 && (y - v).abs() < 1e-12, "{x} {y}");
        };
        near(Vec3::Z, [0.5, 0.5]);
        near(Vec3::X, [1.0, 0.5]);
        near(Vec3::Y, [0.5, 1.0]);
        near(Vec3::NEG_X, [0.0, 0.5]);
        near(Vec3::NEG_Z, [1.0, 1.0]);
    }

    #[test]
    fn a_picture_of_one_colour_stays_so() {
        let texel: Vec<u8> = [0.5_f32, 1.0, 2.0]
            .iter()
            .flat_map(|c| c.to_le_bytes())
            .collect();
        let image = Image {
            name: String::new(),
            width: 4,
            height: 4,
            kind: Pixels::Rgb32f,
            pixels: texel.repeat(16).into(),
        };
        let made = to_equirectangular(&image, false);
        assert_eq!((made.width, made.height), (8, 4));
        assert_eq!(made.pixels[..], texel.repeat(32));
    }
}
