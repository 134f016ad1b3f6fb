//! Mappings from the unit square to directions.

use rtc_math::{Vec3, cos_sin_revolutions};
use std::f64::consts::PI;

/// The unit vector with the z given and the azimuth in units of 2π, in [0, 1).
#[must_use]
#[inline]
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "a share of a turn; the cast saturates"
)]
pub(crate) fn direction_at_angle(z: f64, turns: f64) -> Vec3 {
    /// 2⁶⁴.
    const TURN: f64 = 18_446_744_073_709_551_616.0;
    let sine = ((1.0 - z) * (1.0 + z)).max(0.0).sqrt();
    let (x, y) = cos_sin_revolutions((turns * TURN) as u64);
    Vec3::new(sine * x, sine * y, z)
}

/// A direction around z with the density [`cosine_density`].
#[must_use]
#[inline]
pub(super) fn cosine_direction(u: [f64; 2]) -> Vec3 {
    direction_at_angle((1.0 - u[0]).sqrt(), u[1])
}

/// `cos θ/π`.
#[must_use]
#[inline]
pub(super) fn cosine_density(w: Vec3) -> f64 {
    w.z / PI
}
