//! Importance sampling of reconstruction filters.
//!
//! A sample of a pixel is at a distance from its middle that is distributed as the absolute value
//! of the filter, and its radiance is multiplied by the sign of the filter there and one factor
//! (Ernst, Stamminger, Greiner, "Filter importance sampling" (2006); Pharr, Jakob, Humphreys,
//! "Physically Based Rendering" (4th ed.), §8.8). So no sample counts for two pixels, and the
//! picture does not depend on how its pixels are divided among threads and processes.

use rtc_math::PixelFilter;

/// The cells of the table over the diameter.
const CELLS: usize = 256;

/// A filter along one axis: between the nodes of the table its absolute value is linear.
#[derive(Debug)]
pub(crate) struct FilterSampler {
    radius: f64,
    /// The absolute values at the nodes.
    values: Vec<f64>,
    /// The sign of each cell.
    signs: Vec<f64>,
    /// The share of the area of all cells before each node.
    cumulative: Vec<f64>,
    /// The area of the absolute value over that of the filter.
    factor: f64,
}

impl FilterSampler {
    /// The table of a filter; `None` if it is the pixel itself.
    pub(crate) fn new(filter: &PixelFilter) -> Option<Self> {
        if filter.is_pixel() {
            return None;
        }
        // Evaluate the filter at the nodes.
        let radius = filter.radius();
        let count = |k: usize| f64::from(rtc_math::to_u32(k));
        let node = |k: usize| radius * (2.0 * count(k) / count(CELLS) - 1.0);
        let weights: Vec<f64> = (0..=CELLS).map(|k| filter.weight(node(k))).collect();
        // Add up the areas of the cells.
        let cells = || weights.windows(2).map(|pair| (pair[0] + pair[1], pair));
        let signs: Vec<f64> = cells().map(|(sum, _)| 1.0_f64.copysign(sum)).collect();
        let areas: Vec<f64> = cells()
            .map(|(_, pair)| (pair[0].abs() + pair[1].abs()) / 2.0)
            .collect();
        let whole: f64 = areas.iter().sum();
        let signed: f64 = areas
            .iter()
            .zip(&signs)
            .map(|(area, sign)| area * sign)
            .sum();
        let mut sum = 0.0;
        let mut cumulative = vec![0.0];
        cumulative.extend(areas.iter().map(|area| {
            sum += area;
            sum / whole
        }));
        Some(Self {
            radius,
            values: weights.iter().map(|weight| weight.abs()).collect(),
            signs,
            cumulative,
            factor: whole / signed,
        })
    }

    /// The place of a sample in a pixel, 0.5 in the middle, and the factor of its radiance, by two
    /// numbers in [0, 1).
    pub(crate) fn sample(&self, u: [f64; 2]) -> ([f64; 2], f64) {
        let [(x, a), (y, b)] = u.map(|u| self.along(u));
        ([0.5 + x, 0.5 + y], a * b)
    }

    /// How far it reaches beyond the pixel, in pixels.
    pub(crate) fn reach(&self) -> f64 {
        (self.radius - 0.5).max(0.0)
    }

    /// A distance from the middle along an axis, and its factor.
    fn along(&self, u: f64) -> (f64, f64) {
        // Choose a cell by its area.
        let after = self.cumulative.partition_point(|before| *before <= u);
        let cell = after.clamp(1, CELLS) - 1;
        let (low, high) = (self.cumulative[cell], self.cumulative[cell + 1]);
        let left = if high > low {
            (u - low) / (high - low)
        } else {
            0.5
        };
        // Invert the linear density in it (ibid., §A.4.1).
        let (a, b) = (self.values[cell], self.values[cell + 1]);
        let root = (a * a + (b * b - a * a) * left).max(0.0).sqrt();
        let t = if a + root > 0.0 {
            left * (a + b) / (a + root)
        } else {
            left
        };
        let count = |k: usize| f64::from(rtc_math::to_u32(k));
        let place = (count(cell) + t.clamp(0.0, 1.0)) * 2.0 / count(CELLS) - 1.0;
        (self.radius * place, self.signs[cell] * self.factor)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn means_under_the_samples_are_those_under_the_filter() {
        let filters = [
            PixelFilter::Box { radius: 1.5 },
            PixelFilter::Tent { radius: 1.0 },
            PixelFilter::Gaussian {
                deviation: 0.5,
                radius: 2.0,
            },
            PixelFilter::Mitchell {
                b: 1.0 / 3.0,
                c: 1.0 / 3.0,
                radius: 2.0,
            },
            PixelFilter::CATMULL_ROM,
            PixelFilter::Lanczos {
                window: 3.0,
                radius: 3.0,
            },
        ];
        assert!(FilterSampler::new(&PixelFilter::PIXEL).is_none());
        let raised = |x: f64, power: i32| (0..power).fold(1.0, |product, _| product * x);
        let n = 100_000;
        let numbers = || (0..n).map(|k| (f64::from(k) + 0.5) / f64::from(n));
        for filter in filters {
            let sampler = FilterSampler::new(&filter).unwrap();
            // Means of polynomials of the distance.
            for power in [0, 1, 2, 4] {
                let sampled: f64 = numbers()
                    .map(|u| sampler.along(u))
                    .map(|(x, factor)| factor * raised(x, power))
                    .sum();
                let sampled = sampled / f64::from(n);
                let at = |u: f64| filter.radius() * (2.0 * u - 1.0);
                let [top, bottom] = [power, 0].map(|power| {
                    let value = |x: f64| filter.weight(x) * raised(x, power);
                    numbers().map(|u| value(at(u))).sum::<f64>()
                });
                let known = top / bottom;
                let scale = raised(filter.radius(), power);
                assert!(
                    (sampled - known).abs() < 2e-3 * scale,
                    "{filter:?} {power}: {sampled} {known}"
                );
            }
        }
    }
}
