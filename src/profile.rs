//! How the intensity of a light without extent depends on the direction.
//!
//! A distribution is added here: the stages know no more of it than what [`Profile`] answers.

use crate::math::{Vec3, cos};
use std::f64::consts::{FRAC_PI_2, TAU};

/// The distribution of intensity over directions, as factors of the light's own intensity.
#[derive(Clone, Debug, PartialEq)]
pub enum Profile {
    /// The same in all directions.
    Uniform,
    /// All of it inside a cone, none outside of a wider one.
    Cone {
        /// The unit axis, away from the light.
        axis: Vec3,
        /// The cosine of the inner angle.
        inner: f64,
        /// The cosine of the outer angle, less than that of the inner one.
        outer: f64,
    },
}

impl Profile {
    /// The profile of a spot light: a unit axis, and the angles from it in radians.
    ///
    /// # Errors
    /// What is wrong with the angles, unless 0 ≤ inner < outer ≤ π/2, up to rounding.
    pub fn cone(axis: Vec3, inner: f64, outer: f64) -> Result<Self, String> {
        if !(0.0 <= inner && inner < outer && outer <= FRAC_PI_2 * (1.0 + 1e-6)) {
            return Err(format!(
                "a spot light has an inner angle of {inner} and an outer one of {outer}: 0 ≤ inner \
                 < outer ≤ π/2 is needed"
            ));
        }
        Ok(Self::Cone {
            axis,
            inner: cos(inner),
            outer: cos(outer),
        })
    }

    /// The factor in a unit direction away from the light, 0 to 1.
    #[inline]
    #[must_use]
    pub fn factor(&self, direction: Vec3) -> f64 {
        match self {
            Self::Uniform => 1.0,
            Self::Cone { axis, inner, outer } => {
                // KHR_lights_punctual: the square of a ramp between the cosines.
                let ramp = ((direction.dot(*axis) - outer) / (inner - outer)).clamp(0.0, 1.0);
                ramp * ramp
            }
        }
    }

    /// About the solid angle that the light shines into, in steradians.
    #[must_use]
    pub fn solid_angle(&self) -> f64 {
        match self {
            Self::Uniform => 2.0 * TAU,
            Self::Cone { outer, .. } => TAU * (1.0 - outer),
        }
    }

    /// Whether it is 0 in all directions.
    #[must_use]
    pub fn is_dark(&self) -> bool {
        match self {
            Self::Uniform | Self::Cone { .. } => false,
        }
    }

    /// A cone outside of which all factors are 0: its unit axis, and the cosine of its half angle,
    /// at least 0.
    #[must_use]
    pub fn bounding_cone(&self) -> Option<(Vec3, f64)> {
        match self {
            Self::Uniform => None,
            Self::Cone { axis, outer, .. } => Some((*axis, *outer)),
        }
    }
}
