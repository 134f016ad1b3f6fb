//! Environment maps of pbrt-v4: squares on which equal areas are equal solid angles (Clarberg 2008,
//! "Fast equal-area mapping of the (hemi)sphere using SIMD").

use crate::picture::environment_at;
use rtc_image::{EncodeError, FileFormat, Image as Radiances, Picture};
use rtc_ir::Image;
use rtc_math::{Vec3, acos, atan2, cos, sin};
use std::f64::consts::{FRAC_PI_4, PI, TAU};

/// The most rows of a map of longitude and latitude whose square has twice as many.
const FEW_ROWS: u32 = 1024;
/// The samples along each side of a texel.
const SAMPLES: u32 = 2;

/// The side of the square for a map, in pixels.
fn side(image: &Image) -> u32 {
    match image.height <= FEW_ROWS {
        true => 2 * image.height,
        false => image.height,
    }
}

/// Bytes of memory that the square takes.
pub(super) fn cost(image: &Image) -> u64 {
    let side = u64::from(side(image));
    side * side * 96
}

/// A map of longitude and latitude, times a factor, as a square (EXR).
pub(super) fn encode(image: &Image, factor: [f64; 3]) -> Result<Vec<u8>, EncodeError> {
    let side = side(image);
    let texel = |x: u32, y: u32| {
        let at = |texel: u32, sample: u32| {
            let inside = (f64::from(sample) + 0.5) / f64::from(SAMPLES);
            (f64::from(texel) + inside) / f64::from(side)
        };
        let samples = (0..SAMPLES).flat_map(|i| (0..SAMPLES).map(move |j| (i, j)));
        let radiances = samples.map(|(i, j)| {
            let Vec3 { x, y, z } = direction([at(x, i), at(y, j)]);
            // The light's +y, +z and −x are right, up and ahead of the map.
            let u = 0.5 + atan2(y, -x) / TAU;
            environment_at(image, [u, acos(z.clamp(-1.0, 1.0)) / PI])
        });
        let sum: Vec3 = radiances.sum();
        (sum * Vec3::from_array(factor) / f64::from(SAMPLES * SAMPLES)).to_array()
    };
    let places = (0..side).flat_map(|y| (0..side).map(move |x| (x, y)));
    let picture = Picture::opaque(Radiances {
        width: side,
        height: side,
        pixels: places.map(|(x, y)| texel(x, y)).collect(),
    });
    picture.encode(FileFormat::Exr)
}

/// The direction of a point of the unit square (pbrt's `EqualAreaSquareToSphere`).
fn direction([x, y]: [f64; 2]) -> Vec3 {
    let [u, v] = [2.0 * x - 1.0, 2.0 * y - 1.0];
    let [along_u, along_v] = [u.abs(), v.abs()];
    let signed_distance = 1.0 - (along_u + along_v);
    let radius = 1.0 - signed_distance.abs();
    let phi = match radius > 0.0 {
        true => ((along_v - along_u) / radius + 1.0) * FRAC_PI_4,
        false => FRAC_PI_4,
    };
    let ring = radius * (2.0 - radius * radius).max(0.0).sqrt();
    Vec3::new(
        cos(phi).copysign(u) * ring,
        sin(phi).copysign(v) * ring,
        (1.0 - radius * radius).copysign(signed_distance),
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_axes_are_in_the_middle_and_on_the_edges_of_the_square() {
        let near = |place, known: Vec3| {
            let found = direction(place);
            assert!(found.distance(known) < 1e-12, "{found} {known}");
        };
        near([0.5, 0.5], Vec3::Z);
        near([1.0, 0.5], Vec3::X);
        near([0.5, 1.0], Vec3::Y);
        near([0.0, 0.5], Vec3::NEG_X);
        near([1.0, 1.0], Vec3::NEG_Z);
    }

    #[test]
    fn equal_areas_are_equal_solid_angles() {
        // The mean of z² over the sphere is a third, that of z is none.
        let count = 64_u32;
        let place = |k: u32| (f64::from(k) + 0.5) / f64::from(count);
        let places = (0..count).flat_map(|y| (0..count).map(move |x| [place(x), place(y)]));
        let heights: Vec<f64> = places.map(|place| direction(place).z).collect();
        let number = f64::from(count * count);
        let mean = heights.iter().sum::<f64>() / number;
        let square = heights.iter().map(|z| z * z).sum::<f64>() / number;
        assert!(
            mean.abs() < 1e-12 && (square - 1.0 / 3.0).abs() < 1e-3,
            "{mean} {square}"
        );
    }
}
