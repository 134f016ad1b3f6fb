//! Directional albedos of the lobes, tabulated over cosine and roughness.
//!
//! The tables are integrated at first use, by the same functions that shade.

use super::fresnel::schlick;
use super::ggx::Ggx;
use super::sheen::integrated_albedo;
use crate::math::Vec3;
use std::sync::LazyLock;

/// Entries along the cosine, denser towards grazing: entry i is at (i/(n − 1))².
const COSINES: usize = 32;

/// Entries along the roughness.
const ROUGHNESSES: usize = 64;

/// Normals per entry.
const NORMALS: u32 = 256;

/// The tables.
pub(super) struct Tables {
    /// The terms of the albedo in f0 and in f90.
    specular: Vec<[f64; 2]>,
    sheen: LazyLock<Vec<[f64; 2]>>,
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

/// The tables, made at the first call.
pub(super) fn tables() -> &'static Tables {
    static TABLES: LazyLock<Tables> = LazyLock::new(Tables::new);
    &TABLES
}

impl Tables {
    fn new() -> Self {
        let specular = table(integrated_specular);
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
            sheen: LazyLock::new(|| table(|r, cosine| [integrated_albedo(r, cosine), 0.0])),
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

fn table(entry: impl Fn(f64, f64) -> [f64; 2]) -> Vec<[f64; 2]> {
    let fraction = |k: usize, count: usize| k as f64 / (count - 1) as f64;
    let cosine = |k: usize| (fraction(k, COSINES) * fraction(k, COSINES)).max(1e-6);
    let row = |r: usize| (0..COSINES).map(move |k| (fraction(r, ROUGHNESSES), cosine(k)));
    (0..ROUGHNESSES)
        .flat_map(row)
        .map(|(roughness, cosine)| entry(roughness, cosine))
        .collect()
}

/// Both terms of the albedo, over visible normals of a rank-1 lattice.
fn integrated_specular(roughness: f64, cosine: f64) -> [f64; 2] {
    /// The inverse of the golden ratio.
    const GOLDEN: f64 = 0.618_033_988_749_894_9;
    let ggx = Ggx::isotropic(roughness);
    let wo = Vec3::new((1.0 - cosine * cosine).sqrt(), 0.0, cosine);
    if ggx.is_smooth() {
        return [1.0 - schlick(cosine), schlick(cosine)];
    }
    let mut sum = [0.0; 2];
    for k in 0..NORMALS {
        let k = f64::from(k) + 0.5;
        // Place more samples in the long tail of the slopes, with smaller weights.
        let rest = 1.0 - k / f64::from(NORMALS);
        // Sample a visible normal, and reflect.
        let h = ggx.visible_normal(wo, [1.0 - rest * rest, (k * GOLDEN).fract()]);
        let cosine = wo.dot(h);
        let wi = h * (2.0 * cosine) - wo;
        if wi.z > 0.0 {
            // f·cos θ/pdf for a lobe that reflects everything: G₂/G₁.
            let weight = 4.0 * rest * wi.z * (wo.z + ggx.stretched(wo)) * ggx.visibility(wo, wi);
            let grazing = schlick(cosine);
            sum = [sum[0] + (1.0 - grazing) * weight, sum[1] + grazing * weight];
        }
    }
    sum.map(|term| term / f64::from(NORMALS))
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
