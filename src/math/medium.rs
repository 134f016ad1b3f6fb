//! Homogeneous participating media.

use arbitrary::Arbitrary;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A homogeneous participating medium: of the light along a ray of length t a part e^(−σ_t·t)
/// arrives, where σ_t = σ_a + σ_s (Pharr, Jakob, Humphreys, "Physically Based Rendering", 4th ed.,
/// §11.1).
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema, Arbitrary)]
#[serde(rename_all = "camelCase", deny_unknown_fields, default)]
pub struct Medium {
    /// The absorption coefficient σ_a per unit of length at red, green and blue, each at least 0.
    #[schemars(inner(range(min = 0.0)))]
    pub sigma_a: [f64; 3],
    /// The scattering coefficient σ_s per unit of length at red, green and blue, each at least 0.
    #[schemars(inner(range(min = 0.0)))]
    pub sigma_s: [f64; 3],
    /// The mean cosine g of the scattering angle, above −1 and below 1, of the phase function of
    /// Henyey and Greenstein; 0 scatters light equally into all directions.
    #[schemars(extend("exclusiveMinimum" = -1, "exclusiveMaximum" = 1))]
    pub g: f64,
}

impl Medium {
    /// The medium of an extinction coefficient σ_t, of which the albedo is the part that scatters.
    #[must_use]
    pub fn of_albedo(sigma_t: [f64; 3], albedo: [f64; 3], g: f64) -> Self {
        let part = |share: fn(f64) -> f64| {
            std::array::from_fn(|channel| sigma_t[channel] * share(albedo[channel]))
        };
        Self {
            sigma_a: part(|albedo| 1.0 - albedo),
            sigma_s: part(|albedo| albedo),
            g,
        }
    }

    /// Whether it changes no light.
    #[must_use]
    pub fn is_clear(&self) -> bool {
        [self.sigma_a, self.sigma_s] == [[0.0; 3]; 2]
    }

    /// Whether it scatters light.
    #[must_use]
    pub fn scatters(&self) -> bool {
        self.sigma_s != [0.0; 3]
    }
}
