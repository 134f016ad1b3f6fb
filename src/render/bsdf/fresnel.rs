//! The Fresnel reflectance of a smooth interface: Schlick's approximation, the equations of
//! dielectrics for transmissive materials and of conductors, or thin-film interference.

use super::thin_film::ThinFilm;
use rtc_math::{ComplexIndex, Vec3};

/// The reflectance at normal incidence of a boundary between air and a medium with the index given.
///
/// 0 means an infinite index (KHR_materials_ior).
#[must_use]
pub(crate) fn normal_reflectance(ior: f64) -> f64 {
    let root = (ior - 1.0) / (ior + 1.0);
    root * root
}

/// The indices for red, green and blue of a medium of the index and dispersion (20/V_d) given, as
/// KHR_materials_dispersion approximates them; never below 1.
#[must_use]
pub fn dispersed(ior: f64, dispersion: f64) -> [f64; 3] {
    let half_spread = (ior - 1.0) * 0.025 * dispersion;
    [ior - half_spread, ior, ior + half_spread].map(|ior| ior.max(1.0))
}

/// `(1 − x)⁵`, the shape of Schlick's curve.
#[must_use]
#[inline]
pub(crate) fn schlick(cosine: f64) -> f64 {
    let x = (1.0 - cosine).clamp(0.0, 1.0);
    let square = x * x;
    square * square * x
}

/// The cosine of refraction by Snell's law; `None` for total internal reflection.
#[must_use]
pub(super) fn refracted_cosine(cosine: f64, eta: f64) -> Option<f64> {
    let square = 1.0 - (1.0 - cosine * cosine) / (eta * eta);
    (square > 0.0).then(|| square.sqrt())
}

/// The reflectance of unpolarised light by a boundary to a medium of an index of at least 1, from
/// outside (Pharr, Jakob, Humphreys, "Physically Based Rendering" (4th ed.), §9.3.5), scaled to go
/// from 0 at normal to 1 at grazing incidence.
#[must_use]
pub(super) fn dielectric_curve(cosine: f64, ior: f64) -> f64 {
    if ior == 1.0 {
        return 0.0;
    }
    let cosine = cosine.clamp(0.0, 1.0);
    let inside = refracted_cosine(cosine, ior).unwrap_or(0.0);
    let crosswise = (cosine - ior * inside) / (cosine + ior * inside);
    let along = (ior * cosine - inside) / (ior * cosine + inside);
    let normal = normal_reflectance(ior);
    let whole = 0.5 * (crosswise * crosswise + along * along);
    ((whole - normal) / (1.0 - normal)).clamp(0.0, 1.0)
}

/// How a reflectance grows from normal to grazing incidence.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Curve {
    /// Schlick's approximation.
    Schlick,
    /// That of a dielectric of this index.
    Dielectric(f64),
    /// That of a conductor, times a factor.
    Conductor(ComplexIndex, Vec3),
}

/// A reflectance over the angle: from `f0` at normal to `f90` at grazing incidence.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Fresnel {
    /// At normal incidence.
    pub(super) f0: Vec3,
    /// At grazing incidence.
    pub(super) f90: Vec3,
    /// The curve between.
    pub(super) curve: Curve,
    /// The film on it, and the fraction of the surface it covers.
    pub(super) film: Option<(ThinFilm, f64)>,
}

impl Fresnel {
    /// The reflectance at the cosine given.
    #[must_use]
    #[inline]
    pub(super) fn at(&self, cosine: f64) -> Vec3 {
        let between = |curve: f64| self.f0 + (self.f90 - self.f0) * curve;
        let bare = match &self.curve {
            Curve::Schlick => between(schlick(cosine)),
            Curve::Dielectric(ior) => between(dielectric_curve(cosine, *ior)),
            Curve::Conductor(index, tint) => index.reflectance(cosine) * *tint,
        };
        match &self.film {
            None => bare,
            Some((film, fraction)) => bare.lerp(film.reflectance(self.f0, cosine), *fraction),
        }
    }

    /// The mean over the hemisphere weighted by the cosine; with a film, as if its colour at normal
    /// incidence were that of the bare surface.
    #[must_use]
    pub(super) fn mean(&self) -> Vec3 {
        if let (Curve::Conductor(index, tint), None) = (&self.curve, &self.film) {
            return index.mean_reflectance() * *tint;
        }
        let f0 = self.at(1.0);
        f0 + (self.f90 - f0) / 21.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn glass_reflects_four_hundredths() {
        assert!((normal_reflectance(1.5) - 0.04).abs() < 1e-15);
        assert_eq!(normal_reflectance(0.0), 1.0);
        assert_eq!(normal_reflectance(1.0), 0.0);
    }

    #[test]
    fn the_mean_is_the_integral_over_the_hemisphere() {
        let fresnel = Fresnel {
            f0: Vec3::splat(0.2),
            f90: Vec3::ONE,
            curve: Curve::Schlick,
            film: None,
        };
        let n = 10_000;
        let at = |i: i32| (f64::from(i) + 0.5) / f64::from(n);
        let sum = (0..n)
            .map(|i| fresnel.at(at(i)).x * 2.0 * at(i))
            .sum::<f64>()
            / f64::from(n);
        assert!((sum - fresnel.mean().x).abs() < 1e-7);
    }

    #[test]
    fn an_index_of_1_reflects_nothing_and_glass_as_the_formula_says() {
        let glass = |ior: f64| Fresnel {
            f0: Vec3::splat(normal_reflectance(ior)),
            f90: Vec3::ONE,
            curve: Curve::Dielectric(ior),
            film: None,
        };
        for k in 1..=10 {
            assert_eq!(glass(1.0).at(f64::from(k) / 10.0), Vec3::ZERO);
        }
        // At Brewster's angle light along the plane of incidence is not reflected at all.
        let cosine = 1.0 / (1.0 + 1.5_f64 * 1.5).sqrt();
        let crosswise = (1.0 - 1.5 * 1.5) / (1.0 + 1.5 * 1.5);
        let expected = 0.5 * crosswise * crosswise;
        assert!((glass(1.5).at(cosine).x - expected).abs() < 1e-12);
        assert_eq!(glass(1.5).at(0.0), Vec3::ONE);
    }

    #[test]
    fn red_is_bent_least() {
        let [red, green, blue] = dispersed(1.5, 0.33);
        assert!(red < green && green < blue && green == 1.5);
        assert_eq!(dispersed(1.0, 10.0), [1.0; 3]);
    }
}
