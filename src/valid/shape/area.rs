//! Whether a triangle has an area.

use crate::check::SMALLEST;
use rtc_math::{U, Vec3, cross, unit_scale};

/// Whether three corners are not collinear.
#[inline]
pub(crate) fn has_area([a, b, c]: [Vec3; 3]) -> bool {
    let edges = [b - a, c - a];
    surely_spans(edges) || spans(edges)
}

/// Whether the rounded cross product proves that two edges span an area. Its error is at most 6 u
/// times the product of their lengths. This suffices for nearly all triangles; the exact product is
/// much slower.
#[inline(always)]
fn surely_spans([first, second]: [Vec3; 2]) -> bool {
    let (p, q) = (first.abs().max_element(), second.abs().max_element());
    p.min(q) > 4.0 * SMALLEST && first.cross(second).abs().max_element() > 8.0 * U * p * q
}

/// Whether two edges span an area.
#[cold]
#[inline(never)]
fn spans([first, second]: [Vec3; 2]) -> bool {
    let Some((first, p)) = unit_scale(first) else {
        return false;
    };
    let Some((second, q)) = unit_scale(second) else {
        return false;
    };
    // Edges whose products underflow have no area.
    let shortest = p.min(q) > libm::ilogb(SMALLEST);
    shortest && cross(first, second) != Vec3::ZERO
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Slivers of all sizes, from clear triangles to those that only exact arithmetic distinguishes
    /// from lines.
    #[test]
    fn what_is_surely_an_area_is_one() {
        let mut certain = 0;
        for step in 0..4000 {
            let size = libm::ldexp(1.0, step % 401 - 200);
            let (along, off) = (
                f64::from(step % 7) / 7.0 - 0.3,
                libm::ldexp(1.0, -(step % 61)),
            );
            let first = Vec3::new(0.1, 0.7, -0.3) * size;
            let second = first * along + Vec3::new(0.9, -0.2, 0.4) * (size * off);
            certain += i32::from(surely_spans([first, second]));
            assert!(
                !surely_spans([first, second]) || spans([first, second]),
                "{first:?} {second:?}"
            );
        }
        assert!(
            (2000..4000).contains(&certain),
            "both answers are met: {certain}"
        );
    }
}
