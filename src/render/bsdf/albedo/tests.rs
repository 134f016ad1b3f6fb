//! The tables, integrated.

use super::super::fresnel::schlick;
use super::super::ggx::Ggx;
use super::super::sheen::integrated_albedo;
use super::*;
use rtc_math::Vec3;

/// Normals per entry.
const NORMALS: u32 = 256;

/// The entries of a table, in their order.
fn table<T>(entry: impl Fn(f64, f64) -> T) -> Vec<T> {
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

#[test]
#[expect(clippy::disallowed_methods, reason = "this is how the tables are made")]
fn the_stored_tables_are_the_integrals() {
    let specular = table(integrated_specular).into_iter().flatten();
    let numbers = specular.chain(table(integrated_albedo));
    let bytes = numbers.flat_map(f64::to_le_bytes).collect::<Vec<_>>();
    if std::env::var_os("RTC_UPDATE").is_some() {
        let file = concat!(env!("CARGO_MANIFEST_DIR"), "/src/render/bsdf/albedo.bin");
        std::fs::write(file, bytes).unwrap();
        return;
    }
    let differs = bytes
        .iter()
        .zip(&STORED)
        .position(|(own, stored)| own != stored);
    assert_eq!((differs, bytes.len()), (None, STORED.len()));
}
