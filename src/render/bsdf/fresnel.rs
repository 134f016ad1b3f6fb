//! The Fresnel reflectance of a smooth boundary: Schlick's formula, or the interference of a thin
//! film.

use super::thin_film::ThinFilm;
use rtc_math::Vec3;

/// The reflectance at normal incidence of a boundary between air and a medium with the index given.
///
/// 0 stands for an infinite index, as KHR_materials_ior says.
#[must_use]
pub(super) fn normal_reflectance(ior: f64) -> f64 {
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
pub(super) fn schlick(cosine: f64) -> f64 {
    let x = (1.0 - cosine).clamp(0.0, 1.0);
    let square = x * x;
    square * square * x
}

/// A reflectance over the angle: from `f0` at normal to `f90` at grazing incidence.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Fresnel {
    /// At normal incidence.
    pub(super) f0: Vec3,
    /// At grazing incidence.
    pub(super) f90: Vec3,
    /// The film on it, and the fraction of the surface it covers.
    pub(super) film: Option<(ThinFilm, f64)>,
}

impl Fresnel {
    /// The reflectance at the cosine given.
    #[must_use]
    #[inline]
    pub(super) fn at(&self, cosine: f64) -> Vec3 {
        let bare = self.f0 + (self.f90 - self.f0) * schlick(cosine);
        match &self.film {
            None => bare,
            Some((film, fraction)) => bare.lerp(film.reflectance(self.f0, cosine), *fraction),
        }
    }

    /// The mean over the hemisphere weighted by the cosine; with a film, as if its colour at normal
    /// incidence were that of the bare surface.
    #[must_use]
    pub(super) fn mean(&self) -> Vec3 {
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
    fn red_is_bent_least() {
        let [red, green, blue] = dispersed(1.5, 0.33);
        assert!(red < green && green < blue && green == 1.5);
        assert_eq!(dispersed(1.0, 10.0), [1.0; 3]);
    }
}
