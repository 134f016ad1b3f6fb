//! Tabulated distributions: an index, or a point of the unit square, with a probability
//! proportional to its weight.

/// Indices per part of a guide: enough for it to be small beside the sums.
const PER_PART: usize = 4;

/// A discrete distribution over indices, proportional to weights.
#[derive(Clone, Debug)]
pub(in crate::render) struct DiscreteDistribution {
    /// Sums of the weights up to and including each.
    sums: Vec<f64>,
    /// For each of 2^k equal parts of [0, 1), the first index that its numbers choose (Chen, Asau,
    /// "On generating random variates from an empirical distribution", 1974).
    guide: Vec<u32>,
    /// The last index with a nonzero weight.
    last: usize,
}

impl DiscreteDistribution {
    pub(in crate::render) fn new(weights: impl Iterator<Item = f64>) -> Self {
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
    pub(in crate::render) fn total(&self) -> f64 {
        self.sums.last().copied().unwrap_or(0.0)
    }

    /// The one index with a nonzero weight; `None` if there are none or several.
    pub(in crate::render) fn only(&self) -> Option<usize> {
        let first = self.sums.partition_point(|sum| *sum <= 0.0);
        (first == self.last && first < self.sums.len()).then_some(first)
    }

    /// The probability of an index.
    pub(in crate::render) fn probability(&self, index: usize) -> f64 {
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
    pub(in crate::render) fn choose(&self, u: f64) -> Option<(usize, f64)> {
        let place = u * self.total();
        // Rounding keeps order: a greater number has no lesser place.
        let mut index = self.guide[(u * self.guide.len() as f64) as usize] as usize;
        while self.sums.get(index).is_some_and(|sum| *sum <= place) {
            index += 1;
        }
        let index = index.min(self.last);
        let before = if index > 0 { self.sums[index - 1] } else { 0.0 };
        let width = self.sums.get(index)? - before;
        (width > 0.0).then(|| {
            (
                index,
                ((place - before) / width).clamp(0.0, 1.0 - f64::EPSILON),
            )
        })
    }
}

/// A piecewise constant distribution over the unit square.
#[derive(Clone, Debug)]
pub(in crate::render) struct Distribution2D {
    rows: DiscreteDistribution,
    cells: Vec<DiscreteDistribution>,
    width: usize,
}

impl Distribution2D {
    /// A table of columns and rows, both at least 1.
    pub(in crate::render) fn new(
        [width, height]: [u32; 2],
        weight: impl Fn(u32, u32) -> f64,
    ) -> Self {
        let row = |y: u32| DiscreteDistribution::new((0..width).map(|x| weight(x, y)));
        let cells = (0..height).map(row).collect::<Vec<_>>();
        Self {
            rows: DiscreteDistribution::new(cells.iter().map(DiscreteDistribution::total)),
            cells,
            width: width as usize,
        }
    }

    /// The mean weight of a cell.
    pub(in crate::render) fn mean(&self) -> f64 {
        self.rows.total() / (self.width * self.cells.len()) as f64
    }

    /// The density at a place.
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "clamped to the table"
    )]
    pub(in crate::render) fn pdf(&self, [u, v]: [f64; 2]) -> f64 {
        let cell =
            |fraction: f64, count: usize| ((fraction * count as f64) as usize).min(count - 1);
        let (x, y) = (cell(u, self.width), cell(v, self.cells.len()));
        self.rows.probability(y)
            * self.cells[y].probability(x)
            * (self.width * self.cells.len()) as f64
    }

    /// Samples a point with two numbers in [0, 1); uniform if all weights are 0.
    pub(in crate::render) fn sample(&self, u: [f64; 2]) -> [f64; 2] {
        let place = || {
            let (y, rest_y) = self.rows.choose(u[1])?;
            let (x, rest_x) = self.cells[y].choose(u[0])?;
            Some([
                (x as f64 + rest_x) / self.width as f64,
                (y as f64 + rest_y) / self.cells.len() as f64,
            ])
        };
        place().unwrap_or(u)
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
    fn places_have_the_density_of_their_cell() {
        let table = Distribution2D::new([3, 2], |x, y| f64::from(x + 3 * y));
        let n = 300;
        let mut counts = [[0.0; 3]; 2];
        for i in 0..n {
            for j in 0..n {
                let fraction = |k: i32| (f64::from(k) + 0.5) / f64::from(n);
                let [u, v] = table.sample([fraction(i), fraction(j)]);
                counts[(v * 2.0) as usize][(u * 3.0) as usize] += 1.0 / f64::from(n * n);
            }
        }
        for y in 0..2_u8 {
            for x in 0..3_u8 {
                let density = table.pdf([(f64::from(x) + 0.5) / 3.0, (f64::from(y) + 0.5) / 2.0]);
                assert!(
                    (counts[usize::from(y)][usize::from(x)] - density / 6.0).abs() < 0.005,
                    "{x} {y}: {counts:?}"
                );
            }
        }
    }
}
