//! The random numbers of sampling: functions of the pixel, the sample and the bounces alone, by the
//! hashes of the renderer (`sampler` of `rtc_render`), written again.

use rtc_math::{fraction, golden_revolutions, mix};

/// The key of a vertex of a path.
#[derive(Clone, Copy)]
pub(super) struct CertifiedKey(u64);

impl CertifiedKey {
    /// The key of a camera ray.
    pub(super) fn new([x, y]: [u32; 2], sample: u64) -> Self {
        Self(mix(u64::from(x) << 32 | u64::from(y))).child(sample)
    }

    /// The key of a branch of the path.
    pub(super) fn child(self, branch: u64) -> Self {
        Self(mix(self.0.rotate_left(32) ^ mix(branch)))
    }

    /// 64 bits for a dimension.
    pub(super) fn bits(self, dimension: u64) -> u64 {
        self.child(dimension).0
    }

    /// A number in [0, 1) for a dimension: of 53 bits, exactly.
    pub(super) fn uniform(self, dimension: u64) -> f64 {
        fraction(self.bits(dimension))
    }
}

/// The angle of point k of a spiral, in units of 2⁻⁶⁴ turns.
pub(super) fn spiral_turns(k: u32, rotation: u64) -> u64 {
    golden_revolutions(k.into()).wrapping_add(rotation)
}
