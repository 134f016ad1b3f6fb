//! Error-free transformations and the compensated sums built on them.
//!
//! Exact unless a product leaves ±2^996 or its error falls below the subnormals; `valid` keeps
//! scenes far inside.

use super::{Double, Number, Vec3, Vector};

/// The sum and its rounding error: `a + b = s + e` exactly (Knuth, TAOCP 2, §4.2.2, theorem B).
#[must_use]
#[inline(always)]
pub fn two_sum<N: Number>(a: N, b: N) -> (N, N) {
    let s = a + b;
    let b_virtual = s - a;
    (s, (a - (s - b_virtual)) + (b - b_virtual))
}

/// The difference and its rounding error: `a − b = s + e` exactly.
#[must_use]
#[inline(always)]
pub fn two_difference<N: Number>(a: N, b: N) -> (N, N) {
    two_sum(a, -b)
}

/// The product and its rounding error: `a·b = p + e` exactly.
///
/// By an FMA, or by Dekker's product (Numerische Mathematik 18, 1971); both are exact, so the bits
/// are the same.
#[must_use]
#[inline(always)]
pub fn two_product<N: Double>(a: N, b: N) -> (N, N) {
    let p = a * b;
    if let Some(e) = a.fused_error(b, p) {
        return (p, e);
    }
    let (a_high, a_low) = split(a);
    let (b_high, b_low) = split(b);
    let e = ((a_high * b_high - p) + a_high * b_low + a_low * b_high) + a_low * b_low;
    (p, e)
}

/// The factor of Veltkamp's splitting: 2²⁷ + 1.
const SPLITTER: f64 = 134_217_729.0;

/// Veltkamp's splitting into two halves of at most 26 bits each.
#[inline(always)]
fn split<N: Double>(a: N) -> (N, N) {
    let c = a.constant(SPLITTER) * a;
    let high = c - (c - a);
    (high, a - high)
}

/// `a·b − c·d` to within 2 u of the result; exactly antisymmetric under exchange of the two
/// products.
///
/// After Kahan; see Jeannerod, Louvet, Muller, "Further analysis of Kahan's algorithm", Math. Comp.
/// 82 (2013).
#[must_use]
#[inline(always)]
pub fn difference_of_products<N: Double>(a: N, b: N, c: N, d: N) -> N {
    difference(two_product(a, b), two_product(c, d))
}

/// The difference of two products with their errors.
#[inline(always)]
fn difference<N: Double>((p, p_error): (N, N), (q, q_error): (N, N)) -> N {
    (p - q) + (p_error - q_error)
}

/// As [`two_product`]; if `FUSED`, by one instruction, for which the function of the caller is to
/// be compiled: elsewhere it is a slow call.
#[inline(always)]
#[expect(
    clippy::disallowed_methods,
    reason = "only where it is one instruction"
)]
fn product<const FUSED: bool>(a: f64, b: f64) -> (f64, f64) {
    if FUSED {
        let p = a * b;
        (p, a.mul_add(b, -p))
    } else {
        two_product(a, b)
    }
}

/// The cross product, each component to within 2 u of itself.
#[must_use]
#[inline(always)]
pub fn cross(a: Vec3, b: Vec3) -> Vec3 {
    cross_by::<false>(a, b)
}

/// As [`cross`]; `FUSED` only where [`super::fuses`] holds, with the same bits.
#[must_use]
#[inline(always)]
pub fn cross_by<const FUSED: bool>(a: Vec3, b: Vec3) -> Vec3 {
    let [a, b] = [a, b].map(|v| Vector::constant(0.0, v));
    let of_products = |a, b, c, d| difference(product::<FUSED>(a, b), product::<FUSED>(c, d));
    a.cross_by(b, of_products).lane(0)
}

/// The dot product as if computed in twice the precision and rounded once (Ogita, Rump, Oishi,
/// "Accurate sum and dot product", SIAM J. Sci. Comput. 26 (2005), algorithm 5.3).
#[must_use]
#[inline(always)]
pub fn dot(a: Vec3, b: Vec3) -> f64 {
    dot_by::<false>(a, b)
}

/// As [`dot`]; `FUSED` only where [`super::fuses`] holds, with the same bits.
#[must_use]
#[inline(always)]
pub fn dot_by<const FUSED: bool>(a: Vec3, b: Vec3) -> f64 {
    let (x, x_error) = product::<FUSED>(a.x, b.x);
    let (y, y_error) = product::<FUSED>(a.y, b.y);
    let (z, z_error) = product::<FUSED>(a.z, b.z);
    let (xy, xy_error) = two_sum(x, y);
    let (xyz, xyz_error) = two_sum(xy, z);
    xyz + ((x_error + y_error) + xy_error + (z_error + xyz_error))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn dekker_and_a_wide_integer_agree_on_the_error_of_a_product() {
        let (a, b) = (9_007_199_254_740_991.0, 9_007_199_254_740_989.0);
        let (p, e) = two_product(a, b);
        let exact = 9_007_199_254_740_991_i128 * 9_007_199_254_740_989_i128;
        assert_eq!(exact - p as i128, e as i128);
    }

    #[test]
    fn a_difference_of_nearly_equal_products_keeps_its_digits() {
        let a = 1.0 + f64::EPSILON;
        // (1 + ε)² − (1 + 2ε)·1 = ε²
        assert_eq!(
            difference_of_products(a, a, 1.0 + 2.0 * f64::EPSILON, 1.0),
            f64::EPSILON * f64::EPSILON
        );
    }

    #[test]
    fn a_dot_product_survives_cancellation() {
        let a = Vec3::new(1e16, 1.0, -1e16);
        assert_eq!(dot(a, Vec3::new(1.0, 3.0, 1.0)), 3.0);
    }
}
