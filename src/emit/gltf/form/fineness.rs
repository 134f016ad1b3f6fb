//! How fine a mesh is: how far it may be from the shape it stands for.

use rtc_math::{atan2, shortest};
use std::f64::consts::PI;

/// The share of its own radius that a shape may be off, if no length is given: at 500 pixels across
/// a quarter of one.
const SHARE: f64 = 1e-3;
/// The fewest steps around a circle.
const FEWEST: u32 = 12;

/// The farthest that a mesh may be from its shape, beside the rounding to 32-bit floats.
pub(super) struct Fineness(Option<f64>);

impl Fineness {
    /// A length in scene units; none for a share of the radius of each shape.
    pub(super) fn new(tolerance: Option<f64>) -> Self {
        Self(tolerance)
    }

    /// As it is told.
    pub(super) fn words(&self) -> String {
        match self.0 {
            Some(length) => format!("within {} of it", shortest(length)),
            None => format!("within {} of its radius", shortest(SHARE)),
        }
    }

    /// How far a shape of this size may be off, as a share of it.
    pub(super) fn share(&self, radius: f64) -> f64 {
        self.0.map_or(SHARE, |length| length / radius)
    }

    /// Steps around a circle whose chords are off by no more than a share of its radius: those of
    /// half an angle θ with 1 − cos θ = share.
    pub(super) fn around(share: f64) -> u32 {
        steps(PI / half_angle(share), FEWEST)
    }

    /// Steps along half a turn of a sphere, whose triangles have legs of this angle δ: their
    /// middles are farthest off, by 1 − cos(δ/√2) of the radius.
    pub(super) fn along_sphere(share: f64) -> u32 {
        steps(
            PI / (half_angle(share) * std::f64::consts::SQRT_2),
            FEWEST / 2,
        )
    }

    /// Steps along a parabola over the radius 1 with this height: a chord over the step s is off
    /// by height·s²/4.
    pub(super) fn along_parabola(height: f64, share: f64) -> u32 {
        steps((height / (4.0 * share)).sqrt(), 2)
    }

    /// Steps along each side of a bilinear patch with this twist |a − b + c − d|, in the lengths of
    /// its size: the diagonal of a cell of side s is off by twist·s²/4.
    pub(super) fn along_patch(twist: f64, share: f64) -> u32 {
        steps((twist / (4.0 * share)).sqrt(), 1)
    }
}

/// The angle θ with 1 − cos θ = share, at most a quarter of a turn.
fn half_angle(share: f64) -> f64 {
    let half = (share / 2.0).clamp(0.0, 0.5);
    2.0 * atan2(half.sqrt(), (1.0 - half).sqrt())
}

/// Whole steps, at least so many.
fn steps(count: f64, fewest: u32) -> u32 {
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "what is beyond the range is brought into it"
    )]
    let whole = count.ceil() as u32;
    whole.clamp(fewest, u32::MAX >> 2)
}
