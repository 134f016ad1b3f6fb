//! Beckmann's distribution of microfacets, of Gaussian slopes.
//!
//! Directions are those over the surface of unit slopes; formulas as in Walter et al.,
//! "Microfacet models for refraction through rough surfaces" (EGSR 2007), and Heitz, "Understanding
//! the masking-shadowing function" (JCGT 3, 2014).

use rtc_math::{Vec3, erf, exp, ln};
use std::f64::consts::PI;

/// `√π`.
const ROOT_PI: f64 = 1.772_453_850_905_516;

/// The density of the normals `h` for the widths along x and y, per projected area.
#[must_use]
pub(super) fn density([x, y]: [f64; 2], h: Vec3) -> f64 {
    if h.z <= 0.0 {
        return 0.0;
    }
    let slopes = [h.x / (h.z * x), h.y / (h.z * y)];
    let square = h.z * h.z;
    exp(-(slopes[0] * slopes[0] + slopes[1] * slopes[1])) / (PI * x * y * (square * square))
}

/// The cotangent of the angle between such a direction and the normal.
fn cotangent(w: Vec3) -> f64 {
    let across = w.x * w.x + w.y * w.y;
    if across > 0.0 {
        w.z.abs() / across.sqrt()
    } else {
        f64::INFINITY
    }
}

/// Smith's `G₁` by Walter's rational approximation (equation 27), which renderers share; its error
/// is below 0.4 %.
#[must_use]
pub(super) fn masking(w: Vec3) -> f64 {
    let a = cotangent(w);
    if a >= 1.6 {
        return 1.0;
    }
    a * (3.535 + 2.181 * a) / (1.0 + a * (2.276 + 2.577 * a))
}

/// `|w_z|·(1 + 2·Λ)` without an approximation: it normalizes the density of visible normals.
#[must_use]
pub(super) fn lambda_root(w: Vec3) -> f64 {
    let a = cotangent(w);
    // Beyond this Λ is below 1e-17.
    if a > 6.0 {
        return w.z.abs();
    }
    let across = (w.x * w.x + w.y * w.y).sqrt();
    // 1 + 2·Λ = erf(a) + exp(−a²)/(a·√π), times a·across.
    w.z.abs() * erf(a) + across * exp(-a * a) / ROOT_PI
}

/// The slopes of a visible normal of the surface of unit slopes, in its axes, for a unit vector
/// `view` above it and two numbers in [0, 1).
#[must_use]
pub(super) fn visible_slope(view: Vec3, u: [f64; 2]) -> [f64; 2] {
    let across = (view.x * view.x + view.y * view.y).sqrt();
    let along = slope_towards(cotangent(view), u[0]);
    let beside = inverse_erf(2.0 * u[1] - 1.0);
    // The slope is that of the height: a normal leans to the viewer where it is negative.
    let (c, s) = if across > 0.0 {
        (view.x / across, view.y / across)
    } else {
        (1.0, 0.0)
    };
    [c * along - s * beside, s * along + c * beside]
}

/// The slope in the plane of the viewer, of the density `max(0, cot θ − t)·exp(−t²)` up to a
/// factor: its integral reaches the fraction `u` of the whole there.
fn slope_towards(cotangent: f64, u: f64) -> f64 {
    /// Slopes beyond this have no weight.
    const MOST: f64 = 6.0;
    /// More than enough halvings for the digits of a number in [−6, 6].
    const STEPS: usize = 60;
    /// The density is Gaussian beyond this.
    const STEEP: f64 = 1e9;
    let cotangent = cotangent.min(STEEP);
    let integral = |t: f64| cotangent * ROOT_PI * (1.0 + erf(t)) + exp(-t * t);
    // Newton's steps, kept between bounds.
    let (mut low, mut high) = (-MOST, cotangent.min(MOST));
    let wanted = u * integral(high);
    let mut t = 0.5 * (low + high);
    for _ in 0..STEPS {
        let error = integral(t) - wanted;
        if error > 0.0 {
            high = t;
        } else {
            low = t;
        }
        let slope = 2.0 * (cotangent - t) * exp(-t * t);
        let newton = t - error / slope;
        let next = if newton > low && newton < high {
            newton
        } else {
            0.5 * (low + high)
        };
        if (next - t).abs() < 1e-12 {
            return next;
        }
        t = next;
    }
    t
}

/// The inverse of the error function: Winitzki's approximation (2008), and Newton's steps.
fn inverse_erf(y: f64) -> f64 {
    let y = y.clamp(-1.0 + 1e-12, 1.0 - 1e-12);
    let log = ln((1.0 - y) * (1.0 + y));
    let half = 2.0 / (PI * 0.147) + 0.5 * log;
    let square = (half * half - log / 0.147).sqrt() - half;
    let mut x = square.max(0.0).sqrt().copysign(y);
    for _ in 0..3 {
        x -= (erf(x) - y) * 0.5 * ROOT_PI * exp(x * x);
    }
    x
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_error_function_is_inverted() {
        for k in -9..=9 {
            let y = f64::from(k) * 0.111;
            assert!((erf(inverse_erf(y)) - y).abs() < 1e-12, "{y}");
        }
    }

    #[test]
    fn the_rational_masking_is_the_exact_one_within_its_error() {
        for k in 1..40 {
            let angle = f64::from(k) * 0.0385;
            let w = Vec3::new(rtc_math::sin(angle), 0.0, rtc_math::cos(angle));
            let exact = 2.0 * w.z / (w.z + lambda_root(w));
            assert!((masking(w) / exact - 1.0).abs() < 4e-3, "{angle}");
        }
    }

    #[test]
    fn half_of_the_slopes_are_below_that_of_a_half() {
        // Seen along the normal the slopes are Gaussian; at a grazing angle, t·exp(−t²) below 0.
        assert!(slope_towards(f64::INFINITY, 0.5).abs() < 1e-8);
        // Between, 10·√π·erf(t) + exp(−t²) is 0.
        assert!((slope_towards(10.0, 0.5) + 0.05).abs() < 1e-3);
        let median = slope_towards(0.0, 0.5);
        assert!((median + ln(2.0).sqrt()).abs() < 1e-9);
    }
}
