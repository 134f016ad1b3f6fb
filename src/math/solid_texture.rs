//! Procedural textures: patterns in space, in closed form (Perlin, "An image synthesizer",
//! SIGGRAPH 1985; Peachey, "Solid texturing of complex surfaces", SIGGRAPH 1985).

use crate::{Positive, Vec3, fraction, mix};
use arbitrary::Arbitrary;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The pattern of a procedural texture: a number in [0, 1] at each point of space.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema, Arbitrary)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
pub enum TexturePattern {
    /// Cubes of side 1, 0 and 1 in turn along each axis.
    Checker,
    /// Slabs of thickness 1 across the first axis, 0 and 1 in turn.
    Stripes,
    /// Gradient noise (Perlin, "Improving noise", SIGGRAPH 2002) around 0.5.
    Noise(GradientNoise),
    /// The distance to the nearest of the random points, of which each unit cube has one, at most 1
    /// (Worley, "A cellular texture basis function", SIGGRAPH 1996).
    Worley {
        /// Another number gives other points.
        seed: u32,
    },
}

/// The parameters of gradient noise.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema, Arbitrary)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
pub struct GradientNoise {
    /// Another number gives other gradients.
    pub seed: u32,
    /// The number of octaves, 1 to 16; each has twice the frequency and half the weight of the one
    /// before.
    #[schemars(range(min = 1, max = 16))]
    pub octaves: u32,
}

impl GradientNoise {
    /// The largest number of octaves.
    pub const MAX_OCTAVES: u32 = 16;
}

/// The coordinates at which a procedural texture is evaluated.
#[derive(
    Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema, Arbitrary,
)]
#[serde(rename_all = "camelCase")]
pub enum TextureMapping {
    /// The texture coordinates (u, v, 0) of the surface.
    #[default]
    Uv,
    /// The point in world coordinates.
    World,
}

/// A pattern with its size, its coordinates and its two colours.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SolidTexture {
    /// The pattern.
    pub pattern: TexturePattern,
    /// The colours where the pattern is 0 and 1, linear RGB; blended between.
    pub colors: [Vec3; 2],
    /// The number of cells of the pattern per unit of its coordinates.
    pub scale: Positive,
    /// The coordinates of the pattern.
    pub mapping: TextureMapping,
}

/// The borders of cells lie by this fraction of a cell below integers, so that a surface on a
/// border, such as a floor at y = 0, lies in one cell in spite of rounding.
const BORDER: f64 = 1e-6;

impl SolidTexture {
    /// The colour at a point of the pattern's coordinates.
    #[must_use]
    pub fn color(&self, point: Vec3) -> Vec3 {
        self.blended(self.pattern.value(point * self.scale.get()))
    }

    /// The colour at a point of a surface: by its texture coordinates, or by its world coordinates.
    /// `None` without the texture coordinates that the pattern needs.
    #[must_use]
    pub fn color_at(&self, uv: Option<[f64; 2]>, point: Vec3) -> Option<Vec3> {
        match self.mapping {
            TextureMapping::Uv => uv.map(|[u, v]| self.color(Vec3::new(u, v, 0.0))),
            TextureMapping::World => Some(self.color(point)),
        }
    }

    /// The mean of the colours.
    #[must_use]
    pub fn mean(&self) -> Vec3 {
        self.blended(0.5)
    }

    fn blended(&self, value: f64) -> Vec3 {
        let [a, b] = self.colors;
        a + (b - a) * value
    }
}

impl TexturePattern {
    /// The value at a point, in [0, 1].
    #[must_use]
    pub fn value(&self, point: Vec3) -> f64 {
        let cell = |x: f64| (x + BORDER).floor();
        match *self {
            Self::Checker => parity(cell(point.x)) ^ parity(cell(point.y)) ^ parity(cell(point.z)),
            Self::Stripes => parity(cell(point.x)),
            Self::Noise(noise) => return (0.5 + 0.5 * octaves(noise, point)).clamp(0.0, 1.0),
            Self::Worley { seed } => return nearest_distance(seed, point),
        }
        .into()
    }
}

/// 1 for odd whole numbers, 0 for even ones.
fn parity(whole: f64) -> u8 {
    u8::from(whole.rem_euclid(2.0) >= 1.0)
}

/// The sum of the octaves, with weights of sum 1.
fn octaves(GradientNoise { seed, octaves }: GradientNoise, point: Vec3) -> f64 {
    let (mut sum, mut weights) = (0.0, 0.0);
    let (mut frequency, mut weight) = (1.0, 1.0);
    for octave in 0..octaves {
        sum += weight * gradient_noise(seed.wrapping_add(octave), point * frequency);
        weights += weight;
        (frequency, weight) = (2.0 * frequency, 0.5 * weight);
    }
    sum / weights
}

/// Gradient noise about 0: 0 at each corner of the lattice, between −1.04 and 1.04.
fn gradient_noise(seed: u32, point: Vec3) -> f64 {
    let (corner, offset) = (point.floor(), point - point.floor());
    let [s, t, r] = offset.to_array().map(fade);
    let value = |steps: [f64; 3]| {
        let step = Vec3::from_array(steps);
        gradient(lattice_hash(seed, corner + step)).dot(offset - step)
    };
    let along_x = |y: f64, z: f64| mixed(value([0.0, y, z]), value([1.0, y, z]), s);
    let along_y = |z: f64| mixed(along_x(0.0, z), along_x(1.0, z), t);
    mixed(along_y(0.0), along_y(1.0), r)
}

/// 6t⁵ − 15t⁴ + 10t³, whose first and second derivatives are 0 at 0 and 1.
fn fade(t: f64) -> f64 {
    t * t * t * (t * (t * 6.0 - 15.0) + 10.0)
}

fn mixed(a: f64, b: f64, share: f64) -> f64 {
    a + (b - a) * share
}

/// One of the twelve directions from the centre of a cube to the middles of its edges; four of them
/// twice, as in the paper.
fn gradient(hash: u64) -> Vec3 {
    let [first, second] = [1, 2].map(|bit| if hash & bit == 0 { 1.0 } else { -1.0 });
    match (hash >> 2) & 3 {
        0 => Vec3::new(first, second, 0.0),
        1 => Vec3::new(first, 0.0, second),
        2 => Vec3::new(0.0, first, second),
        _ if hash & 16 == 0 => Vec3::new(first, second, 0.0),
        _ => Vec3::new(0.0, first, second),
    }
}

/// The distance to the nearest feature point, at most 1. Points further than a cell off are further
/// than 1.
fn nearest_distance(seed: u32, point: Vec3) -> f64 {
    let corner = point.floor();
    let steps = [-1.0, 0.0, 1.0];
    let mut nearest = 1.0_f64;
    for x in steps {
        for y in steps {
            for z in steps {
                let cell = corner + Vec3::new(x, y, z);
                let hash = lattice_hash(seed, cell);
                let feature = Vec3::from_array([1, 2, 3].map(|k: u64| fraction(mix(hash ^ k))));
                nearest = nearest.min((cell + feature).distance_squared(point));
            }
        }
    }
    nearest.sqrt()
}

/// Bits that look random, for a corner of the lattice.
#[expect(
    clippy::cast_possible_truncation,
    reason = "coordinates beyond 64 bits are clamped to one cell"
)]
fn lattice_hash(seed: u32, corner: Vec3) -> u64 {
    let [x, y, z] = corner.to_array().map(|coordinate| coordinate as i64);
    [x, y, z].iter().fold(mix(seed.into()), |hash, axis| {
        mix(hash ^ axis.cast_unsigned())
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    const NOISE: TexturePattern = TexturePattern::Noise(GradientNoise {
        seed: 7,
        octaves: 1,
    });

    fn points() -> impl Iterator<Item = Vec3> {
        (0..2_000_u64).map(|k| {
            let axis = |salt: u64| 40.0 * fraction(mix(mix(k) ^ salt)) - 20.0;
            Vec3::new(axis(1), axis(2), axis(3))
        })
    }

    #[test]
    fn checks_alternate_along_each_axis_and_stripes_along_the_first() {
        for point in points() {
            let [value, stripe] =
                [TexturePattern::Checker, TexturePattern::Stripes].map(|p| p.value(point));
            for (axis, crosses) in [(Vec3::X, true), (Vec3::Y, false), (Vec3::Z, false)] {
                let next = point + axis;
                assert_eq!(TexturePattern::Checker.value(next), 1.0 - value);
                let expected = if crosses { 1.0 - stripe } else { stripe };
                assert_eq!(TexturePattern::Stripes.value(next), expected);
            }
        }
    }

    #[test]
    fn a_surface_on_a_border_lies_in_one_cell() {
        for y in [-1e-12, 0.0, 1e-12] {
            let point = Vec3::new(0.5, 3.0 + y, 0.5);
            assert_eq!(TexturePattern::Checker.value(point), 1.0, "{y}");
        }
    }

    #[test]
    fn noise_is_a_half_at_the_corners_of_the_lattice_and_smooth() {
        for point in points() {
            assert_eq!(NOISE.value(point.floor()), 0.5);
            let step = Vec3::splat(1e-6);
            let difference = NOISE.value(point + step) - NOISE.value(point);
            assert!(difference.abs() < 1e-5, "{point}: {difference}");
        }
    }

    #[test]
    fn values_stay_within_the_unit_interval_and_use_most_of_it() {
        let smooth = |octaves| TexturePattern::Noise(GradientNoise { seed: 1, octaves });
        let worley = TexturePattern::Worley { seed: 1 };
        for (pattern, reached) in [(smooth(1), 0.6), (smooth(5), 0.4), (worley, 0.6)] {
            let values = points().map(|point| pattern.value(point));
            let [low, high] = values.fold([1.0_f64, 0.0_f64], |[low, high], value| {
                assert!((0.0..=1.0).contains(&value), "{pattern:?} {value}");
                [low.min(value), high.max(value)]
            });
            assert!(high - low > reached, "{pattern:?}: {low} to {high}");
        }
    }

    #[test]
    fn the_mean_of_noise_is_a_half() {
        let mean = points().map(|point| NOISE.value(point)).sum::<f64>() / 2_000.0;
        assert!((mean - 0.5).abs() < 0.01, "{mean}");
    }

    #[test]
    fn another_seed_is_another_pattern() {
        let point = Vec3::new(0.3, 0.7, 0.2);
        let noise = |seed| TexturePattern::Noise(GradientNoise { seed, octaves: 2 }).value(point);
        let worley = |seed| TexturePattern::Worley { seed }.value(point);
        assert_ne!(noise(1), noise(2));
        assert_ne!(worley(1), worley(2));
    }

    #[test]
    fn the_colour_is_blended_between_the_two() {
        let texture = SolidTexture {
            pattern: TexturePattern::Checker,
            colors: [Vec3::X, Vec3::Y],
            scale: Positive::new(4.0).unwrap(),
            mapping: TextureMapping::World,
        };
        assert_eq!(texture.color(Vec3::splat(0.1)), Vec3::X);
        assert_eq!(texture.color(Vec3::new(0.3, 0.1, 0.1)), Vec3::Y);
        assert_eq!(texture.mean(), Vec3::new(0.5, 0.5, 0.0));
    }
}
