//! The complex index of refraction of conductors, and their Fresnel equations.

use crate::Vec3;

/// The complex index of refraction η + i·k of a conductor over that of the medium outside, at red,
/// green and blue. All parts are at least 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ComplexIndex {
    /// The real part η.
    pub eta: Vec3,
    /// The absorption coefficient k.
    pub k: Vec3,
}

impl ComplexIndex {
    /// The fraction of unpolarised light that is reflected at an angle to the normal, by its
    /// cosine (Pharr, Jakob, Humphreys, "Physically Based Rendering" (4th ed.), §9.3.6).
    #[must_use]
    pub fn reflectance(&self, cosine: f64) -> Vec3 {
        let at = |channel: usize| reflectance(self.eta[channel], self.k[channel], cosine);
        Vec3::new(at(0), at(1), at(2))
    }

    /// The mean of the reflectance over the hemisphere, weighted by the cosine: Gauss's quadrature
    /// over the square of the cosine, with three points; within 0.003 for metals.
    #[must_use]
    pub fn mean_reflectance(&self) -> Vec3 {
        // The points (1 ± √(3/5))/2 and 1/2, and their weights 5/18 and 4/9.
        const OFFSET: f64 = 0.387_298_334_620_741_7;
        let at = |square: f64| self.reflectance(square.sqrt());
        (at(0.5 - OFFSET) + at(0.5 + OFFSET)) * (5.0 / 18.0) + at(0.5) * (4.0 / 9.0)
    }
}

fn reflectance(eta: f64, k: f64, cosine: f64) -> f64 {
    let cosine = cosine.clamp(0.0, 1.0);
    let (cosine2, sine2) = (cosine * cosine, 1.0 - cosine * cosine);
    // a² + b² and a of the complex cosine of refraction.
    let difference = eta * eta - k * k - sine2;
    let sum = (difference * difference + 4.0 * eta * eta * k * k).sqrt();
    let a = (0.5 * (sum + difference)).max(0.0).sqrt();
    // The reflectance of both polarisations; at 0/0 everything is reflected.
    let ratio = |low: f64, high: f64| if high > 0.0 { low / high } else { 1.0 };
    let (first, second) = (sum + cosine2, 2.0 * cosine * a);
    let crosswise = ratio(first - second, first + second);
    let (first, second) = (cosine2 * sum + sine2 * sine2, second * sine2);
    let along = crosswise * ratio(first - second, first + second);
    (0.5 * (crosswise + along)).clamp(0.0, 1.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The equations in complex numbers.
    fn known(eta: f64, k: f64, cosine: f64) -> f64 {
        type Complex = (f64, f64);
        let times = |a: Complex, b: Complex| (a.0 * b.0 - a.1 * b.1, a.0 * b.1 + a.1 * b.0);
        let over = |a: Complex, b: Complex| {
            let square = b.0 * b.0 + b.1 * b.1;
            let (re, im) = times(a, (b.0, -b.1));
            (re / square, im / square)
        };
        let root = |a: Complex| {
            let size = (a.0 * a.0 + a.1 * a.1).sqrt();
            let im = ((size - a.0) / 2.0).max(0.0).sqrt();
            (((size + a.0) / 2.0).max(0.0).sqrt(), im.copysign(a.1))
        };
        let index = (eta, k);
        let square = times(index, index);
        let sine2 = 1.0 - cosine * cosine;
        let refracted = root((square.0 - sine2, square.1));
        let norm = |a: Complex| a.0 * a.0 + a.1 * a.1;
        let crosswise = over(
            (cosine - refracted.0, -refracted.1),
            (cosine + refracted.0, refracted.1),
        );
        let inner = times(square, (cosine, 0.0));
        let along = over(
            (inner.0 - refracted.0, inner.1 - refracted.1),
            (inner.0 + refracted.0, inner.1 + refracted.1),
        );
        0.5 * (norm(crosswise) + norm(along))
    }

    #[test]
    fn the_reflectance_is_that_of_the_complex_equations() {
        for (eta, k) in [(0.143, 3.983), (1.657, 9.224), (4.37, 5.21), (2.5, 0.0)] {
            for step in 0..=20 {
                let cosine = f64::from(step) / 20.0;
                let (found, known) = (reflectance(eta, k, cosine), known(eta, k, cosine));
                assert!((found - known).abs() < 1e-12, "{eta} {k} {cosine}: {found}");
            }
        }
        assert_eq!(reflectance(0.0, 0.0, 0.0), 1.0);
        assert_eq!(reflectance(0.0, 1.0, 0.3), 1.0);
        assert_eq!(reflectance(1.0, 0.0, 0.3), 0.0);
    }

    #[test]
    fn the_mean_is_the_integral_over_the_hemisphere() {
        let index = ComplexIndex {
            eta: Vec3::new(0.143, 0.375, 4.37),
            k: Vec3::new(3.983, 2.386, 5.21),
        };
        let n = 10_000;
        let sum: Vec3 = (0..n)
            .map(|i| (f64::from(i) + 0.5) / f64::from(n))
            .map(|cosine| index.reflectance(cosine) * (2.0 * cosine))
            .sum();
        let mean = sum / f64::from(n);
        assert!((mean - index.mean_reflectance()).abs().max_element() < 3e-3);
    }
}
