//! Tabulated distributions: an index, or a point of the unit square, with a probability
//! proportional to its weight.

/// A discrete distribution over indices, proportional to weights.
#[derive(Clone, Debug)]
pub(in crate::render) struct DiscreteDistribution {
    /// Sums of the weights up to and including each.
    sums: Vec<f64>,
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
        Self { sums, last }
    }

    /// The sum of all weights.
    pub(in crate::render) fn total(&self) -> f64 {
        self.sums.last().copied().unwrap_or(0.0)
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
        let index = self
            .sums
            .partition_point(|sum| *sum <= place)
            .min(self.last);
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
