//! The sheen of cloth: KHR_materials_sheen.
//!
//! After Estevez, Kulla, "Production friendly microfacet sheen BRDF" (2017): upright fibres with a
//! fitted shadowing term.

use super::albedo::tables;
use super::standard::Sheen;
use rtc_math::{Vec3, exp, pow};
use std::f64::consts::TAU;

/// The fibres on a surface as one viewer sees them.
#[derive(Clone, Copy, Debug)]
pub(super) struct SheenFibres {
    charlie: CharlieSheen,
    color: Vec3,
    /// The albedo of the formula for the viewer.
    towards_viewer: f64,
    /// The albedo of the sheen, in the strongest channel.
    pub(super) albedo: f64,
    /// The fraction of light that reaches the layers below.
    pub(super) left: f64,
}

impl SheenFibres {
    /// The sheen for one viewer; `None` if it is black.
    pub(super) fn new(sheen: &Sheen, wo: Vec3) -> Option<Self> {
        let charlie = CharlieSheen::new(sheen.roughness);
        let towards_viewer = charlie.albedo(wo.z);
        let albedo = sheen.color.max_element() * towards_viewer.min(1.0);
        (sheen.color != Vec3::ZERO).then_some(Self {
            charlie,
            color: sheen.color,
            towards_viewer,
            albedo,
            left: 1.0 - albedo,
        })
    }

    /// Adds the sheen to the BSDF of the layers below, which is scaled by the smaller of the
    /// fractions that pass on the way in and out. The formula gains energy at some angles, so it is
    /// divided there by its albedo, the larger one of both directions.
    pub(super) fn over(&self, below: Vec3, wo: Vec3, wi: Vec3) -> Vec3 {
        let towards_light = self.charlie.albedo(wi.z.abs());
        let own = if wi.z > 0.0 {
            let albedo = self.towards_viewer.max(towards_light);
            self.color * (self.charlie.f(wo, wi) / albedo.max(1.0))
        } else {
            Vec3::ZERO
        };
        below * self.left_by(towards_light) + own
    }

    /// The fraction of light that passes the sheen towards `wi`.
    pub(super) fn left_for(&self, wi: Vec3) -> f64 {
        self.left_by(self.charlie.albedo(wi.z.abs()))
    }

    /// The same, by the albedo of the formula towards the light.
    fn left_by(&self, albedo: f64) -> f64 {
        self.left
            .min(1.0 - self.color.max_element() * albedo.min(1.0))
    }
}

/// Sheen of one roughness.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct CharlieSheen {
    alpha: f64,
    roughness: f64,
}

impl CharlieSheen {
    /// The sheen of a roughness; below 0.02 the lobe would be infinitely thin.
    #[must_use]
    pub(super) fn new(roughness: f64) -> Self {
        let roughness = roughness.clamp(0.02, 1.0);
        Self {
            alpha: roughness * roughness,
            roughness,
        }
    }

    /// The BRDF of white sheen, as the paper has it.
    #[must_use]
    pub(super) fn f(&self, wo: Vec3, wi: Vec3) -> f64 {
        let h = (wo + wi).normalize();
        let sine = ((1.0 - h.z) * (1.0 + h.z)).max(0.0).sqrt();
        let density = (2.0 + 1.0 / self.alpha) * pow(sine, 1.0 / self.alpha) / TAU;
        let shadowing = 1.0 / (1.0 + self.lambda(wo.z) + self.lambda(wi.z));
        density * (shadowing / (4.0 * wo.z * wi.z)).min(1.0)
    }

    /// The directional albedo of that; at some angles above 1.
    #[must_use]
    pub(super) fn albedo(&self, cosine: f64) -> f64 {
        tables().sheen(self.roughness, cosine)
    }

    fn lambda(&self, cosine: f64) -> f64 {
        if cosine < 0.5 {
            return exp(self.fit(cosine));
        }
        exp(2.0 * self.fit(0.5) - self.fit(1.0 - cosine))
    }

    /// The fit of table 1 of the paper.
    fn fit(&self, x: f64) -> f64 {
        let smooth = (1.0 - self.alpha) * (1.0 - self.alpha);
        let between = |rough: f64, thin: f64| rough + (thin - rough) * smooth;
        let (a, b) = (between(21.5473, 25.3245), between(3.82987, 3.32435));
        let (c, d, e) = (
            between(0.19823, 0.16801),
            between(-1.97760, -1.27393),
            between(-4.32054, -4.85967),
        );
        a / (1.0 + b * pow(x, c)) + d * x + e
    }
}

/// The albedo of the formula by the midpoint rule over the hemisphere of directions.
#[cfg(test)]
pub(super) fn integrated_albedo(roughness: f64, cosine: f64) -> f64 {
    const STEPS: u32 = 48;
    let charlie = CharlieSheen::new(roughness);
    let wo = Vec3::new((1.0 - cosine * cosine).sqrt(), 0.0, cosine);
    let step = |k: u32| (f64::from(k) + 0.5) / f64::from(STEPS);
    let mut sum = 0.0;
    for i in 0..STEPS {
        for j in 0..STEPS {
            // Half a turn is enough, by symmetry.
            let wi = super::warp::direction_at_angle(step(i), step(j) * 0.5);
            sum += charlie.f(wo, wi) * wi.z;
        }
    }
    sum * TAU / f64::from(STEPS * STEPS)
}
