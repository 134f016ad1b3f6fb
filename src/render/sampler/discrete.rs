//! Tabulated distributions: an index, or a point of the unit square, with a probability
//! proportional to its weight.

use super::remapped;

/// Indices per part of a guide: enough for it to be small beside the sums.
const PER_PART: usize = 4;

/// A discrete distribution over indices, proportional to weights.
#[derive(Clone, Debug)]
pub(crate) struct DiscreteDistribution {
    /// Sums of the weights up to and including each.
    sums: Vec<f64>,
    /// For each of 2^k equal parts of [0, 1), the first index that its numbers choose (Chen, Asau,
    /// "On generating random variates from an empirical distribution", 1974).
    guide: Vec<u32>,
    /// The last index with a nonzero weight.
    last: usize,
}

impl DiscreteDistribution {
    pub(crate) fn new(weights: impl Iterator<Item = f64>) -> Self {
        let mut sum = 0.0;
        let add = |weight: f64| {
            sum += weight;
            sum
        };
        let sums = weights.map(add).collect::<Vec<_>>();
        let last = sums.partition_point(|before| *before < sum);
        let parts = (sums.len() / PER_PART).next_power_of_two();
        let first = |part: usize| {
            let place = part as f64 / parts as f64 * sum;
            sums.partition_point(|sum| *sum <= place) as u32
        };
        let guide = (0..parts).map(first).collect();
        Self { sums, guide, last }
    }

    /// The sum of all weights.
    pub(crate) fn total(&self) -> f64 {
        self.sums.last().copied().unwrap_or(0.0)
    }

    /// The one index with a nonzero weight; `None` if there are none or several.
    pub(crate) fn only(&self) -> Option<usize> {
        let first = self.sums.partition_point(|sum| *sum <= 0.0);
        (first == self.last && first < self.sums.len()).then_some(first)
    }

    /// The probability of an index.
    pub(crate) fn probability(&self, index: usize) -> f64 {
        let total = self.total();
        let before = if index > 0 { self.sums[index - 1] } else { 0.0 };
        if total > 0.0 {
            (self.sums[index] - before) / total
        } else {
            0.0
        }
    }

    /// Samples an index with a number in [0, 1), and returns the number remapped to [0, 1) for the
    /// next decision; `None` if all weights are 0.
    pub(crate) fn choose(&self, u: f64) -> Option<(usize, f64)> {
        let place = u * self.total();
        // Rounding is monotonic: a greater number has no lesser index.
        let mut index = self.guide[(u * self.guide.len() as f64) as usize] as usize;
        while self.sums.get(index).is_some_and(|sum| *sum <= place) {
            index += 1;
        }
        let index = index.min(self.last);
        let before = if index > 0 { self.sums[index - 1] } else { 0.0 };
        let width = self.sums.get(index)? - before;
        (width > 0.0).then(|| (index, remapped(place - before, width)))
    }
}

/// A distribution over an image whose texels are filtered linearly: bilinear between the middles of
/// texels, repeated across, and falling to 0 at the upper and the lower edge.
#[derive(Clone, Debug)]
pub(crate) struct BilinearDistribution {
    /// The weights in the middles of the texels, row by row.
    weights: Vec<f32>,
    width: usize,
    height: usize,
    /// The bands between rows of middles; the first and the last are half as high.
    bands: DiscreteDistribution,
    /// The cells of each band, between two columns of middles.
    cells: Vec<DiscreteDistribution>,
}

impl BilinearDistribution {
    /// The distribution over an image of `width` texels across, by its weights row by row; both
    /// sides are at least 1.
    pub(crate) fn new(width: usize, weights: Vec<f32>) -> Self {
        let mut table = Self {
            height: weights.len() / width,
            weights,
            width,
            bands: DiscreteDistribution::new(std::iter::empty()),
            cells: Vec::new(),
        };
        let cell = |x: usize, y: usize| {
            let [[a, b], [c, d]] = table.corners(x, y);
            table.band(y)[1] * (a + b + c + d) / 4.0
        };
        let band = |y: usize| DiscreteDistribution::new((0..width).map(|x| cell(x, y)));
        table.cells = (0..=table.height).map(band).collect();
        table.bands =
            DiscreteDistribution::new(table.cells.iter().map(DiscreteDistribution::total));
        table
    }

    /// The weights at the corners of a cell, the upper ones first.
    fn corners(&self, x: usize, y: usize) -> [[f64; 2]; 2] {
        let next = if x + 1 < self.width { x + 1 } else { 0 };
        let row = |y: Option<usize>| {
            let start = y.filter(|y| *y < self.height).map(|y| y * self.width);
            start.map_or([0.0; 2], |start| {
                [x, next].map(|x| f64::from(self.weights[start + x]))
            })
        };
        [row(y.checked_sub(1)), row(Some(y))]
    }

    /// Where a band begins and how high it is, in texels.
    fn band(&self, y: usize) -> [f64; 2] {
        let [start, end] = [y, y + 1].map(|y| (y as f64 - 0.5).clamp(0.0, self.height as f64));
        [start, end - start]
    }

    /// The mean weight.
    pub(crate) fn mean(&self) -> f64 {
        self.bands.total() / (self.width * self.height) as f64
    }

    /// The density at a position.
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "places are in the unit square"
    )]
    pub(crate) fn pdf(&self, [u, v]: [f64; 2]) -> f64 {
        let mean = self.mean();
        if mean == 0.0 {
            return 0.0;
        }
        // The column of a cell begins half a texel after that of its first corner.
        let across = u * self.width as f64 + (self.width as f64 - 0.5);
        let down = v * self.height as f64;
        let (x, y) = (across as usize, ((down + 0.5) as usize).min(self.height));
        let (s, [start, height]) = (across - x as f64, self.band(y));
        let t = (down - start) / height;
        let [[a, b], [c, d]] = self.corners(x % self.width, y);
        let (upper, lower) = (a + (b - a) * s, c + (d - c) * s);
        (upper + (lower - upper) * t) / mean
    }

    /// Samples a point with two numbers in [0, 1); uniform if all weights are 0.
    pub(crate) fn sample(&self, u: [f64; 2]) -> [f64; 2] {
        let place = || {
            let (y, rest_y) = self.bands.choose(u[1])?;
            let (x, rest_x) = self.cells[y].choose(u[0])?;
            let ([[a, b], [c, d]], [start, height]) = (self.corners(x, y), self.band(y));
            let t = linear([a + b, c + d], rest_y);
            let s = linear([a + (c - a) * t, b + (d - b) * t], rest_x);
            let across = (x as f64 + 0.5 + s) / self.width as f64;
            Some([across % 1.0, (start + height * t) / self.height as f64])
        };
        place().unwrap_or(u)
    }
}

/// Samples a number in [0, 1] with a density that is linear from a to b (Pharr, Jakob, Humphreys,
/// "Physically Based Rendering", 4th ed., §2.3.2).
fn linear([a, b]: [f64; 2], u: f64) -> f64 {
    let root = (a * a + (b * b - a * a) * u).max(0.0).sqrt();
    if u > 0.0 {
        (u * (a + b) / (a + root)).min(1.0)
    } else {
        0.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn indices_come_as_often_as_they_weigh() {
        let choice = DiscreteDistribution::new([0.0, 1.0, 0.0, 3.0, 0.0].into_iter());
        assert_eq!(choice.choose(0.0).unwrap().0, 1);
        assert_eq!(choice.choose(0.2499).unwrap().0, 1);
        assert_eq!(choice.choose(0.25), Some((3, 0.0)));
        assert_eq!(choice.choose(0.999_999).unwrap().0, 3);
        assert_eq!((choice.probability(1), choice.probability(4)), (0.25, 0.0));
        assert!(
            DiscreteDistribution::new([0.0].into_iter())
                .choose(0.5)
                .is_none()
        );
        assert!(
            DiscreteDistribution::new([].into_iter())
                .choose(0.5)
                .is_none()
        );
    }

    #[test]
    fn the_guide_leads_to_the_index_that_a_search_finds() {
        // Weights of very different sizes, and many of 0.
        let weight = |k: u32| match k % 5 {
            0 | 3 => 0.0,
            _ => f64::from(1_u32 << (k * 2_654_435 % 31)),
        };
        for count in [1, 2, 3, 7, 64, 1000] {
            let choice = DiscreteDistribution::new((1..=count).map(weight));
            let edges = choice.sums.iter().map(|sum| sum / choice.total());
            let numbers = (0..4096).map(|k| f64::from(k) / 4096.0).chain(edges);
            for u in numbers.filter(|u| *u < 1.0) {
                let place = u * choice.total();
                let found = choice.sums.partition_point(|sum| *sum <= place);
                let chosen = choice.choose(u).map(|(index, _)| index);
                assert_eq!(chosen, Some(found.min(choice.last)), "{count} {u}");
            }
        }
    }

    #[test]
    fn only_one_index_is_chosen_if_the_others_weigh_nothing() {
        let only = |weights: &[f64]| DiscreteDistribution::new(weights.iter().copied()).only();
        assert_eq!(only(&[0.0, 2.0, 0.0]), Some(1));
        assert_eq!(only(&[5e-324]), Some(0));
        assert_eq!(only(&[1.0, 0.0, 2.0]), None);
        assert_eq!((only(&[0.0; 3]), only(&[])), (None, None));
    }

    #[test]
    fn places_come_as_often_as_their_density_says() {
        // The middle has a bright texel beside dark ones.
        let weights = [1.0, 0.0, 2.0, 0.0, 9.0, 0.5, 0.0, 3.0, 0.0];
        let table = BilinearDistribution::new(3, weights.to_vec());
        let (n, cells) = (600, 12);
        let fraction = |k: usize, n: usize| (k as f64 + 0.5) / n as f64;
        let mut counts = vec![0.0; cells * cells];
        let mut densities = counts.clone();
        for i in 0..n {
            for j in 0..n {
                let cell = |[u, v]: [f64; 2]| {
                    let [x, y] = [u, v].map(|u| ((u * cells as f64) as usize).min(cells - 1));
                    cells * y + x
                };
                let u = [fraction(i, n), fraction(j, n)];
                counts[cell(table.sample(u))] += 1.0 / (n * n) as f64;
                densities[cell(u)] += table.pdf(u) / (n * n) as f64;
            }
        }
        assert!((densities.iter().sum::<f64>() - 1.0).abs() < 1e-4);
        for (count, density) in counts.iter().zip(&densities) {
            assert!((count - density).abs() < 3e-4, "{counts:?} {densities:?}");
        }
    }

    #[test]
    fn an_image_of_one_texel_is_even_across() {
        let table = BilinearDistribution::new(1, vec![4.0]);
        assert_eq!((table.mean(), table.pdf([0.0, 0.5])), (2.0, 2.0));
        assert_eq!(table.sample([0.25, 0.0])[1], 0.0);
        let dark = BilinearDistribution::new(1, vec![0.0]);
        assert_eq!((dark.pdf([0.5; 2]), dark.sample([0.3; 2])), (0.0, [0.3; 2]));
    }
}
