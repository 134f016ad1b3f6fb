//! Reflection, refraction and Phong's highlight.

use rtc_math::{Vec3, cross, pow};

/// The mirror direction of the unit vector `d` at a surface with unit normal `n`.
#[must_use]
pub fn reflect(d: Vec3, n: Vec3) -> Vec3 {
    (d - n * (2.0 * d.dot(n))).normalize()
}

/// Snell's law: the unit direction beyond the surface, or `None` for total internal reflection.
///
/// `d` is a unit vector towards the surface, `n` the unit normal on the side `d` comes from. The
/// sine comes from a cross product and the cosine from the factored difference of squares, so both
/// keep their digits near the critical angle.
#[must_use]
pub fn refract(d: Vec3, n: Vec3, eta_from: f64, eta_to: f64) -> Option<Vec3> {
    let sine = eta_from * cross(d, n).length();
    let square = (eta_to - sine) * (eta_to + sine);
    if square < 0.0 {
        return None;
    }
    let along = d - n * d.dot(n);
    Some((along * eta_from - n * square.sqrt()).normalize())
}

/// Phong's highlight, `max(0, R·V)ⁿ`, with the cosine kept from exceeding 1 by rounding; never −0.
#[must_use]
pub fn highlight(r_dot_v: f64, n: f64) -> f64 {
    if r_dot_v <= 0.0 && n > 0.0 {
        return 0.0;
    }
    pow(r_dot_v.clamp(0.0, 1.0) + 0.0, n)
}
