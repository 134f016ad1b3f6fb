//! Directional albedos of the lobes, tabulated over cosine and roughness.
//!
//! The tables are in `albedo.bin`, for they take half a second to integrate. A test integrates them
//! by the same functions that shade, and finds the same bits; `RTC_UPDATE=1 cargo test --lib albedo`
//! writes the file.

use std::sync::LazyLock;

/// Entries along the cosine, denser towards grazing: entry i is at (i/(n − 1))².
const COSINES: usize = 32;

/// Entries along the roughness.
const ROUGHNESSES: usize = 64;

/// Entries of a table.
const ENTRIES: usize = ROUGHNESSES * COSINES;

/// Little-endian numbers, a row for each roughness: both terms of each entry of microfacets, then the
/// albedos of sheen.
static STORED: [u8; 3 * 8 * ENTRIES] = *include_bytes!("albedo.bin");

/// The tables.
pub(super) struct Tables {
    /// The terms of the albedo in f0 and in f90.
    specular: Vec<[f64; 2]>,
    sheen: Vec<[f64; 2]>,
    /// Means over the hemisphere, weighted by the cosine, per roughness.
    means: Vec<[f64; 2]>,
}

/// The albedo of a microfacet lobe with Schlick's reflectance: `f0·e0 + f90·e90`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Split {
    /// The factor of f0.
    pub(super) e0: f64,
    /// The factor of f90.
    pub(super) e90: f64,
}

impl Split {
    /// The albedo if everything were reflected at the first bounce.
    #[must_use]
    pub(super) fn whole(self) -> f64 {
        self.e0 + self.e90
    }
}

/// The tables, read at the first call.
pub(super) fn tables() -> &'static Tables {
    static TABLES: LazyLock<Tables> = LazyLock::new(Tables::new);
    &TABLES
}

impl Tables {
    fn new() -> Self {
        let numbers = STORED.as_chunks().0.iter().copied();
        let numbers = numbers.map(f64::from_le_bytes).collect::<Vec<_>>();
        let (specular, sheen) = numbers.split_at(2 * ENTRIES);
        let specular = specular.as_chunks().0.to_vec();
        let sheen = sheen.iter().map(|albedo| [*albedo, 0.0]).collect();
        let mean = |row: &[[f64; 2]]| {
            // ∫ 2μ·E(μ) dμ with μ = x², by the midpoint rule over what look-ups will give.
            const STEPS: u32 = 512;
            let mut sum = [0.0; 2];
            for k in 0..STEPS {
                let x = (f64::from(k) + 0.5) / f64::from(STEPS);
                let e = between(row, x * x);
                sum = [0, 1].map(|term| sum[term] + 4.0 * x * x * x * e[term] / f64::from(STEPS));
            }
            sum
        };
        let means = specular.chunks(COSINES).map(mean).collect();
        Self {
            specular,
            sheen,
            means,
        }
    }

    /// The albedo of a microfacet lobe.
    pub(super) fn specular(&self, roughness: f64, cosine: f64) -> Split {
        let [e0, e90] = look_up(&self.specular, roughness, cosine);
        Split { e0, e90 }
    }

    /// Its mean over the hemisphere, weighted by the cosine.
    pub(super) fn specular_mean(&self, roughness: f64) -> Split {
        let (row, rest) = place(roughness, ROUGHNESSES);
        let [e0, e90] = [0, 1]
            .map(|term| self.means[row][term] * (1.0 - rest) + self.means[row + 1][term] * rest);
        Split { e0, e90 }
    }

    /// The albedo of white sheen.
    pub(super) fn sheen(&self, roughness: f64, cosine: f64) -> f64 {
        look_up(&self.sheen, roughness, cosine)[0]
    }
}

/// Interpolates bilinearly between four entries.
fn look_up(table: &[[f64; 2]], roughness: f64, cosine: f64) -> [f64; 2] {
    let (row, rest) = place(roughness, ROUGHNESSES);
    let low = between(&table[row * COSINES..][..COSINES], cosine);
    let high = between(&table[(row + 1) * COSINES..][..COSINES], cosine);
    [0, 1].map(|term| low[term] * (1.0 - rest) + high[term] * rest)
}

fn between(row: &[[f64; 2]], cosine: f64) -> [f64; 2] {
    let (k, rest) = place(cosine.max(0.0).sqrt(), COSINES);
    [0, 1].map(|term| row[k][term] * (1.0 - rest) + row[k + 1][term] * rest)
}

/// The index of the entry below a number in [0, 1], and the interpolation weight of the next.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "clamped to the table"
)]
fn place(fraction: f64, count: usize) -> (usize, f64) {
    let scaled = fraction.clamp(0.0, 1.0) * (count - 1) as f64;
    let entry = (scaled as usize).min(count - 2);
    (entry, scaled - entry as f64)
}

#[cfg(test)]
mod tests;
