//! Closed-form real roots of polynomials, with their usual cancellation errors.

use super::real::Real;

/// The roots of `a·t² + b·t + c`, in order for `a > 0`: `(−b ∓ √(b² − 4ac))/2a`; the one root twice
/// if `a` is 0.
#[inline]
pub(in crate::shape) fn quadratic<R: Real>(a: R, b: R, c: R) -> Option<[R; 2]> {
    let discriminant = b * b - R::of(4.0) * a * c;
    if discriminant < R::of(0.0) {
        return None;
    }
    if a == R::of(0.0) {
        return Some([-c / b; 2]);
    }
    let (root, double) = (discriminant.sqrt(), R::of(2.0) * a);
    Some([(-b - root) / double, (-b + root) / double])
}

/// The largest real root of `z³ + b·z² + c·z + d`, by Cardano's formula or, of three real roots, by
/// Viète's.
fn largest_of_cubic<R: Real>(b: R, c: R, d: R) -> R {
    let (two, three) = (R::of(2.0), R::of(3.0));
    // Substitute z = s − b/3 to get s³ + 3p·s + 2q.
    let third = b / three;
    let p = c / three - third * third;
    let q = third * third * third - third * c / two + d / two;
    let discriminant = q * q + p * p * p;
    if discriminant > R::of(0.0) {
        let root = discriminant.sqrt();
        let u = if q > R::of(0.0) {
            -(q + root).cbrt()
        } else {
            (root - q).cbrt()
        };
        return u - p / u - third;
    }
    let size = (-p).sqrt();
    let cosine = -q / (size * size * size);
    let limited = if cosine > R::of(1.0) {
        R::of(1.0)
    } else {
        cosine
    };
    let angle = if size > R::of(0.0) {
        limited.acos() / three
    } else {
        R::of(0.0)
    };
    two * size * angle.cos() - third
}

/// The real roots of `t⁴ + b·t³ + c·t² + d·t + e`, in any order; missing ones are NaN.
///
/// Ferrari's method in Descartes' form: a root of the resolvent cubic splits the quartic into two
/// quadratics.
pub(in crate::shape) fn quartic<R: Real>(b: R, c: R, d: R, e: R) -> [R; 4] {
    let (half, zero) = (R::of(0.5), R::of(0.0));
    // Substitute t = y − b/4 to get y⁴ + p·y² + q·y + r.
    let shift = b * R::of(0.25);
    let square = shift * shift;
    let p = c - R::of(6.0) * square;
    let q = d - R::of(2.0) * c * shift + R::of(8.0) * square * shift;
    let r = e - d * shift + c * square - R::of(3.0) * square * square;

    let z = largest_of_cubic(p + p, p * p - R::of(4.0) * r, -q * q);
    let none = R::of(f64::NAN);
    let pair = |roots: Option<[R; 2]>| roots.unwrap_or([none; 2]);
    let [first, second] = if z > R::EPSILON * p.abs() {
        // Factor into (y² + s·y + u)(y² − s·y + v).
        let s = z.sqrt();
        let (middle, slant) = (half * (p + z), half * q / s);
        [
            pair(quadratic(R::of(1.0), s, middle - slant)),
            pair(quadratic(R::of(1.0), -s, middle + slant)),
        ]
    } else {
        // Solve the biquadratic y⁴ + p·y² + r.
        let root = |y2: R| if y2 >= zero { y2.sqrt() } else { none };
        let [low, high] = pair(quadratic(R::of(1.0), p, r)).map(root);
        [[low, -low], [high, -high]]
    };
    [first[0], first[1], second[0], second[1]].map(|y| y - shift)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn assert_roots(wanted: [f64; 4], [b, c, d, e]: [f64; 4]) {
        let mut found = quartic(b, c, d, e);
        // The sign of a NaN is anyone's guess.
        found.sort_by(|a, b| a.is_nan().cmp(&b.is_nan()).then(a.total_cmp(b)));
        for (found, wanted) in found.into_iter().zip(wanted) {
            assert!(
                (found - wanted).abs() < 1e-9 || found.is_nan() && wanted.is_nan(),
                "{found} {wanted}"
            );
        }
    }

    #[test]
    fn quartics_of_four_two_and_no_real_roots() {
        const NONE: f64 = f64::NAN;
        assert_roots([1.0, 2.0, 4.0, 7.0], [-14.0, 63.0, -106.0, 56.0]);
        assert_roots([-3.0, -1.0, 1.0, 3.0], [0.0, -10.0, 0.0, 9.0]);
        // (t² − 1)(t² + 4) and (t − 1)(t − 3)(t² + t + 5)
        assert_roots([-1.0, 1.0, NONE, NONE], [0.0, 3.0, 0.0, -4.0]);
        assert_roots([1.0, 3.0, NONE, NONE], [-3.0, 4.0, -17.0, 15.0]);
        assert_roots([NONE; 4], [0.0, 5.0, 0.0, 4.0]);
    }

    #[test]
    fn a_quadratic_without_its_square_is_a_line() {
        assert_eq!(quadratic(0.0, 2.0, -6.0), Some([3.0; 2]));
        assert_eq!(quadratic(1.0, 0.0, 1.0), None);
    }
}
