//! LDR-FLIP: the perceived difference when one alternates between two pictures (Andersson, Nilsson,
//! Akenine-Möller, Oskarsson, Åström, Fairchild, "FLIP: A Difference Evaluator for Alternating
//! Images", Proceedings of the ACM on Computer Graphics and Interactive Techniques 3(2), HPG 2020):
//! 0 for no difference, 1 for the largest.
//!
//! The steps are those of the paper: both pictures are filtered with contrast sensitivity functions
//! in YCxCz and converted to CIELAB with the Hunt effect; the HyAB distance gives the colour
//! difference; edge and point detectors on the luminance give the feature difference, which
//! amplifies the colour difference. The tests compare with the authors' program, `flip-evaluator`
//! 1.7.
//!
//! Display values are sRGB. Beyond the border, pictures are continued with their border pixels.

mod color;

pub(super) use color::delta_e;
use color::{
    hunt, hyab, linear_to_lab, linear_to_xyz, opponent_to_xyz, to_linear, xyz_to_linear,
    xyz_to_opponent,
};
use rtc_image::Image;
use rtc_math::{Vec3, exp, pow};

/// The pixels per degree of a 0.7 m wide monitor with 3840 pixels at a distance of 0.7 m.
pub const PIXELS_PER_DEGREE: f64 = 67.020_645;

/// The radius of the largest filter at [`PIXELS_PER_DEGREE`], in pixels.
pub(super) const REACH: u32 = 10;

/// The difference of each pixel, row by row; the pictures have the same size.
#[must_use]
pub fn flip(reference: &Image, test: &Image, pixels_per_degree: f64) -> Vec<f64> {
    let vision = VisionFilters::new(pixels_per_degree);
    let (reference, test) = (vision.perceive(reference), vision.perceive(test));
    let largest = pow(
        hyab(hunt(linear_to_lab(Vec3::Y)), hunt(linear_to_lab(Vec3::Z))),
        Q_COLOR,
    );
    let pairs = reference.into_iter().zip(test);
    pairs
        .map(|(reference, test)| difference(&reference, &test, largest))
        .collect()
}

/// The filtered colour and features of a pixel.
struct PixelFeatures {
    /// CIELAB after the contrast sensitivity filter, a and b scaled for the Hunt effect.
    color: Vec3,
    /// The strength of the edge.
    edge: f64,
    /// The strength of the point.
    point: f64,
}

/// The exponent of the perceived colour difference.
const Q_COLOR: f64 = 0.7;

/// The difference of a pixel; `largest` is the colour difference of green and blue.
fn difference(reference: &PixelFeatures, test: &PixelFeatures, largest: f64) -> f64 {
    const Q_FEATURE: f64 = 0.5;
    // Map the colour error: the lower 40 % of its range to 95 % of the scale.
    const KNEE: f64 = 0.4;
    const AT_KNEE: f64 = 0.95;
    let knee = KNEE * largest;
    let color = pow(hyab(reference.color, test.color), Q_COLOR);
    let color = if color < knee {
        AT_KNEE / knee * color
    } else {
        AT_KNEE + (color - knee) / (largest - knee) * (1.0 - AT_KNEE)
    };
    // Combine with the feature difference as an exponent.
    let feature = (reference.edge - test.edge)
        .abs()
        .max((reference.point - test.point).abs());
    let feature = pow(feature / std::f64::consts::SQRT_2, Q_FEATURE);
    pow(color.min(1.0), 1.0 - feature.min(1.0))
}

/// The filters of the visual system at a viewing distance.
struct VisionFilters {
    /// The contrast sensitivity to luminance, red–green and blue–yellow: a sum of separable
    /// Gaussians for each, with their weights.
    sensitivity: [Vec<(f64, Vec<f64>)>; 3],
    feature: FeatureFilter,
}

/// A Gaussian and its derivatives along one axis, as weights from −radius to radius.
struct FeatureFilter {
    smooth: Vec<f64>,
    first: Vec<f64>,
    second: Vec<f64>,
}

impl VisionFilters {
    fn new(pixels_per_degree: f64) -> Self {
        // Weights and widths of the Gaussians, from the paper's table of contrast sensitivity
        // functions.
        let table: [&[(f64, f64)]; 3] = [
            &[(1.0, 0.0047)],
            &[(1.0, 0.0053)],
            &[(34.1, 0.04), (13.5, 0.025)],
        ];
        let widest = (0.04 / (2.0 * std::f64::consts::PI * std::f64::consts::PI)).sqrt();
        let radius = (3.0 * widest * pixels_per_degree).ceil();
        let sensitivity = table.map(|terms| normalized_sum(terms, radius, pixels_per_degree));
        Self {
            sensitivity,
            feature: FeatureFilter::new(pixels_per_degree),
        }
    }

    /// Filters all pixels of a picture.
    fn perceive(&self, image: &Image) -> Vec<PixelFeatures> {
        // Convert to the opponent colour space YCxCz.
        let (width, height) = (image.width as usize, image.height as usize);
        let opponent: Vec<_> = image
            .pixels
            .iter()
            .map(|p| xyz_to_opponent(linear_to_xyz(to_linear(*p))))
            .collect();
        let plane = |channel: usize| {
            let values = opponent.iter().map(|p| p[channel]).collect();
            ColorChannel {
                width,
                height,
                values,
            }
        };
        // Filter with the contrast sensitivity functions.
        let blurred = [0, 1, 2].map(|channel| plane(channel).blur(&self.sensitivity[channel]));
        // Detect edges and points in the luminance.
        let mut luminance = plane(0);
        luminance
            .values
            .iter_mut()
            .for_each(|y| *y = (*y + 16.0) / 116.0);
        let [edges, points] = self.feature.strengths(&luminance);
        // Convert to CIELAB with the Hunt effect.
        (0..width * height)
            .map(|i| {
                let seen =
                    Vec3::from_array([0, 1, 2].map(|channel: usize| blurred[channel].values[i]));
                let linear = xyz_to_linear(opponent_to_xyz(seen)).clamp(Vec3::ZERO, Vec3::ONE);
                PixelFeatures {
                    color: hunt(linear_to_lab(linear)),
                    edge: edges[i],
                    point: points[i],
                }
            })
            .collect()
    }
}

/// Gaussians `a·√(π/b)·exp(−π²·x²/b)`, x in degrees, cut at the radius and scaled so that they sum
/// to one.
fn normalized_sum(
    terms: &[(f64, f64)],
    radius: f64,
    pixels_per_degree: f64,
) -> Vec<(f64, Vec<f64>)> {
    use std::f64::consts::PI;
    let gaussian = |b: f64| {
        let weight = |x: f64| exp(-PI * PI * (x / pixels_per_degree) * (x / pixels_per_degree) / b);
        offsets(radius).map(weight).collect::<Vec<_>>()
    };
    let mut sum: Vec<_> = terms
        .iter()
        .map(|(a, b)| (a * (PI / b).sqrt(), gaussian(*b)))
        .collect();
    let mass = |line: &[f64]| line.iter().sum::<f64>() * line.iter().sum::<f64>();
    let total: f64 = sum.iter().map(|(weight, line)| weight * mass(line)).sum();
    sum.iter_mut().for_each(|(weight, _)| *weight /= total);
    sum
}

/// −radius … radius.
fn offsets(radius: f64) -> impl Iterator<Item = f64> {
    std::iter::successors(Some(-radius), |x| Some(x + 1.0)).take_while(move |x| *x <= radius)
}

impl FeatureFilter {
    fn new(pixels_per_degree: f64) -> Self {
        /// The width of the feature detector, in degrees (from the paper).
        const WIDTH: f64 = 0.082;
        let deviation = 0.5 * WIDTH * pixels_per_degree;
        let radius = (3.0 * deviation).ceil();
        let gaussian = |x: f64| exp(-x * x / (2.0 * deviation * deviation));
        let smooth: Vec<_> = offsets(radius).map(gaussian).collect();
        let first: Vec<_> = offsets(radius).map(|x| -x * gaussian(x)).collect();
        let second = offsets(radius)
            .map(|x| (x * x / (deviation * deviation) - 1.0) * gaussian(x))
            .collect();
        let total: f64 = smooth.iter().sum();
        let smooth = smooth.into_iter().map(|weight| weight / total).collect();
        Self {
            smooth,
            first: balanced(first),
            second: balanced(second),
        }
    }

    /// The strength of edges and points: the norms of the first and second derivatives.
    fn strengths(&self, luminance: &ColorChannel) -> [Vec<f64>; 2] {
        [&self.first, &self.second].map(|derivative| {
            let across = luminance.convolve(derivative, &self.smooth);
            let along = luminance.convolve(&self.smooth, derivative);
            across
                .values
                .iter()
                .zip(&along.values)
                .map(|(x, y)| (x * x + y * y).sqrt())
                .collect()
        })
    }
}

/// Normalizes the weights so that positive ones sum to one and negative ones to minus one.
fn balanced(weights: Vec<f64>) -> Vec<f64> {
    let above: f64 = weights.iter().filter(|weight| **weight > 0.0).sum();
    let below: f64 = -weights.iter().filter(|weight| **weight < 0.0).sum::<f64>();
    weights
        .into_iter()
        .map(|weight| weight / if weight > 0.0 { above } else { below })
        .collect()
}

/// An image with one channel.
struct ColorChannel {
    width: usize,
    height: usize,
    values: Vec<f64>,
}

impl ColorChannel {
    fn blur(&self, gaussians: &[(f64, Vec<f64>)]) -> Self {
        let mut sum = vec![0.0; self.values.len()];
        for (weight, line) in gaussians {
            for (sum, value) in sum.iter_mut().zip(self.convolve(line, line).values) {
                *sum += weight * value;
            }
        }
        Self {
            values: sum,
            ..*self
        }
    }

    /// The separable convolution with `across` along rows and `along` along columns.
    fn convolve(&self, across: &[f64], along: &[f64]) -> Self {
        let Self {
            width,
            height,
            values,
        } = self;
        let rows = (0..*height).flat_map(|y| (0..*width).map(move |x| (x, y)));
        let rows = rows
            .map(|(x, y)| weighted_sum(across, x, *width, |x| values[y * width + x]))
            .collect::<Vec<_>>();
        let columns = (0..*height).flat_map(|y| (0..*width).map(move |x| (x, y)));
        let values = columns
            .map(|(x, y)| weighted_sum(along, y, *height, |y| rows[y * width + x]))
            .collect();
        Self { values, ..*self }
    }
}

/// The weighted sum around an index on a line of `length` values, which is continued with its first
/// and last value.
fn weighted_sum(weights: &[f64], at: usize, length: usize, value: impl Fn(usize) -> f64) -> f64 {
    let radius = weights.len() / 2;
    let index = |k: usize| (at + k).saturating_sub(radius).min(length - 1);
    (0..)
        .zip(weights)
        .map(|(k, weight)| weight * value(index(k)))
        .sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    const WIDTH: u32 = 48;
    const HEIGHT: u32 = 40;

    fn picture(value: impl Fn(u32, u32) -> [f64; 3]) -> Image {
        let places = (0..HEIGHT).flat_map(|y| (0..WIDTH).map(move |x| (x, y)));
        Image {
            width: WIDTH,
            height: HEIGHT,
            pixels: places.map(|(x, y)| value(x, y)).collect(),
        }
    }

    fn ramp(x: u32, y: u32) -> [f64; 3] {
        [
            f64::from(x) / f64::from(WIDTH - 1),
            f64::from(y) / f64::from(HEIGHT - 1),
            0.5,
        ]
    }

    fn mean_and_max(reference: &Image, test: &Image) -> (f64, f64) {
        let map = flip(reference, test, PIXELS_PER_DEGREE);
        (
            map.iter().sum::<f64>() / map.len() as f64,
            map.iter().copied().fold(0.0, f64::max),
        )
    }

    /// Means and largest values as `flip-evaluator` 1.7 has them.
    #[test]
    fn pairs_are_as_different_as_the_authors_program_says() {
        let grey = |inside: bool| [if inside { 1.0 } else { 0.0 }; 3];
        let checks = |shift: u32| picture(move |x, y| grey((x / 4 + (y + shift) / 4) % 2 == 1));
        let step = |at: u32| picture(move |x, _| grey(x < at));
        let flat = |color: [f64; 3]| picture(move |_, _| color);
        let dot = picture(|x, y| [if (x, y) == (20, 17) { 1.0 } else { 0.2 }; 3]);
        let cases = [
            (
                "darker",
                picture(ramp),
                picture(|x, y| ramp(x, y).map(|v| 0.9 * v)),
                0.334_849,
                0.526_318,
            ),
            (
                "black and white",
                flat([0.0; 3]),
                flat([1.0; 3]),
                0.967_401,
                0.967_388,
            ),
            (
                "blue and green",
                flat([0.0, 0.0, 1.0]),
                flat([0.0, 1.0, 0.0]),
                1.0,
                1.0,
            ),
            (
                "checks one row on",
                checks(0),
                checks(1),
                0.306_736,
                0.979_473,
            ),
            (
                "an edge one column on",
                step(24),
                step(25),
                0.068_952,
                0.772_917,
            ),
            ("a dot", flat([0.2; 3]), dot, 0.004_716, 0.658_372),
        ];
        for (name, reference, test, mean, max) in cases {
            let (our_mean, our_max) = mean_and_max(&reference, &test);
            assert!(
                (our_mean - mean).abs() < 5e-4 && (our_max - max).abs() < 2e-3,
                "{name}: {our_mean} {our_max}"
            );
        }
    }

    #[test]
    fn noise_is_as_different_as_the_authors_program_says() {
        let mut state = 1_u32;
        let mut next = || {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            f64::from(state) / 4_294_967_296.0
        };
        let mut noisy = picture(ramp);
        noisy
            .pixels
            .iter_mut()
            .flatten()
            .for_each(|v| *v = 0.8 * *v + 0.2 * next());
        let (mean, max) = mean_and_max(&picture(ramp), &noisy);
        assert!(
            (mean - 0.303_949).abs() < 5e-4 && (max - 0.738_713).abs() < 2e-3,
            "{mean} {max}"
        );
    }

    #[test]
    fn no_filter_is_wider_than_the_declared_radius() {
        let VisionFilters {
            sensitivity,
            feature,
        } = VisionFilters::new(PIXELS_PER_DEGREE);
        let lines = sensitivity.iter().flatten().map(|(_, line)| line);
        let reach = lines.chain([&feature.smooth]).map(|line| line.len() / 2);
        assert_eq!(reach.max(), Some(REACH as usize));
    }

    #[test]
    fn nothing_differs_from_itself() {
        assert_eq!(mean_and_max(&picture(ramp), &picture(ramp)), (0.0, 0.0));
    }
}
