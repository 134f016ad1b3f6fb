//! Directional albedos of the lobes, tabulated over cosine and roughness.
//!
//! The tables are in `*.bin`, for they take a second to integrate. Tests integrate them by the same
//! functions that shade, and find the same bits; `RTC_UPDATE=1 cargo test -p rtc-render albedo`
//! writes the files.

use super::fresnel::schlick;
use super::warp::direction_at_angle;
use packed::unpack;
use rtc_math::Vec3;
use std::sync::LazyLock;

pub(super) mod anisotropic;
pub(super) mod dielectric;
mod packed;

/// Entries along the cosine, denser towards grazing: entry i is at (i/(n − 1))².
const COSINES: usize = 32;

/// Entries along the roughness.
const ROUGHNESSES: usize = 64;

/// The axes of a table.
const AXES: [usize; 2] = [ROUGHNESSES, COSINES];

/// Entries of a table.
const ENTRIES: usize = ROUGHNESSES * COSINES;

/// Packed little-endian numbers, a row for each roughness: both terms of microfacets, and the
/// albedo of sheen.
static STORED: [u8; 3 * 8 * ENTRIES] = *include_bytes!("albedo.bin");

/// The tables.
pub(super) struct AlbedoTables {
    /// The terms of the albedo in f0 and in f90.
    specular: Vec<[f64; 2]>,
    sheen: Vec<[f64; 2]>,
    /// Means over the hemisphere, weighted by the cosine, per roughness.
    means: Vec<[f64; 2]>,
}

/// The albedo of a microfacet lobe with Schlick's reflectance: `f0·e0 + f90·e90`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct SchlickAlbedo {
    /// The factor of f0.
    pub(super) e0: f64,
    /// The factor of f90.
    pub(super) e90: f64,
}

impl SchlickAlbedo {
    /// The albedo by the reflectances at normal and at grazing incidence.
    #[must_use]
    pub(super) fn at(self, f0: f64, f90: f64) -> f64 {
        f0 * self.e0 + f90 * self.e90
    }

    /// The albedo if everything were reflected at the first bounce.
    #[must_use]
    pub(super) fn whole(self) -> f64 {
        self.e0 + self.e90
    }
}

/// The tables, read at the first call.
pub(super) fn tables() -> &'static AlbedoTables {
    static TABLES: LazyLock<AlbedoTables> = LazyLock::new(AlbedoTables::new);
    &TABLES
}

impl AlbedoTables {
    fn new() -> Self {
        let entries = unpack(&STORED, &AXES).into_iter();
        let entries = entries.map(|entry| entry.map(f64::from_le_bytes));
        let (specular, sheen): (Vec<_>, _) = entries
            .map(|[e0, e90, sheen]| ([e0, e90], [sheen, 0.0]))
            .unzip();
        let mean = |row: &[[f64; 2]]| {
            // ∫ 2μ·E(μ) dμ with μ = x², by the midpoint rule over interpolated entries.
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
    pub(super) fn specular(&self, roughness: f64, cosine: f64) -> SchlickAlbedo {
        let [e0, e90] = look_up(&self.specular, roughness, cosine);
        SchlickAlbedo { e0, e90 }
    }

    /// Its mean over the hemisphere, weighted by the cosine.
    pub(super) fn specular_mean(&self, roughness: f64) -> SchlickAlbedo {
        let (row, rest) = place(roughness, ROUGHNESSES);
        let [e0, e90] = [0, 1]
            .map(|term| self.means[row][term] * (1.0 - rest) + self.means[row + 1][term] * rest);
        SchlickAlbedo { e0, e90 }
    }

    /// The albedo of white sheen.
    pub(super) fn sheen(&self, roughness: f64, cosine: f64) -> f64 {
        look_up(&self.sheen, roughness, cosine)[0]
    }
}

/// The mean of Schlick's curve at the half-way vector to directions over the hemisphere, weighted
/// by their cosine. Its table is made at the first call.
pub(super) fn half_way(cosine: f64) -> f64 {
    static TABLE: LazyLock<Vec<[f64; 2]>> =
        LazyLock::new(|| (0..COSINES).map(half_way_of).collect());
    between(&TABLE, cosine)[0]
}

/// The same for the cosine of an entry, by the midpoint rule.
fn half_way_of(entry: usize) -> [f64; 2] {
    const STEPS: u32 = 32;
    let cosine = squared_fraction(entry, COSINES);
    let wo = Vec3::new((1.0 - cosine * cosine).sqrt(), 0.0, cosine);
    let step = |k: u32| (f64::from(k) + 0.5) / f64::from(STEPS);
    let pairs = (0..STEPS).flat_map(|i| (0..STEPS).map(move |j| [i, j]));
    let sum: f64 = pairs
        .map(|[i, j]| {
            // Half a turn is enough, by symmetry.
            let wi = direction_at_angle(step(i).sqrt(), step(j) * 0.5);
            schlick(wo.dot((wo + wi).normalize()))
        })
        .sum();
    [sum / f64::from(STEPS * STEPS), 0.0]
}

/// The position of an entry on its axis, from 0 to 1.
fn fraction(entry: usize, count: usize) -> f64 {
    entry as f64 / (count - 1) as f64
}

/// Its square: the position on an axis that is denser towards 0.
fn squared_fraction(entry: usize, count: usize) -> f64 {
    fraction(entry, count) * fraction(entry, count)
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

/// Interpolates linearly along each of `D` axes of a table: the position on each, from 0 to 1, and
/// its number of entries.
fn interpolate<const D: usize, const N: usize>(
    table: &[[f32; N]],
    axes: [(f64, usize); D],
) -> [f64; N] {
    let places = axes.map(|(fraction, count)| (place(fraction, count), count));
    let mut sum = [0.0; N];
    for corner in 0..1_usize << D {
        let (mut index, mut weight) = (0, 1.0);
        for (axis, ((entry, rest), count)) in places.iter().enumerate() {
            let is_next = corner >> axis & 1;
            index = index * count + entry + is_next;
            weight *= if is_next == 1 { *rest } else { 1.0 - rest };
        }
        for (sum, value) in sum.iter_mut().zip(table[index]) {
            *sum += weight * f64::from(value);
        }
    }
    sum
}

/// The numbers of a stored table, which lie in [−1, 1] and are stored as whole numbers.
fn stored<const N: usize>(packed: &[u8], axes: &[usize]) -> Vec<[f32; N]> {
    let number = |bytes| f32::from(i16::from_le_bytes(bytes)) / f32::from(i16::MAX);
    let entries = unpack(packed, axes).into_iter();
    entries.map(|entry| entry.map(number)).collect()
}

#[cfg(test)]
mod tests;
