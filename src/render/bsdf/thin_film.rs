//! Interference in a thin transparent film over a surface: KHR_materials_iridescence.
//!
//! After Belcour, Barla, "A practical extension to microfacet theory for the modeling of varying
//! iridescence" (SIGGRAPH 2017): two orders of internal reflection, their spectra integrated in
//! closed form with the eye's sensitivities.

use super::fresnel::{normal_reflectance, schlick};
use rtc_math::{Vec3, cos, exp};
use std::f64::consts::{PI, TAU};

/// A film.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct ThinFilm {
    /// Its index of refraction, at least 1.
    pub(super) ior: f64,
    /// Its thickness in nanometres.
    pub(super) thickness: f64,
}

impl ThinFilm {
    /// The reflectance of the film on a surface that bare would reflect `f0` at normal incidence,
    /// each channel in [0, 1].
    #[must_use]
    #[inline(never)]
    pub(super) fn reflectance(&self, f0: Vec3, cosine: f64) -> Vec3 {
        let film = self.effective_ior();
        // Refract into the film.
        let square = 1.0 - (1.0 - cosine * cosine) / (film * film);
        if square < 0.0 {
            return Vec3::ONE;
        }
        let inside = square.sqrt();
        // Reflectances of the upper and of the lower boundary, and the phase that reflection off a
        // denser medium shifts.
        let upper = normal_reflectance(film);
        let r12 = upper + (1.0 - upper) * schlick(cosine);
        let t121 = 1.0 - r12;
        let base = f0.map(|f0| index_of(f0.clamp(0.0, 0.9999)));
        let r1 = base.map(|base| normal_reflectance(base / film));
        let r23 = r1 + (Vec3::ONE - r1) * schlick(inside);
        let shift = base.map(|base| if base < film { TAU } else { PI });
        // Sum the orders of interference.
        let difference = 2.0 * film * self.thickness * inside;
        let r123 = (r23 * r12).clamp(Vec3::splat(1e-5), Vec3::splat(0.9999));
        let amplitude = r123.map(f64::sqrt);
        let rs = r23 * (t121 * t121) / (Vec3::ONE - r123);
        let mut sum = rs + r12;
        let mut order_weight = rs - t121;
        for order in [1.0, 2.0] {
            order_weight *= amplitude;
            sum += order_weight * 2.0 * sensitivity(order * difference, shift * order);
        }
        sum.clamp(Vec3::ZERO, Vec3::ONE)
    }

    /// The index, fading to that of air where the film is too thin to be one.
    fn effective_ior(&self) -> f64 {
        let x = (self.thickness / 0.03).clamp(0.0, 1.0);
        1.0 + (self.ior - 1.0) * (x * x * (3.0 - 2.0 * x))
    }
}

/// The index of the medium that reflects `f0` at normal incidence in air.
fn index_of(f0: f64) -> f64 {
    let root = f0.sqrt();
    (1.0 + root) / (1.0 - root)
}

/// The Fourier transform of the eye's sensitivities at an optical path difference in nanometres, in
/// linear Rec. 709.
fn sensitivity(difference: f64, shift: Vec3) -> Vec3 {
    /// Amplitude, mean and variance of the Gaussians fitted to x̄, ȳ and z̄, and of the second one
    /// of x̄.
    const LOBES: [(f64, f64, f64); 4] = [
        (5.4856e-13, 1.6810e6, 4.3278e9),
        (4.4201e-13, 1.7953e6, 9.3046e9),
        (5.2481e-13, 2.2084e6, 6.6121e9),
        (9.7470e-14, 2.2399e6, 4.5282e9),
    ];
    const WHITE: f64 = 1.0685e-7;
    let phase = TAU * difference * 1e-9;
    let lobe = |(height, place, variance): (f64, f64, f64), shift: f64| {
        height
            * (TAU * variance).sqrt()
            * cos(place * phase + shift)
            * exp(-phase * phase * variance)
            / WHITE
    };
    let x = lobe(LOBES[0], shift.x) + lobe(LOBES[3], shift.x);
    let (y, z) = (lobe(LOBES[1], shift.y), lobe(LOBES[2], shift.z));
    Vec3::new(
        3.240_454_2 * x - 1.537_138_5 * y - 0.498_531_4 * z,
        -0.969_266 * x + 1.876_010_8 * y + 0.041_556 * z,
        0.055_643_4 * x - 0.204_025_9 * y + 1.057_225_2 * z,
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_film_of_no_thickness_changes_nothing_at_normal_incidence() {
        let f0 = Vec3::new(0.04, 0.3, 0.9);
        let difference = ThinFilm {
            ior: 1.3,
            thickness: 0.0,
        }
        .reflectance(f0, 1.0)
            - f0;
        // The fitted sensitivities integrate to white within a few per cent.
        assert!(difference.abs().max_element() < 0.04, "{difference}");
    }

    #[test]
    fn colour_changes_with_thickness_and_angle() {
        let at = |thickness, cosine| {
            ThinFilm {
                ior: 1.3,
                thickness,
            }
            .reflectance(Vec3::splat(0.04), cosine)
        };
        assert!((at(300.0, 1.0) - at(450.0, 1.0)).abs().max_element() > 0.01);
        assert!((at(400.0, 1.0) - at(400.0, 0.5)).abs().max_element() > 0.01);
        assert!((0..100).all(|k| at(f64::from(k) * 10.0, 0.3).is_finite()));
    }
}
