//! Numbers and colours used as weights.

use super::{UnitInterval, Vec3};

/// A factor that may be zero.
pub trait Weight: Copy {
    /// The weight of an absent term.
    const NOTHING: Self;

    /// Whether it is above zero.
    fn is_nonzero(self) -> bool;
}

impl Weight for f64 {
    const NOTHING: Self = 0.0;

    #[inline]
    fn is_nonzero(self) -> bool {
        self > 0.0
    }
}

impl Weight for UnitInterval {
    const NOTHING: Self = Self::ZERO;

    #[inline]
    fn is_nonzero(self) -> bool {
        self > Self::ZERO
    }
}

/// A colour weighs something if any channel does.
impl Weight for Vec3 {
    const NOTHING: Self = Self::ZERO;

    #[inline]
    fn is_nonzero(self) -> bool {
        self != Self::ZERO
    }
}
