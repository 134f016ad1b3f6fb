//! Participating media.

use super::decode::Spanned;
use super::lower::Lowering;
use super::number::Real;
use super::record::record;
use super::value::Channels;
use rtc_ir::{EntityField, EntityKind, Medium};

record! {
    /// A homogeneous participating medium, as fog, smoke, milk or wax. Lengths are in scene units;
    /// a coefficient is a list of red, green and blue, or one number for all.
    struct MediumCoefficients, "medium" {
        /// The absorption coefficient σ_a per unit of length.
        sigma_a: Spanned<Channels>, default(Channels([0.0; 3])), &[&["sigmaA"]];
        /// The scattering coefficient σ_s per unit of length.
        sigma_s: Spanned<Channels>, default(Channels([0.0; 3])), &[&["sigmaS"]];
        /// The mean cosine of the scattering angle, above −1 and below 1: positive numbers scatter
        /// light forwards, 0 into all directions (Henyey and Greenstein).
        g: Spanned<Real>, default(Real(0.0)), &[&["g"]];
    }
}

impl MediumCoefficients {
    /// The medium of the IR.
    pub(super) fn lowered(&self) -> Medium {
        Medium {
            sigma_a: self.sigma_a.value.0,
            sigma_s: self.sigma_s.value.0,
            g: self.g.value.0,
        }
    }
}

impl Lowering {
    /// Lowers the medium around the camera.
    pub(super) fn medium(&mut self, medium: &Spanned<MediumCoefficients>) {
        self.scene.medium = Some(medium.value.lowered());
        self.record_span(EntityKind::Medium, 0, EntityField::Whole, medium.span);
    }
}
