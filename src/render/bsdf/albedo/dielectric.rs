//! The albedo of a rough dielectric after single scattering, reflected and transmitted: tables over
//! the index of refraction, the roughness and the cosine.

use super::{SchlickAlbedo, interpolate, stored};
use std::sync::LazyLock;

/// Entries along the index, denser towards 1: entry i is at 1 + 2·(i/(n − 1))², and 3 includes
/// larger ones.
pub(super) const INDICES: usize = 24;

/// Entries along the roughness.
pub(super) const ROUGHNESSES: usize = 12;

/// Entries along the cosine, denser towards grazing as in the other tables.
pub(super) const COSINES: usize = 24;

/// The axes of the table.
pub(super) const AXES: [usize; 3] = [INDICES, ROUGHNESSES, COSINES];

/// Both factors of reflection and both of transmission from outside, then the three terms of both
/// together from inside; packed.
pub(super) static STORED: [u8; 7 * 2 * INDICES * ROUGHNESSES * COSINES] =
    *include_bytes!("dielectric.bin");

/// The reflected and transmitted light from inside: `total + f0·e0 + f90·e90`.
#[derive(Clone, Copy, Debug)]
pub(crate) struct InsideAlbedo {
    total: f64,
    split: SchlickAlbedo,
}

impl InsideAlbedo {
    /// By the reflectances at normal and at grazing incidence.
    #[must_use]
    pub(crate) fn at(self, f0: f64, f90: f64) -> f64 {
        self.total + self.split.at(f0, f90)
    }
}

/// The reflected light, and the light that would be refracted without reflection, by the terms of
/// f0 and f90.
pub(crate) fn outside(ior: f64, roughness: f64, cosine: f64) -> [SchlickAlbedo; 2] {
    let [r0, r90, t0, t90, ..] = look_up(ior, roughness, cosine);
    let split = |e0, e90| SchlickAlbedo { e0, e90 };
    [split(r0, r90), split(t0, t90)]
}

/// The reflected and transmitted light from inside.
pub(crate) fn inside(ior: f64, roughness: f64, cosine: f64) -> InsideAlbedo {
    let [.., total, e0, e90] = look_up(ior, roughness, cosine);
    let split = SchlickAlbedo { e0, e90 };
    InsideAlbedo { total, split }
}

fn look_up(ior: f64, roughness: f64, cosine: f64) -> [f64; 7] {
    static TABLE: LazyLock<Vec<[f32; 7]>> = LazyLock::new(|| stored(&STORED, &AXES));
    let index = (0.5 * (ior - 1.0)).max(0.0).sqrt();
    let axes = [
        (index, INDICES),
        (roughness, ROUGHNESSES),
        (cosine.max(0.0).sqrt(), COSINES),
    ];
    interpolate(&TABLE, axes)
}
