//! The distribution of microfacets: that of Trowbridge and Reitz (GGX), with Smith's masking for
//! both directions by the heights of the facets or as a product, or Beckmann's.
//!
//! Directions are unit vectors in a frame whose z is the normal of the surface; formulas as in glTF
//! 2.0, appendix B, and for anisotropy in Heitz, "Understanding the masking-shadowing function"
//! (JCGT 3, 2014).

use super::beckmann;
use super::warp::direction_at_angle;
use rtc_math::{Microfacets, Vec3};
use std::f64::consts::PI;

/// Surfaces with an α below this are mirrors: their lobes are narrower than a pixel can resolve.
const SMOOTH: f64 = 1e-5;

/// A rough surface: its roughness α along x and y.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct FacetDistribution {
    x: f64,
    y: f64,
    model: Microfacets,
}

impl FacetDistribution {
    /// The distribution of roughness 1.
    pub(super) const ROUGH: Self = Self {
        x: 1.0,
        y: 1.0,
        model: Microfacets::Ggx,
    };

    /// The same width, α = roughness², in all directions.
    #[must_use]
    pub(super) fn isotropic(roughness: f64) -> Self {
        let alpha = roughness * roughness;
        Self {
            x: alpha,
            y: alpha,
            model: Microfacets::Ggx,
        }
    }

    /// Stretched along x as KHR_materials_anisotropy says: αₓ = α + (1 − α)·strength².
    #[must_use]
    pub(super) fn anisotropic(roughness: f64, strength: f64) -> Self {
        let alpha = roughness * roughness;
        Self {
            x: alpha + (1.0 - alpha) * (strength * strength),
            y: alpha,
            model: Microfacets::Ggx,
        }
    }

    /// The same widths in another model.
    #[must_use]
    pub(super) fn of_model(self, model: Microfacets) -> Self {
        Self { model, ..self }
    }

    /// Whether the roughness is the same in all directions.
    #[must_use]
    pub(super) fn is_isotropic(self) -> bool {
        self.x == self.y
    }

    /// How the facets are distributed and hide each other.
    #[must_use]
    pub(super) fn model(self) -> Microfacets {
        self.model
    }

    /// The widths along x and y.
    #[must_use]
    pub(super) fn widths(self) -> [f64; 2] {
        [self.x, self.y]
    }

    /// The surface of two widths.
    #[must_use]
    pub(super) fn of_widths([x, y]: [f64; 2]) -> Self {
        Self {
            x,
            y,
            model: Microfacets::Ggx,
        }
    }

    /// Whether it is a mirror.
    #[must_use]
    pub(super) fn is_smooth(self) -> bool {
        self.x.max(self.y) < SMOOTH
    }

    /// The roughness of the isotropic surface of about the same albedo.
    #[must_use]
    pub(super) fn mean_roughness(self) -> f64 {
        (self.x * self.y).sqrt().sqrt()
    }

    /// The distribution D(h) of microfacet normals, per projected area.
    #[must_use]
    #[inline]
    pub(super) fn density(self, h: Vec3) -> f64 {
        let (x, y) = (self.width_x(), self.width_y());
        if self.model == Microfacets::Beckmann {
            return beckmann::density([x, y], h);
        }
        let lambda_root = Vec3::new(h.x / x, h.y / y, h.z).length_squared();
        1.0 / (PI * x * y * (lambda_root * lambda_root))
    }

    /// `|w_z|·(1 + 2·Λ)`, of GGX the length of `w` sloped to the surface of unit slopes.
    #[must_use]
    #[inline]
    pub(super) fn lambda_root(self, w: Vec3) -> f64 {
        let sloped = Vec3::new(w.x * self.x, w.y * self.y, w.z);
        match self.model {
            Microfacets::Ggx | Microfacets::SeparableGgx => sloped.length(),
            Microfacets::Beckmann => beckmann::lambda_root(sloped),
        }
    }

    /// `G₂/(4·|cos θ_o|·|cos θ_i|)`.
    #[must_use]
    #[inline]
    pub(super) fn visibility(self, wo: Vec3, wi: Vec3) -> f64 {
        let (o, i) = (wo.z.abs(), wi.z.abs());
        match self.model {
            Microfacets::Ggx => 0.5 / (i * self.lambda_root(wo) + o * self.lambda_root(wi)),
            Microfacets::SeparableGgx => {
                1.0 / ((o + self.lambda_root(wo)) * (i + self.lambda_root(wi)))
            }
            Microfacets::Beckmann => self.masking(wo) * self.masking(wi) / (4.0 * o * i),
        }
    }

    /// Smith's `G₁`, the share of the facets towards `w` that are seen from there; of Beckmann's
    /// distribution as the approximation has it that renderers use.
    #[must_use]
    pub(super) fn masking(self, w: Vec3) -> f64 {
        let sloped = Vec3::new(w.x * self.x, w.y * self.y, w.z);
        match self.model {
            Microfacets::Ggx | Microfacets::SeparableGgx => {
                2.0 * w.z.abs() / (w.z.abs() + sloped.length())
            }
            Microfacets::Beckmann => beckmann::masking(sloped),
        }
    }

    /// `G₂/G₁`: the share of the light that a visible facet sends from `wo` to `wi` which no other
    /// facet catches.
    #[must_use]
    pub(super) fn unhidden(self, wo: Vec3, wi: Vec3) -> f64 {
        2.0 * self.visibility(wo, wi) * wi.z.abs() * (wo.z + self.lambda_root(wo))
    }

    /// The density of the normals visible from `wo`, divided by `wo·h`: `G₁·D/cos θ_o`.
    #[must_use]
    #[inline]
    pub(super) fn vndf_pdf(self, wo: Vec3, h: Vec3) -> f64 {
        2.0 * self.density(h) / (wo.z + self.lambda_root(wo))
    }

    /// Samples a normal visible from `wo` (Dupuy, Benyoub, "Sampling visible GGX normals with
    /// spherical caps", 2023).
    #[must_use]
    #[inline]
    pub(super) fn visible_normal(self, wo: Vec3, u: [f64; 2]) -> Vec3 {
        let (x, y) = (self.width_x(), self.width_y());
        // Stretch to the hemisphere of unit slopes.
        let view = Vec3::new(wo.x * x, wo.y * y, wo.z).normalize();
        if self.model == Microfacets::Beckmann {
            let [slope_x, slope_y] = beckmann::visible_slope(view, u);
            return Vec3::new(-slope_x * x, -slope_y * y, 1.0).normalize();
        }
        // Sample the cap of directions that the hemisphere reflects `view` to.
        let z = (1.0 - u[0]) * (1.0 + view.z) - view.z;
        let cap = direction_at_angle(z, u[1]);
        // Take the half vector, and undo the stretch.
        let h = cap + view;
        Vec3::new(h.x * x, h.y * y, h.z.max(0.0)).normalize_or(Vec3::Z)
    }

    /// The width along x, never 0: along one axis alone a surface may be smooth.
    fn width_x(self) -> f64 {
        self.x.max(SMOOTH)
    }

    fn width_y(self) -> f64 {
        self.y.max(SMOOTH)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_microfacets_cover_the_surface_once() {
        for ggx in [
            FacetDistribution::isotropic(0.5),
            FacetDistribution::isotropic(1.0),
            FacetDistribution::anisotropic(0.5, 0.8),
            FacetDistribution::anisotropic(0.5, 0.8).of_model(Microfacets::Beckmann),
        ] {
            // ∫ D(h)·cos θ dω = 1, by the midpoint rule over cos²θ and φ.
            let n = 400;
            let mut sum = 0.0;
            for i in 0..n {
                for j in 0..n {
                    let z = ((f64::from(i) + 0.5) / f64::from(n)).sqrt();
                    let h = direction_at_angle(z, (f64::from(j) + 0.5) / f64::from(n));
                    sum += ggx.density(h) * PI / f64::from(n * n);
                }
            }
            assert!((sum - 1.0).abs() < 1e-3, "{ggx:?}: {sum}");
        }
    }

    #[test]
    fn a_smooth_axis_gives_no_infinity() {
        let ggx = FacetDistribution::anisotropic(0.0, 0.5);
        assert!(!ggx.is_smooth());
        let h = ggx.visible_normal(Vec3::new(0.6, 0.0, 0.8), [0.3, 0.7]);
        assert!(h.is_finite() && ggx.density(h).is_finite());
    }
}
