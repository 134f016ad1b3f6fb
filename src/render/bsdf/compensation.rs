//! Compensation of the energy that single scattering between microfacets loses.
//!
//! Kulla, Conty, "Revisiting physically based shading at Imageworks" (2017): a diffuse lobe returns
//! exactly the lost energy, and the diffuse base receives exactly what both lobes transmit. Both
//! are reciprocal. A white surface in a white environment stays white.

use super::albedo::{SchlickAlbedo, anisotropic, half_way, tables};
use super::distribution::FacetDistribution;
use super::fresnel::{Curve, Fresnel};
use rtc_math::{Microfacets, Vec3};
use std::f64::consts::PI;

/// The compensation at one point for one direction to the viewer.
#[derive(Clone, Copy, Debug)]
pub(super) struct Compensation {
    surface: FacetDistribution,
    /// 1 − E(μ) for the viewer and in the mean.
    missing: f64,
    missing_mean: f64,
    /// The fraction of the missing energy that multiple bounces return.
    returned: Vec3,
    base: DiffuseBase,
}

/// The energy that the dielectric reflection leaves to the diffuse base.
#[derive(Clone, Copy, Debug)]
struct DiffuseBase {
    f0: f64,
    f90: f64,
    returned: f64,
    left: f64,
    left_mean: f64,
}

impl DiffuseBase {
    /// The albedo of the reflection above the base: at least that of Schlick's curve, and of facets
    /// that all reflect the fraction `uneven`.
    fn covered(&self, e: SchlickAlbedo, uneven: f64) -> f64 {
        let single = e.at(self.f0, self.f90).max(e.whole() * uneven);
        single + self.returned * (1.0 - e.whole())
    }
}

/// The fraction of multiply scattered light that leaves the surface: `F²·E/(1 − F·(1 − E))` with
/// the means of F and E.
fn returned(mean: Vec3, missing: f64) -> Vec3 {
    let whole = mean * mean * (1.0 - missing) / (Vec3::ONE - mean * missing);
    whole.clamp(Vec3::ZERO, Vec3::ONE)
}

/// A diffuse lobe by the fractions of light that pass at either direction and in the mean.
fn product(here: f64, there: f64, mean: f64) -> f64 {
    if mean > 0.0 {
        (here * there / (mean * PI)).max(0.0)
    } else {
        0.0
    }
}

/// The albedo of white microfacets seen from a direction.
fn albedo(surface: FacetDistribution, w: Vec3) -> SchlickAlbedo {
    if surface.is_isotropic() {
        tables().specular(surface.mean_roughness(), w.z)
    } else {
        anisotropic::albedo(surface, w)
    }
}

/// Its mean over the hemisphere, weighted by the cosine.
fn mean_albedo(surface: FacetDistribution) -> SchlickAlbedo {
    if surface.is_isotropic() {
        tables().specular_mean(surface.mean_roughness())
    } else {
        anisotropic::mean(surface)
    }
}

impl Compensation {
    /// For a surface with this `metallic` fraction. Where the reflectance of the dielectric does
    /// not follow Schlick's curve, it is `uneven` towards the viewer; else that is 0.
    #[must_use]
    pub(super) fn new(
        surface: FacetDistribution,
        wo: Vec3,
        [dielectric, metal]: [&Fresnel; 2],
        metallic: f64,
        uneven: f64,
    ) -> Self {
        // Look up the directional and the mean albedo.
        let (e, mean) = (albedo(surface, wo), mean_albedo(surface));
        // Return the energy that a single bounce loses.
        let missing_mean = 1.0 - mean.whole();
        let from_dielectric = returned(dielectric.mean(), missing_mean);
        let from_metal = if metallic > 0.0 {
            returned(metal.mean(), missing_mean)
        } else {
            Vec3::ZERO
        };
        let (f0, f90) = (
            dielectric.at(1.0).max_element(),
            dielectric.f90.max_element(),
        );
        let mut base = DiffuseBase {
            f0,
            f90,
            returned: from_dielectric.max_element(),
            left: 0.0,
            left_mean: 0.0,
        };
        base.left = 1.0 - base.covered(e, uneven);
        base.left_mean = 1.0 - base.covered(mean, 0.0);
        Self {
            surface,
            missing: 1.0 - e.whole(),
            missing_mean,
            returned: from_dielectric.lerp(from_metal, metallic),
            base,
        }
    }

    /// The albedo of the lobe of further bounces.
    #[must_use]
    pub(super) fn albedo(&self) -> Vec3 {
        self.returned * self.missing
    }

    /// The albedo of a white base.
    #[must_use]
    pub(super) fn base_albedo(&self) -> f64 {
        self.base.left
    }

    /// The albedo of white microfacets towards a direction.
    pub(super) fn towards(&self, wi: Vec3) -> SchlickAlbedo {
        albedo(self.surface, wi)
    }

    /// The BSDF of a white base, by the albedo [`Self::towards`] the light and an uneven
    /// reflectance there.
    #[must_use]
    pub(super) fn base_f(&self, e: SchlickAlbedo, uneven: f64) -> f64 {
        product(
            self.base.left,
            1.0 - self.base.covered(e, uneven),
            self.base.left_mean,
        )
    }

    /// The BRDF of the further bounces, by the albedo [`Self::towards`] the light.
    #[must_use]
    pub(super) fn bounces_f(&self, e: SchlickAlbedo) -> Vec3 {
        self.returned * product(self.missing, 1.0 - e.whole(), self.missing_mean)
    }
}

/// The facets of a dielectric above a base.
#[derive(Clone, Copy, Debug)]
pub(super) struct Covering {
    pub(super) facets: FacetDistribution,
    pub(super) dielectric: Fresnel,
    /// Whether it is a smooth pane, which reflects inside it again and again.
    pub(super) is_pane: bool,
}

impl Covering {
    /// The reflectance of a facet at a cosine.
    fn at(&self, cosine: f64) -> f64 {
        let face = self.dielectric.at(cosine).max_element();
        if self.is_pane {
            face * 2.0 / (1.0 + face)
        } else {
            face
        }
    }

    /// The light that it reflects from a direction at least. Where the reflectance does not follow
    /// Schlick's curve, that towards the direction counts; and other facets than those of the
    /// tables are no darker at grazing angles than a mirror.
    pub(super) fn albedo(&self, w: Vec3) -> f64 {
        let e = albedo(self.facets, w);
        let Fresnel {
            f90, curve, film, ..
        } = &self.dielectric;
        let bare = e.at(self.dielectric.at(1.0).max_element(), f90.max_element());
        let is_tabulated = self.facets.model() == Microfacets::Ggx;
        let is_even = *curve == Curve::Schlick && film.is_none() && !self.is_pane;
        match is_tabulated {
            true if is_even => bare,
            true => bare.max(e.whole() * self.at(w.z)),
            false => bare.max(self.at(w.z)),
        }
    }
}

/// The factor of the diffuse base without further bounces: appendix B of glTF lets the base scatter
/// 1 − F of the half-way vector, and at grazing angles a surface would emit up to 1.7 times the
/// light it receives. It is 1 where the surface emits no more than that.
#[must_use]
pub(super) fn grazing_share(covering: &Covering, wo: Vec3) -> f64 {
    let f0 = covering.at(1.0);
    let f90 = covering.dielectric.f90.max_element();
    let reflected = covering.albedo(wo);
    if covering.is_pane || covering.dielectric.film.is_some() {
        // What a film or a pane lets through to the half-way vectors has no table.
        return (1.0 - reflected).max(0.0);
    }
    let base = 1.0 - f0 - (f90 - f0) * half_way(wo.z);
    if base > 0.0 {
        ((1.0 - reflected) / base).clamp(0.0, 1.0)
    } else {
        1.0
    }
}
