//! Reconstruction filters of pixels (Pharr, Jakob, Humphreys, "Physically Based Rendering" (4th
//! ed.), §8.8): products of one function for both axes.

use crate::{exp, sin};
use arbitrary::Arbitrary;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::f64::consts::PI;

/// How the light around the middle of a pixel is weighted. Distances and radii are in pixels along
/// each axis; beyond the radius the weight is 0.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema, Arbitrary)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
pub enum PixelFilter {
    /// All light within the radius equally: with 0.5 the pixel itself.
    Box {
        /// Above 0.
        #[schemars(extend("exclusiveMinimum" = 0))]
        radius: f64,
    },
    /// Linearly less to the radius.
    Tent {
        /// Above 0.
        #[schemars(extend("exclusiveMinimum" = 0))]
        radius: f64,
    },
    /// A normal distribution, minus its value at the radius.
    Gaussian {
        /// The standard deviation, above 0.
        #[schemars(extend("exclusiveMinimum" = 0))]
        deviation: f64,
        /// Above 0.
        #[schemars(extend("exclusiveMinimum" = 0))]
        radius: f64,
    },
    /// The cubic of Mitchell and Netravali, "Reconstruction filters in computer graphics"
    /// (SIGGRAPH 1988); with b = 0 and c = 1/2 that of Catmull and Rom.
    Mitchell {
        /// The blur.
        b: f64,
        /// The ringing.
        c: f64,
        /// Above 0.
        #[schemars(extend("exclusiveMinimum" = 0))]
        radius: f64,
    },
    /// The sine cardinal, times one that is as wide as the window (Lanczos).
    Lanczos {
        /// The zero of the window, above 0.
        #[schemars(extend("exclusiveMinimum" = 0))]
        window: f64,
        /// Above 0.
        #[schemars(extend("exclusiveMinimum" = 0))]
        radius: f64,
    },
}

impl Default for PixelFilter {
    fn default() -> Self {
        Self::PIXEL
    }
}

impl PixelFilter {
    /// The pixel itself.
    pub const PIXEL: Self = Self::Box { radius: 0.5 };

    /// The cubic of Catmull and Rom.
    pub const CATMULL_ROM: Self = Self::Mitchell {
        b: 0.0,
        c: 0.5,
        radius: 2.0,
    };

    /// Whether it is the pixel itself.
    #[must_use]
    pub fn is_pixel(&self) -> bool {
        *self == Self::PIXEL
    }

    /// Its radius along each axis.
    #[must_use]
    pub fn radius(&self) -> f64 {
        match self {
            Self::Box { radius }
            | Self::Tent { radius }
            | Self::Gaussian { radius, .. }
            | Self::Mitchell { radius, .. }
            | Self::Lanczos { radius, .. } => *radius,
        }
    }

    /// The weight at a distance from the middle along one axis, up to a factor.
    #[must_use]
    pub fn weight(&self, distance: f64) -> f64 {
        let (x, radius) = (distance.abs(), self.radius());
        if x > radius {
            return 0.0;
        }
        match *self {
            Self::Box { .. } => 1.0,
            Self::Tent { .. } => 1.0 - x / radius,
            Self::Gaussian { deviation, .. } => {
                let normal = |x: f64| exp(-0.5 * (x / deviation) * (x / deviation));
                (normal(x) - normal(radius)).max(0.0)
            }
            Self::Mitchell { b, c, .. } => mitchell(2.0 * x / radius, b, c),
            Self::Lanczos { window, .. } => sine_cardinal(x) * sine_cardinal(x / window),
        }
    }
}

/// The cubic of Mitchell and Netravali at x in [0, 2], equation 8.
fn mitchell(x: f64, b: f64, c: f64) -> f64 {
    let polynomial = |[p, q, r, s]: [f64; 4]| ((p * x + q) * x + r) * x + s;
    let sixth = match x < 1.0 {
        true => polynomial([
            12.0 - 9.0 * b - 6.0 * c,
            -18.0 + 12.0 * b + 6.0 * c,
            0.0,
            6.0 - 2.0 * b,
        ]),
        false => polynomial([
            -b - 6.0 * c,
            6.0 * b + 30.0 * c,
            -12.0 * b - 48.0 * c,
            8.0 * b + 24.0 * c,
        ]),
    };
    sixth / 6.0
}

/// sin(πx)/πx.
fn sine_cardinal(x: f64) -> f64 {
    match x.abs() < 1e-5 {
        true => 1.0,
        false => sin(PI * x) / (PI * x),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn filters_have_their_known_values() {
        let third = PixelFilter::Mitchell {
            b: 1.0 / 3.0,
            c: 1.0 / 3.0,
            radius: 2.0,
        };
        let lanczos = PixelFilter::Lanczos {
            window: 3.0,
            radius: 3.0,
        };
        for (filter, distance, known) in [
            (PixelFilter::PIXEL, 0.4, 1.0),
            (PixelFilter::PIXEL, -0.6, 0.0),
            (PixelFilter::Tent { radius: 2.0 }, -0.5, 0.75),
            (third, 0.0, 8.0 / 9.0),
            (third, 1.0, 1.0 / 18.0),
            (third, 2.0, 0.0),
            (PixelFilter::CATMULL_ROM, 0.0, 1.0),
            (PixelFilter::CATMULL_ROM, 1.0, 0.0),
            (PixelFilter::CATMULL_ROM, 1.5, -0.0625),
            (lanczos, 0.0, 1.0),
            (lanczos, 1.0, 0.0),
        ] {
            let weight = filter.weight(distance);
            assert!(
                (weight - known).abs() < 1e-12,
                "{filter:?} {distance}: {weight}"
            );
        }
    }
}
