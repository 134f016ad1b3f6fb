//! Spots whose edges fall off by the formula of another renderer.

use rtc_ir::{Photometry, PunctualKind};
use rtc_math::Vec3;

/// A light whose intensity depends on the angle from its axis: pairs of an angle in degrees,
/// ascending from 0 to at most 180, and a factor of at least 0. In between it is linear, beyond the
/// last angle it is 0.
pub(crate) fn falling(position: Vec3, axis: Vec3, falloff: &[(f64, f64)]) -> PunctualKind {
    PunctualKind::Photometric {
        position: position.to_array(),
        direction: axis.to_array(),
        horizontal: axis.any_orthonormal_vector().to_array(),
        photometry: Box::new(Photometry {
            name: "spot".to_owned(),
            vertical: falloff.iter().map(|(angle, _)| *angle).collect(),
            horizontal: vec![0.0],
            candela: falloff.iter().map(|(_, factor)| *factor).collect(),
        }),
    }
}
