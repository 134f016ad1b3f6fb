//! Weighted least squares of three channels with a few terms, by Cholesky decomposition.

/// The constant term and the slopes.
pub(super) const TERMS: usize = 9;

/// The normal equations.
#[derive(Default)]
pub(super) struct Terms {
    /// The lower triangle.
    matrix: [[f64; TERMS]; TERMS],
    right: [[f64; 3]; TERMS],
}

impl Terms {
    /// Adds a value with a weight at a position.
    pub(super) fn add(&mut self, weight: f64, guide: &[f64; TERMS - 1], value: [f64; 3]) {
        let mut terms = [1.0; TERMS];
        terms[1..].copy_from_slice(guide);
        for (i, term) in terms.iter().enumerate() {
            let weighted = weight * term;
            for (sum, other) in self.matrix[i][..=i].iter_mut().zip(&terms) {
                *sum += weighted * other;
            }
            for (sum, value) in self.right[i].iter_mut().zip(value) {
                *sum += weighted * value;
            }
        }
    }
}

/// The constant term of each channel, with a ridge on the slopes.
pub(super) fn solve(terms: Terms, ridge: f64) -> [f64; 3] {
    let Terms { matrix, mut right } = terms;
    let mut lower = [[0.0; TERMS]; TERMS];
    for i in 0..TERMS {
        for j in 0..=i {
            let damping = if i == j && i > 0 { ridge } else { 0.0 };
            let mut rest = matrix[i][j] + damping;
            for (a, b) in lower[i][..j].iter().zip(&lower[j][..j]) {
                rest -= a * b;
            }
            lower[i][j] = if i == j {
                rest.max(1e-12).sqrt()
            } else {
                rest / lower[j][j]
            };
        }
    }
    [0, 1, 2].map(|c| {
        for i in 0..TERMS {
            for k in 0..i {
                right[i][c] -= lower[i][k] * right[k][c];
            }
            right[i][c] /= lower[i][i];
        }
        for i in (0..TERMS).rev() {
            for k in i + 1..TERMS {
                right[i][c] -= lower[k][i] * right[k][c];
            }
            right[i][c] /= lower[i][i];
        }
        right[0][c]
    })
}
