//! A diffuse base below the boundary of a dielectric: light enters, is scattered, and leaves or is
//! reflected inside again and again.
//!
//! The reflected radiance of the base is `ρ/(π·η²)·T(θ_o)·T(θ_i)/(1 − ρ'·R)` with the transmittance
//! T of the boundary from outside and its mean reflectance R from inside. Where each reflection
//! inside takes the colour of the base again, ρ' is its albedo ρ, else 1 (Mitsuba's `plastic` and
//! `roughplastic`, whose tables of 64 cosines these are).

use super::compensation::Covering;
use super::distribution::FacetDistribution;
use super::fresnel::{dielectric_curve, normal_reflectance, refracted_cosine};
use rtc_math::{Microfacets, Plastic, Vec3};
use std::f64::consts::FRAC_1_PI;

/// The boundary above a base.
#[derive(Clone, Debug, PartialEq)]
pub struct PlasticBoundary {
    plastic: Plastic,
    /// η of the inside over that of the outside.
    ior: f64,
    /// The roughness that the table is of.
    roughness: f64,
    /// R, the mean reflectance from inside.
    reflectance: f64,
    /// The mean of T over the hemisphere, weighted by the cosine.
    mean: f64,
    /// T at the cosines k/63; empty for a smooth boundary.
    transmittance: Vec<f64>,
}

/// The cosines of a table.
const COSINES: usize = 64;

impl PlasticBoundary {
    /// A boundary of the roughness and index given.
    #[must_use]
    pub fn new(plastic: Plastic, ior: f64, roughness: f64, model: Microfacets) -> Self {
        let facets = FacetDistribution::isotropic(roughness).of_model(model);
        let cosine = |k: usize| (k as f64 / (COSINES - 1) as f64).max(1e-6);
        let is_smooth = facets.is_smooth() || plastic == Plastic::Single;
        let weighted = |of: &dyn Fn(usize) -> f64| {
            let sum: f64 = (0..COSINES).map(|k| cosine(k) * of(k)).sum();
            2.0 * sum / COSINES as f64
        };
        let (reflectance, mean, transmittance) = if is_smooth {
            let mean = smooth_transmittance(ior);
            (1.0 - mean / (ior * ior), mean, Vec::new())
        } else {
            let inside = weighted(&|k| mean_inside(facets, cosine(k), ior));
            let table = (0..COSINES).map(|k| mean_transmitted(facets, cosine(k), ior));
            let table: Vec<f64> = table.collect();
            let mean = weighted(&|k| table[k]);
            // What is let in cannot leave more often than it comes.
            (inside.min(1.0 - mean / (ior * ior)), mean, table)
        };
        Self {
            plastic,
            ior,
            roughness,
            reflectance,
            mean,
            transmittance,
        }
    }

    /// Whether it is that of a surface of the roughness given.
    pub(super) fn is_of(&self, roughness: f64) -> bool {
        self.roughness == roughness
    }

    /// T for the cosine outside.
    fn transmitted(&self, cosine: f64) -> f64 {
        let Some(last) = self.transmittance.len().checked_sub(1) else {
            return 1.0 - reflectance(cosine, self.ior);
        };
        let place = cosine.clamp(0.0, 1.0) * last as f64;
        let k = (place as usize).min(last - 1);
        let share = place - k as f64;
        self.transmittance[k] * (1.0 - share) + self.transmittance[k + 1] * share
    }

    /// The factor of `T(θ_o)·T(θ_i)` for a base of this albedo.
    fn scattered(&self, albedo: Vec3) -> Vec3 {
        let left = 1.0 / (self.ior * self.ior);
        match self.plastic {
            Plastic::None | Plastic::Single => albedo,
            Plastic::Linear => albedo * (left / (1.0 - self.reflectance)),
            Plastic::Nonlinear => albedo * left / (Vec3::ONE - albedo * self.reflectance),
        }
    }
}

/// The base as one viewer sees it.
#[derive(Clone, Copy, Debug)]
pub(super) struct PlasticBase<'world> {
    boundary: &'world PlasticBoundary,
    /// The BRDF but for the transmittance towards the light.
    f: Vec3,
    /// The transmittance towards the viewer.
    towards_viewer: f64,
    /// What covers it where that is not the boundary that it is prepared for alone: facets with a
    /// film, drawn out, or of another roughness by a map.
    covering: Option<Covering>,
}

impl<'world> PlasticBase<'world> {
    /// A base that scatters the fraction `scattered` of the light, with the albedo given.
    pub(super) fn new(
        boundary: &'world PlasticBoundary,
        albedo: Vec3,
        scattered: f64,
        covering: Option<Covering>,
        wo: Vec3,
    ) -> Self {
        let towards_viewer = transmitted(boundary, covering.as_ref(), wo);
        Self {
            boundary,
            f: boundary.scattered(albedo) * (scattered * FRAC_1_PI * towards_viewer),
            towards_viewer,
            covering,
        }
    }

    /// The transmittance towards the light.
    fn transmitted(&self, wi: Vec3) -> f64 {
        transmitted(self.boundary, self.covering.as_ref(), wi)
    }

    /// The BSDF of a white base that lets all light through that enters: it sends
    /// `T(θ_o)` of a uniform sky.
    pub(super) fn through_f(&self, wi: Vec3) -> f64 {
        self.towards_viewer * self.transmitted(wi) * (FRAC_1_PI / self.boundary.mean)
    }

    /// The BRDF for light from a direction.
    pub(super) fn f(&self, wi: Vec3) -> Vec3 {
        self.f * self.transmitted(wi)
    }

    /// About the fraction of a uniform sky's light that it shows, to choose lobes by.
    pub(super) fn albedo(&self) -> Vec3 {
        /// The transmittance at this cosine is about the mean.
        const MEAN: f64 = 0.6;
        self.f * (self.boundary.transmitted(MEAN) / FRAC_1_PI)
    }
}

/// The transmittance of a boundary from outside: no more than what its covering leaves.
fn transmitted(boundary: &PlasticBoundary, covering: Option<&Covering>, w: Vec3) -> f64 {
    let own = boundary.transmitted(w.z);
    covering.map_or(own, |covering| own.min((1.0 - covering.albedo(w)).max(0.0)))
}

/// The reflectance by Fresnel's equations from outside.
fn reflectance(cosine: f64, ior: f64) -> f64 {
    let normal = normal_reflectance(ior);
    normal + (1.0 - normal) * dielectric_curve(cosine, ior)
}

/// The mean over all directions outside of the transmittance of a smooth boundary, by the midpoint
/// rule. Of the light inside, which is `η²` times as wide, it is the fraction that leaves.
fn smooth_transmittance(ior: f64) -> f64 {
    const STEPS: u32 = 512;
    let passed = |k: u32| {
        // Sample the cosine evenly: its square root at grazing angles is smooth then.
        let cosine = (f64::from(k) + 0.5) / f64::from(STEPS);
        2.0 * cosine * (1.0 - reflectance(cosine, ior))
    };
    (0..STEPS).map(passed).sum::<f64>() / f64::from(STEPS)
}

/// Normals over which a mean is taken.
const NORMALS: u32 = 1024;

/// The mean of a function of the visible normals from a cosine.
fn mean_over_normals(
    facets: FacetDistribution,
    cosine: f64,
    at: impl Fn(Vec3, Vec3) -> f64,
) -> f64 {
    /// The inverse of the golden ratio.
    const GOLDEN: f64 = 0.618_033_988_749_894_9;
    let wo = Vec3::new((1.0 - cosine * cosine).sqrt(), 0.0, cosine);
    let value = |k: u32| {
        let k = f64::from(k) + 0.5;
        let u = [k / f64::from(NORMALS), (k * GOLDEN).fract()];
        at(wo, facets.visible_normal(wo, u))
    };
    (0..NORMALS).map(value).sum::<f64>() / f64::from(NORMALS)
}

/// The fraction of light from a cosine outside that a rough boundary refracts once.
fn mean_transmitted(facets: FacetDistribution, cosine: f64, ior: f64) -> f64 {
    mean_over_normals(facets, cosine, |wo, h| {
        let o = wo.dot(h);
        let Some(beyond) = refracted_cosine(o, ior).filter(|_| o > 0.0) else {
            return 0.0;
        };
        let wi = h * (o / ior - beyond) - wo / ior;
        if wi.z < 0.0 {
            (1.0 - reflectance(o, ior)) * facets.masking(wi)
        } else {
            0.0
        }
    })
}

/// The fraction of light from a cosine inside that a rough boundary reflects once.
fn mean_inside(facets: FacetDistribution, cosine: f64, ior: f64) -> f64 {
    mean_over_normals(facets, cosine, |wo, h| {
        let o = wo.dot(h);
        let wi = h * (2.0 * o) - wo;
        if o <= 0.0 || wi.z <= 0.0 {
            return 0.0;
        }
        let reflected =
            refracted_cosine(o, 1.0 / ior).map_or(1.0, |outside| reflectance(outside, ior));
        reflected * facets.masking(wi)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// R, and T at cosines 1, 0.6 and 0.2 of Mitsuba 3.9's `roughplastic` of index 1.5, read from
    /// its BSDF.
    #[test]
    fn rough_boundaries_are_those_of_mitsuba() {
        let known = [
            (
                Microfacets::SeparableGgx,
                0.1,
                0.5519,
                [0.9596, 0.9310, 0.7153],
            ),
            (
                Microfacets::SeparableGgx,
                0.5,
                0.2900,
                [0.9402, 0.8700, 0.6971],
            ),
            (Microfacets::Beckmann, 0.1, 0.5810, [0.9600, 0.9342, 0.6794]),
            (Microfacets::Beckmann, 0.5, 0.4417, [0.9586, 0.9190, 0.8395]),
        ];
        for (model, alpha, inside, outside) in known {
            let roughness = f64::sqrt(alpha);
            let boundary = PlasticBoundary::new(Plastic::Linear, 1.5, roughness, model);
            let seen = boundary.reflectance;
            assert!((seen - inside).abs() < 2e-3, "{model:?} {alpha}: {seen}");
            for (cosine, expected) in [1.0, 0.6, 0.2].into_iter().zip(outside) {
                let seen = boundary.transmitted(cosine);
                assert!(
                    (seen - expected).abs() < 2e-3,
                    "{model:?} {alpha} {cosine}: {seen}"
                );
            }
        }
    }

    #[test]
    fn a_smooth_boundary_of_glass_reflects_three_fifths_inside() {
        // 0.5963: Egan, Hilgeman, "Optical properties of inhomogeneous materials" (1979).
        let inside = 1.0 - smooth_transmittance(1.5) / 2.25;
        assert!((inside - 0.5963).abs() < 1e-3);
    }
}
