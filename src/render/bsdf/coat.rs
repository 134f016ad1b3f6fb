//! The clearcoat layer, with its own roughness and normal (`KHR_materials_clearcoat`).

use super::distribution::FacetDistribution;
use super::fresnel::schlick;
use super::standard::Clearcoat;
use rtc_math::{OrthonormalBasis, Vec3};

/// The layer as one viewer sees it.
#[derive(Clone, Copy, Debug)]
pub(super) struct CoatLayer {
    basis: OrthonormalBasis,
    ggx: FacetDistribution,
    wo: Vec3,
    /// The fraction of light it reflects: the cover times Schlick's reflectance at index 1.5 for
    /// the viewer.
    pub(super) weight: f64,
}

impl CoatLayer {
    /// The coat for one viewer; `None` if the viewer cannot see it.
    pub(super) fn new(clearcoat: &Clearcoat, normal: Vec3, wo: Vec3) -> Option<Self> {
        let basis = OrthonormalBasis::around(normal);
        let wo = basis.to_local(wo);
        let weight = clearcoat.factor * (0.04 + 0.96 * schlick(wo.z));
        (wo.z > 0.0 && weight > 0.0).then(|| Self {
            basis,
            ggx: FacetDistribution::isotropic(clearcoat.roughness),
            wo,
            weight,
        })
    }

    /// Whether it is a mirror.
    pub(super) fn is_smooth(&self) -> bool {
        self.ggx.is_smooth()
    }

    /// The BRDF without its reflectance, times the cosine to the normal of the coat over that to
    /// the surface, which is positive; and the density of [`CoatLayer::sample`].
    pub(super) fn evaluate(&self, wi: Vec3) -> (f64, f64) {
        let above = wi.z;
        let wi = self.basis.to_local(wi);
        if self.ggx.is_smooth() || wi.z <= 0.0 {
            return (0.0, 0.0);
        }
        let h = (self.wo + wi).normalize();
        let f = self.ggx.density(h) * self.ggx.visibility(self.wo, wi);
        (f * (wi.z / above), self.ggx.vndf_pdf(self.wo, h) / 4.0)
    }

    /// Samples a direction that the coat reflects to the viewer; `None` below its own horizon.
    pub(super) fn sample(&self, u: [f64; 2]) -> Option<Vec3> {
        let h = if self.is_smooth() {
            Vec3::Z
        } else {
            self.ggx.visible_normal(self.wo, u)
        };
        let wi = h * (2.0 * self.wo.dot(h)) - self.wo;
        (wi.z > 0.0).then(|| self.basis.to_world(wi))
    }
}
