//! Whether corners lie in one plane.

use super::{U, Vec3, cross};

/// Whether all corners of a quadrilateral, in order around it, lie in one plane, to within 64 units
/// of rounding.
#[must_use]
pub fn is_flat(corners: [Vec3; 4]) -> bool {
    const FLAT: f64 = 64.0;
    let [a, b, c, d] = corners;
    let normal = cross(b - a, c - a) + cross(c - a, d - a);
    let size = corners
        .iter()
        .map(|v| v.abs().element_sum())
        .fold(0.0, f64::max);
    [b, c, d]
        .iter()
        .all(|v| (*v - a).dot(normal).abs() <= FLAT * U * size * normal.length())
}
