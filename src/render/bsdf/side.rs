//! The side of a surface that faces the viewer, flipped so that it has z > 0.

use rtc_math::Vec3;

/// The rotation of the frame that brings the viewer above and the anisotropy along x.
#[derive(Clone, Copy, Debug)]
pub(super) struct Side {
    pub(super) below: bool,
    pub(super) along: [f64; 2],
}

impl Side {
    /// From the frame of the surface.
    #[inline]
    pub(super) fn enter(self, w: Vec3) -> Vec3 {
        let [c, s] = self.along;
        Vec3::new(
            c * w.x + s * w.y,
            c * w.y - s * w.x,
            if self.below { -w.z } else { w.z },
        )
    }

    /// Back to it.
    #[inline]
    pub(super) fn leave(self, w: Vec3) -> Vec3 {
        let [c, s] = self.along;
        Vec3::new(
            c * w.x - s * w.y,
            c * w.y + s * w.x,
            if self.below { -w.z } else { w.z },
        )
    }
}
