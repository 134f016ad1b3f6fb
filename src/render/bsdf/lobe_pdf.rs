//! The probability of sampling each lobe of a material.

use super::coat::CoatLayer;
use super::microfacet::LobeWeights;
use super::sheen::SheenFibres;
use rtc_math::Vec3;

/// The mean of the channels: the weight of a lobe for its probability.
fn mean(color: Vec3) -> f64 {
    color.element_sum() / 3.0
}

/// The probability of sampling each lobe. They sum to 1, or to 0 for a black surface.
#[derive(Clone, Copy, Debug)]
pub(super) struct LobePdf {
    pub(super) cosine: f64,
    pub(super) microfacet: f64,
    pub(super) through: f64,
    pub(super) coat: f64,
}

impl LobePdf {
    /// Probabilities proportional to the estimated albedo of each lobe: the diffuse base,
    /// reflecting and transmitting, and the microfacets, below sheen and coat.
    #[inline]
    pub(super) fn new(
        base: Vec3,
        through: Vec3,
        weights: &LobeWeights,
        sheen: Option<&SheenFibres>,
        coat: Option<&CoatLayer>,
    ) -> Self {
        let (mut cosine, mut through) = (mean(base).max(0.0), mean(through));
        let mut microfacet = mean(weights.reflected + weights.through);
        if let Some(sheen) = sheen {
            (cosine, microfacet) = (cosine * sheen.left + sheen.albedo, microfacet * sheen.left);
            through *= sheen.left;
        }
        let coat = coat.map_or(0.0, |coat| coat.weight);
        let whole = (cosine + microfacet + through) * (1.0 - coat) + coat;
        let scale = if whole > 0.0 { 1.0 / whole } else { 0.0 };
        let below = scale * (1.0 - coat);
        Self {
            cosine: cosine * below,
            microfacet: microfacet * below,
            through: through * below,
            coat: coat * scale,
        }
    }
}
