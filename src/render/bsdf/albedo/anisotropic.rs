//! The albedo of anisotropic microfacets: a table over both widths α, the cosine, and the azimuth.

use super::super::distribution::FacetDistribution;
use super::{SchlickAlbedo, interpolate, squared_fraction, stored};
use rtc_math::Vec3;
use std::sync::LazyLock;

/// Entries along the square root of each width.
pub(super) const WIDTHS: usize = 12;

/// Entries along the cosine, denser towards grazing as in the other tables.
pub(super) const COSINES: usize = 16;

/// Entries along √|cos φ|, from across the wider axis to along it: across it, at grazing angles,
/// the albedo is steep.
pub(super) const TURNS: usize = 5;

/// The axes of the table.
pub(super) const AXES: [usize; 4] = [WIDTHS, WIDTHS, COSINES, TURNS];

/// The terms in f0 and in f90, packed.
pub(super) static STORED: [u8; 2 * 2 * WIDTHS * WIDTHS * COSINES * TURNS] =
    *include_bytes!("anisotropic.bin");

/// The albedo seen from a direction.
pub(crate) fn albedo(surface: FacetDistribution, w: Vec3) -> SchlickAlbedo {
    let [x, y] = [w.x * w.x, w.y * w.y];
    let turn = if x + y > 0.0 { x / (x + y) } else { 0.0 };
    look_up(surface, w.z, turn)
}

/// Its mean over the hemisphere, weighted by the cosine.
pub(crate) fn mean(surface: FacetDistribution) -> SchlickAlbedo {
    static MEANS: LazyLock<Vec<[f32; 2]>> = LazyLock::new(means);
    let [e0, e90] = interpolate(&MEANS, surface.widths().map(|width| (width.sqrt(), WIDTHS)));
    SchlickAlbedo { e0, e90 }
}

/// For each pair of widths, by the midpoint rule over interpolated entries: ∫ 2μ·E(μ) dμ, μ = x².
#[expect(clippy::cast_possible_truncation, reason = "the tables are of f32")]
fn means() -> Vec<[f32; 2]> {
    const STEPS: u32 = 64;
    /// A quarter of a turn is enough, by symmetry.
    const PARTS: u32 = 8;
    let step = |k: u32, count: u32| (f64::from(k) + 0.5) / f64::from(count);
    let of = |surface: FacetDistribution| {
        let mut sum = [0.0; 2];
        for k in 0..STEPS {
            let x = step(k, STEPS);
            for part in 0..PARTS {
                let cosine = rtc_math::cos(step(part, PARTS) * std::f64::consts::FRAC_PI_2);
                let SchlickAlbedo { e0, e90 } = look_up(surface, x * x, cosine * cosine);
                let weight = 4.0 * x * x * x / f64::from(STEPS * PARTS);
                sum = [sum[0] + weight * e0, sum[1] + weight * e90];
            }
        }
        sum.map(|term| term as f32)
    };
    let pairs = (0..WIDTHS).flat_map(|x| (0..WIDTHS).map(move |y| [x, y]));
    pairs
        .map(|pair| {
            of(FacetDistribution::of_widths(
                pair.map(|k| squared_fraction(k, WIDTHS)),
            ))
        })
        .collect()
}

fn look_up(surface: FacetDistribution, cosine: f64, turn: f64) -> SchlickAlbedo {
    static TABLE: LazyLock<Vec<[f32; 2]>> = LazyLock::new(|| stored(&STORED, &AXES));
    let [x, y] = surface.widths();
    // The wider axis is the first one.
    let ([x, y], turn) = match x < y {
        true => ([y, x], 1.0 - turn),
        false => ([x, y], turn),
    };
    let axes = [
        (x.sqrt(), WIDTHS),
        (y.sqrt(), WIDTHS),
        (cosine.max(0.0).sqrt(), COSINES),
        (turn.max(0.0).sqrt().sqrt(), TURNS),
    ];
    let [e0, e90] = interpolate(&TABLE, axes);
    SchlickAlbedo { e0, e90 }
}
