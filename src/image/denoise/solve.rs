//! Weighted least squares of three channels over a few terms, by Cholesky's decomposition, for
//! several pixels at once.

#![expect(
    clippy::needless_range_loop,
    reason = "the indices are those of the equations"
)]

use std::array::from_fn;

/// The pixels that are solved together.
pub(super) const LANES: usize = 8;

/// A number of each of them.
pub(super) type Lane = [f32; LANES];

/// The constant term and the slopes.
pub(super) const TERMS: usize = 9;

/// The normal equations.
pub(super) struct NormalEquations {
    /// The lower triangle.
    matrix: [[Lane; TERMS]; TERMS],
    right: [[Lane; 3]; TERMS],
}

impl Default for NormalEquations {
    fn default() -> Self {
        Self {
            matrix: [[[0.0; LANES]; TERMS]; TERMS],
            right: [[[0.0; LANES]; 3]; TERMS],
        }
    }
}

/// Adds a product to a sum.
#[inline(always)]
fn add(sum: &mut Lane, a: &Lane, b: &Lane) {
    for l in 0..LANES {
        sum[l] += a[l] * b[l];
    }
}

/// Takes a product off a sum.
#[inline(always)]
fn subtract(sum: &mut Lane, a: &Lane, b: &Lane) {
    for l in 0..LANES {
        sum[l] -= a[l] * b[l];
    }
}

impl NormalEquations {
    /// Adds values with weights at places.
    #[inline]
    pub(super) fn add(&mut self, weight: &Lane, place: &[Lane; TERMS - 1], value: &[Lane; 3]) {
        for i in 0..TERMS {
            let weighted: Lane = match i {
                0 => *weight,
                _ => from_fn(|l| weight[l] * place[i - 1][l]),
            };
            for l in 0..LANES {
                self.matrix[i][0][l] += weighted[l];
            }
            for j in 1..=i {
                add(&mut self.matrix[i][j], &weighted, &place[j - 1]);
            }
            for c in 0..3 {
                add(&mut self.right[i][c], &weighted, &value[c]);
            }
        }
    }

    /// The constant term of each channel, with a ridge on the slopes.
    pub(super) fn solve(mut self, ridge: f32) -> [Lane; 3] {
        // Decompose; `inverse` are the inverses of the diagonal.
        let mut inverse = [[0.0; LANES]; TERMS];
        for i in 0..TERMS {
            for j in 0..=i {
                let mut rest = self.matrix[i][j];
                for k in 0..j {
                    let (a, b) = (self.matrix[i][k], self.matrix[j][k]);
                    subtract(&mut rest, &a, &b);
                }
                if i == j {
                    let damping = if i > 0 { ridge } else { 0.0 };
                    inverse[i] = rest.map(|rest| 1.0 / (rest + damping).max(1e-6).sqrt());
                } else {
                    self.matrix[i][j] = from_fn(|l| rest[l] * inverse[j][l]);
                }
            }
        }
        // Substitute forwards; of the way back only the constant term is wanted, which is last.
        for i in 0..TERMS {
            for c in 0..3 {
                let mut rest = self.right[i][c];
                for k in 0..i {
                    subtract(&mut rest, &self.matrix[i][k], &self.right[k][c]);
                }
                self.right[i][c] = from_fn(|l| rest[l] * inverse[i][l]);
            }
        }
        for i in (0..TERMS).rev() {
            for c in 0..3 {
                let mut rest = self.right[i][c];
                for k in i + 1..TERMS {
                    subtract(&mut rest, &self.matrix[k][i], &self.right[k][c]);
                }
                self.right[i][c] = from_fn(|l| rest[l] * inverse[i][l]);
            }
        }
        self.right[0]
    }
}
