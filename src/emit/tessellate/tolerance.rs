//! Tessellation: the number of steps for a given tolerance.

use rtc_math::{atan2, shortest};
use std::f64::consts::PI;

/// The default tolerance as a fraction of the radius of a shape: a quarter of a pixel if the shape
/// is 500 pixels wide.
const DEFAULT_TOLERANCE: f64 = 1e-3;
/// The minimum number of steps around a circle.
const MIN_STEPS: u32 = 12;

/// The maximum distance between a mesh and its shape, before rounding to f32.
pub(super) struct TessellationTolerance(Option<f64>);

impl TessellationTolerance {
    /// A length in scene units; `None` for a fraction of the radius of each shape.
    pub(super) fn new(tolerance: Option<f64>) -> Self {
        Self(tolerance)
    }

    /// The tolerance as a length in scene units, if it is one.
    pub(super) fn length(&self) -> Option<f64> {
        self.0
    }

    /// The tolerance, for messages.
    pub(super) fn describe(&self) -> String {
        match self.0 {
            Some(length) => format!("within {} of it", shortest(length)),
            None => format!("within {} of its radius", shortest(DEFAULT_TOLERANCE)),
        }
    }

    /// The tolerance for a shape of this radius, as a fraction of the radius.
    pub(super) fn fraction(&self, radius: f64) -> f64 {
        self.0.map_or(DEFAULT_TOLERANCE, |length| length / radius)
    }

    /// Steps around a circle whose chords deviate by at most `fraction` of the radius: the half
    /// angle θ satisfies 1 − cos θ = fraction.
    pub(super) fn around(fraction: f64) -> u32 {
        steps(PI / half_angle(fraction), MIN_STEPS)
    }

    /// Steps from pole to pole of a sphere whose triangles have legs of angle δ: their centres
    /// deviate most, by 1 − cos(δ/√2) of the radius.
    pub(super) fn along_sphere(fraction: f64) -> u32 {
        steps(
            PI / (half_angle(fraction) * std::f64::consts::SQRT_2),
            MIN_STEPS / 2,
        )
    }

    /// Steps along a parabola of radius 1 and this height: a chord over the step s deviates by
    /// height·s²/4.
    pub(super) fn along_parabola(height: f64, fraction: f64) -> u32 {
        steps((height / (4.0 * fraction)).sqrt(), 2)
    }

    /// Steps along each side of a bilinear patch with twist a − b + c − d , in units of its size:
    /// the diagonal of a cell of side s deviates by twist·s²/4.
    pub(super) fn along_patch(twist: f64, fraction: f64) -> u32 {
        steps((twist / (4.0 * fraction)).sqrt(), 1)
    }
}

/// The angle θ with 1 − cos θ = fraction, at most π/2.
fn half_angle(fraction: f64) -> f64 {
    let half = (fraction / 2.0).clamp(0.0, 0.5);
    2.0 * atan2(half.sqrt(), (1.0 - half).sqrt())
}

/// The number of steps rounded up, at least `min`.
fn steps(count: f64, fewest: u32) -> u32 {
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "what is beyond the range is brought into it"
    )]
    let integer = count.ceil() as u32;
    integer.clamp(fewest, u32::MAX >> 2)
}
