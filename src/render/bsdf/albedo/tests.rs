//! The tables, integrated.

use super::super::distribution::FacetDistribution;
use super::super::fresnel::{dielectric_curve, refracted_cosine, schlick};
use super::super::sheen::integrated_albedo;
use super::packed::pack;
use super::*;
use rtc_math::Vec3;

/// Normals per entry.
const NORMALS: u32 = 256;

/// The entries of a table, in their order.
fn table<T>(entry: impl Fn(f64, f64) -> T) -> Vec<T> {
    let row =
        |r: usize| (0..COSINES).map(move |k| (fraction(r, ROUGHNESSES), cosine_of(k, COSINES)));
    (0..ROUGHNESSES)
        .flat_map(row)
        .map(|(roughness, cosine)| entry(roughness, cosine))
        .collect()
}

/// The mean of `at` over visible normals, of a rank-1 lattice. It is given each normal, and the
/// function f·cos θ/pdf of a direction for a lobe that takes everything there, G₂/G₁.
fn mean_over_normals<const N: usize>(
    ggx: FacetDistribution,
    wo: Vec3,
    at: impl Fn(Vec3, &dyn Fn(Vec3) -> f64) -> [f64; N],
) -> [f64; N] {
    /// The inverse of the golden ratio.
    const GOLDEN: f64 = 0.618_033_988_749_894_9;
    if ggx.is_smooth() {
        return at(Vec3::Z, &|_| 1.0);
    }
    let mut sum = [0.0; N];
    for k in 0..NORMALS {
        let k = f64::from(k) + 0.5;
        // ValuePath more samples in the long tail of the slopes, with smaller weights.
        let rest = 1.0 - k / f64::from(NORMALS);
        let h = ggx.visible_normal(wo, [1.0 - rest * rest, (k * GOLDEN).fract()]);
        let weight = |wi: Vec3| {
            4.0 * rest * wi.z.abs() * (wo.z + ggx.lambda_root(wo)) * ggx.visibility(wo, wi)
        };
        let terms = at(h, &weight);
        sum = std::array::from_fn(|term| sum[term] + terms[term]);
    }
    sum.map(|term| term / f64::from(NORMALS))
}

fn mirrored(wo: Vec3, h: Vec3) -> Vec3 {
    h * (2.0 * wo.dot(h)) - wo
}

/// Both terms of the light reflected by a reflectance curve.
fn reflected(wo: Vec3, h: Vec3, weight: &dyn Fn(Vec3) -> f64, curve: f64) -> [f64; 2] {
    let wi = mirrored(wo, h);
    let weight = if wi.z > 0.0 { weight(wi) } else { 0.0 };
    [(1.0 - curve) * weight, curve * weight]
}

/// Both terms of the albedo.
fn integrated_specular(ggx: FacetDistribution, wo: Vec3) -> [f64; 2] {
    mean_over_normals(ggx, wo, |h, weight| {
        reflected(wo, h, weight, schlick(wo.dot(h)))
    })
}

fn view(cosine: f64) -> Vec3 {
    Vec3::new((1.0 - cosine * cosine).sqrt(), 0.0, cosine)
}

/// The contribution of a visible normal of glass to its seven numbers.
fn integrated_dielectric(ior: f64, ggx: FacetDistribution, wo: Vec3) -> [f64; 7] {
    let transmitted = |h: Vec3, eta: f64, beyond: f64, weight: &dyn Fn(Vec3) -> f64, curve: f64| {
        let wi = h * (wo.dot(h) / eta - beyond) - wo / eta;
        let weight = if wi.z < 0.0 { weight(wi) } else { 0.0 };
        [(1.0 - curve) * weight, curve * weight]
    };
    let [r0, r90, t0, t90] = mean_over_normals(ggx, wo, |h, weight| {
        let cosine = wo.dot(h);
        let curve = dielectric_curve(cosine, ior);
        let [r0, r90] = reflected(wo, h, weight, curve);
        let beyond = refracted_cosine(cosine, ior).unwrap_or(0.0);
        let [t0, t90] = transmitted(h, ior, beyond, weight, curve);
        [r0, r90, t0, t90]
    });
    let [total, e0, e90] = mean_over_normals(ggx, wo, |h, weight| {
        let Some(outside) = refracted_cosine(wo.dot(h), 1.0 / ior) else {
            let [r0, r90] = reflected(wo, h, weight, 1.0);
            return [r0 + r90, 0.0, 0.0];
        };
        let curve = dielectric_curve(outside, ior);
        let [r0, r90] = reflected(wo, h, weight, curve);
        let [t0, t90] = transmitted(h, 1.0 / ior, outside, weight, curve);
        [t0 + t90, r0 - t0, r90 - t90]
    });
    [r0, r90, t0, t90, total, e0, e90]
}

/// The cosine at an entry.
fn cosine_of(k: usize, count: usize) -> f64 {
    squared_fraction(k, count).max(1e-6)
}

fn dielectric_table() -> Vec<f64> {
    use dielectric::{COSINES, INDICES, ROUGHNESSES};
    let mut numbers = Vec::new();
    for index in 0..INDICES {
        let ior = 1.0 + 2.0 * squared_fraction(index, INDICES);
        for roughness in 0..ROUGHNESSES {
            let ggx = FacetDistribution::isotropic(fraction(roughness, ROUGHNESSES));
            let views = (0..COSINES).map(|k| view(cosine_of(k, COSINES)));
            numbers.extend(views.flat_map(|wo| integrated_dielectric(ior, ggx, wo)));
        }
    }
    numbers
}

fn anisotropic_table() -> Vec<f64> {
    use anisotropic::{COSINES, TURNS, WIDTHS};
    let width = |k: usize| squared_fraction(k, WIDTHS);
    let mut numbers = Vec::new();
    for x in 0..WIDTHS {
        for y in 0..WIDTHS {
            let ggx = FacetDistribution::of_widths([width(x), width(y)]);
            for k in 0..COSINES {
                for turn in 0..TURNS {
                    let across = view(cosine_of(k, COSINES));
                    let along = squared_fraction(turn, TURNS) * squared_fraction(turn, TURNS);
                    let [x, y] = [along.sqrt(), (1.0 - along).sqrt()];
                    let wo = Vec3::new(across.x * x, across.x * y, across.z);
                    numbers.extend(integrated_specular(ggx, wo));
                }
            }
        }
    }
    numbers
}

/// Compares a table with the stored one, or writes it.
#[expect(clippy::disallowed_methods, reason = "this is how the tables are made")]
fn is_stored<const W: usize, const N: usize>(
    name: &str,
    table: &[[[u8; W]; N]],
    axes: &[usize],
    stored: &[u8],
) {
    if std::env::var_os("RTC_UPDATE").is_some() {
        let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/bsdf/");
        std::fs::write(format!("{folder}{name}"), pack(table, axes)).unwrap();
        return;
    }
    let stored = unpack::<W, N>(stored, axes);
    let differs = table
        .iter()
        .zip(&stored)
        .position(|(own, stored)| own != stored);
    assert_eq!((differs, table.len()), (None, stored.len()), "{name}");
}

#[test]
fn the_stored_tables_are_the_integrals() {
    let entry = |roughness, cosine| {
        let ggx = FacetDistribution::isotropic(roughness);
        let [e0, e90] = integrated_specular(ggx, view(cosine));
        [e0, e90, integrated_albedo(roughness, cosine)].map(f64::to_le_bytes)
    };
    is_stored("albedo.bin", &table(entry), &AXES, &STORED);
}

/// The entries of a table of whole numbers.
#[expect(
    clippy::cast_possible_truncation,
    reason = "the tables are of whole numbers"
)]
fn whole<const N: usize>(numbers: &[f64]) -> Vec<[[u8; 2]; N]> {
    let whole = |number: f64| (number * f64::from(i16::MAX)).round() as i16;
    let (entries, _) = numbers.as_chunks::<N>();
    let entry = |entry: &[f64; N]| entry.map(|number| whole(number).to_le_bytes());
    entries.iter().map(entry).collect()
}

#[test]
fn the_tables_of_dielectrics_and_of_anisotropy_are_the_integrals() {
    is_stored(
        "albedo/dielectric.bin",
        &whole::<7>(&dielectric_table()),
        &dielectric::AXES,
        &dielectric::STORED,
    );
    is_stored(
        "albedo/anisotropic.bin",
        &whole::<2>(&anisotropic_table()),
        &anisotropic::AXES,
        &anisotropic::STORED,
    );
}
