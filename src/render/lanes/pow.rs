//! Powers in four lanes: the steps of [`rtc_math::pow`] on four numbers at once, so that each
//! lane has its bits. Those of `libm` are of `e_pow.c` of FreeBSD's msun (Sun Microsystems, 1993):
//! log₂x in two parts, y·log₂x in two parts, its whole part n, and 2ⁿ times a power between ½ and
//! 2.

use fearless_simd::prelude::*;
use fearless_simd::{Simd, f64x4, mask64x4, u64x4};

/// The upper half of the bits of a number.
const HIGH: u64 = 0xffff_ffff_0000_0000;

/// The bits of 2⁵²: of 2⁵² + k those plus k.
const TWO_52_BITS: u64 = 0x4330_0000_0000_0000;
const TWO_52: f64 = 4_503_599_627_370_496.0;

/// The bias of the exponent of a number.
const BIAS: f64 = 1023.0;

/// √(3/2) and √3, cut after half of the bits: mantissas from the one to the other are seen from
/// 3/2, those from the latter on are halved.
const ROOT_1_5: f64 = f64::from_bits(0x3ff3_988f_0000_0000);
const ROOT_3: f64 = f64::from_bits(0x3ffb_b67a_0000_0000);

/// log₂(3/2) in two parts.
const LOG2_1_5: [f64; 2] = [
    f64::from_bits(0x3fe2_b803_4000_0000),
    f64::from_bits(0x3e4c_fdeb_43cf_d006),
];

/// The coefficients, the last first, of a polynomial in s², s = (x − b)/(x + b), that times s⁵ is
/// 3/2·ln(x/b) − 3·s − s³.
const LN: [f64; 6] = [
    f64::from_bits(0x3fca_7e28_4a45_4eef),
    f64::from_bits(0x3fcd_864a_93c9_db65),
    f64::from_bits(0x3fd1_7460_a91d_4101),
    f64::from_bits(0x3fd5_5555_518f_264d),
    f64::from_bits(0x3fdb_6db6_db6f_abff),
    f64::from_bits(0x3fe3_3333_3333_3303),
];

/// The coefficients, the last first, of the Remez polynomial in z² for eᶻ.
const EXP: [f64; 5] = [
    f64::from_bits(0x3e66_3769_72be_a4d0),
    f64::from_bits(0xbebb_bd41_c5d2_6bf1),
    f64::from_bits(0x3f11_566a_af25_de2c),
    f64::from_bits(0xbf66_c16c_16be_bd93),
    f64::from_bits(0x3fc5_5555_5555_553e),
];

/// 2/(3·ln 2), and in two parts.
const TWO_THIRDS_LOG2_E: f64 = f64::from_bits(0x3fee_c709_dc3a_03fd);
const TWO_THIRDS_LOG2_E_PARTS: [f64; 2] = [
    f64::from_bits(0x3fee_c709_e000_0000),
    f64::from_bits(0xbe3e_2fe0_145b_01f5),
];

/// ln 2, and in two parts.
const LN_2: f64 = f64::from_bits(0x3fe6_2e42_fefa_39ef);
const LN_2_PARTS: [f64; 2] = [
    f64::from_bits(0x3fe6_2e43_0000_0000),
    f64::from_bits(0xbe20_5c61_0ca8_6c39),
];

/// The smallest number whose integer part is subtracted.
const WHOLE: f64 = f64::from_bits(0x3fe0_0001_0000_0000);

/// `x` to the power `y`, and in which lanes that is so: where x is a normal number below 1, y
/// between 2 and 2³¹, and the power no less than 2⁻¹⁰²¹.
#[inline(always)]
pub(crate) fn powers<S: Simd>(simd: S, x: f64x4<S>, y: f64x4<S>) -> (mask64x4<S>, f64x4<S>) {
    let number = |x: f64| f64x4::splat(simd, x);
    let is_base = x.simd_ge(number(f64::MIN_POSITIVE)) & x.simd_lt(number(1.0));
    let is_exponent = y.simd_gt(number(2.0)) & y.simd_lt(number(2_147_483_648.0));
    let [log, log_rest] = log2(simd, x);
    let y_high = high(simd, y);
    let rest = (y - y_high) * log + y * log_rest;
    let product = y_high * log;
    let sum = rest + product;
    let is_normal = sum.simd_gt(number(-1021.0));
    let power = exp2(simd, [product, rest], sum);
    (is_base & is_exponent & is_normal, power)
}

/// The numbers with the lower half of their bits 0.
#[inline(always)]
fn high<S: Simd>(simd: S, x: f64x4<S>) -> f64x4<S> {
    f64x4::from_bits(x.to_bits() & u64x4::splat(simd, HIGH))
}

/// A polynomial by its coefficients, the last first.
#[inline(always)]
fn polynomial<S: Simd, const N: usize>(x: f64x4<S>, coefficients: [f64; N]) -> f64x4<S> {
    let mut sum = f64x4::splat(x.simd, coefficients[0]);
    for coefficient in &coefficients[1..] {
        sum = f64x4::splat(x.simd, *coefficient) + x * sum;
    }
    sum
}

/// log₂ of positive normal numbers, in two parts.
#[inline(always)]
fn log2<S: Simd>(simd: S, x: f64x4<S>) -> [f64x4<S>; 2] {
    let number = |x: f64| f64x4::splat(simd, x);
    let bits = |bits: u64| u64x4::splat(simd, bits);
    let (zero, one) = (number(0.0), number(1.0));

    // x = 2ⁿ·a, with a near 1 or 3/2.
    let exponent = f64x4::from_bits((x.to_bits() >> 52) | bits(TWO_52_BITS));
    let n = exponent - number(TWO_52 + BIAS);
    let mantissa = x.to_bits() & bits(0x000f_ffff_ffff_ffff) | bits(0x3ff0_0000_0000_0000);
    let a = f64x4::from_bits(mantissa);
    let is_large = a.simd_ge(number(ROOT_3));
    let is_middle = a.simd_ge(number(ROOT_1_5)) & !is_large;
    let n = n + is_large.select(one, zero);
    let a = is_large.select(a * number(0.5), a);
    let b = is_middle.select(number(1.5), one);

    // s = (a − b)/(a + b), in two parts.
    let (u, v) = (a - b, one / (a + b));
    let s = u * v;
    let s_high = high(simd, s);
    // The sum a + b with half of the bits, from the bits of a.
    let half = (a.to_bits() >> 1) & bits(HIGH) | bits(0x2000_0000_0000_0000);
    let half = f64x4::from_bits(half + bits(0x0008_0000_0000_0000));
    let half_1_5 = f64x4::from_bits(half.to_bits() + bits(0x0004_0000_0000_0000));
    let t_high = is_middle.select(half_1_5, half);
    let t_low = a - (t_high - b);
    let s_low = v * ((u - s_high * t_high) - s_high * t_low);

    // ln a, and log₂ of it.
    let s2 = s * s;
    let r = s2 * s2 * polynomial(s2, LN) + s_low * (s_high + s);
    let s2 = s_high * s_high;
    let t_high = high(simd, number(3.0) + s2 + r);
    let t_low = r - ((t_high - number(3.0)) - s2);
    let (u, v) = (s_high * t_high, s_low * t_high + t_low * s);
    let p_high = high(simd, u + v);
    let p_low = v - (p_high - u);
    let [b_high, b_low] = LOG2_1_5.map(|part| is_middle.select(number(part), zero));
    let [by_high, by_low] = TWO_THIRDS_LOG2_E_PARTS.map(number);
    let z_high = by_high * p_high;
    let z_low = by_low * p_high + p_low * number(TWO_THIRDS_LOG2_E) + b_low;
    let log = high(simd, ((z_high + z_low) + b_high) + n);
    [log, z_low - (((log - n) - b_high) - z_high)]
}

/// 2 to the power of numbers in two parts, whose sum is from −1021 to 0.
#[inline(always)]
fn exp2<S: Simd>(simd: S, [product, rest]: [f64x4<S>; 2], sum: f64x4<S>) -> f64x4<S> {
    let number = |x: f64| f64x4::splat(simd, x);
    let has_whole = sum.abs().simd_ge(number(WHOLE));
    let nearest = (sum.abs() + number(0.5)).floor();
    let n = has_whole.select(-nearest, number(0.0));
    let product = product - n;
    let t = high(simd, rest + product);
    let [ln_2_high, ln_2_low] = LN_2_PARTS.map(number);
    let u = t * ln_2_high;
    let v = (rest - (t - product)) * number(LN_2) + t * ln_2_low;
    let z = u + v;
    let w = v - (z - u);
    let t = z * z;
    let t = z - t * polynomial(t, EXP);
    let r = (z * t) / (t - number(2.0)) - (w + z * w);
    let power = number(1.0) - (r - z);
    power * f64x4::from_bits((n + number(TWO_52 + BIAS)).to_bits() << 52)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::accel::simd::baseline;
    use crate::lanes::LANES;
    use crate::sampler::PathVertexKey;
    use rtc_math::{ldexp, pow};

    /// Bases near 1, near 0 and between, and where the logarithm changes its form; exponents whole
    /// and not.
    fn pair(key: &PathVertexKey, k: u64) -> (f64, f64) {
        let (u, choice) = (key.uniform(k), key.bits(k + 1));
        let near = |x: f64| f64::from_bits(x.to_bits() - choice % 9 + 4);
        let x = match choice >> 32 & 7 {
            0 => 1.0 - ldexp(u, -((choice >> 8 & 63) as i32)),
            1 => ldexp(u, -((choice >> 8 & 1023) as i32)),
            2 => near(0.5 * ROOT_3),
            3 => near(0.5 * ROOT_1_5),
            4 => near(1.0),
            _ => u,
        };
        let y = key.uniform(k + 2) * 200.0;
        let y = match choice >> 40 & 3 {
            0 => y,
            1 => y.floor(),
            2 => ldexp(y, (choice >> 48 & 31) as i32),
            // The sum is near a half.
            _ => ((key.bits(k + 3) % 9) as f64 + 0.5) / -libm::log2(x),
        };
        (x, y)
    }

    #[test]
    fn four_powers_have_the_bits_of_each() {
        let simd = baseline();
        let mut shown = 0;
        for index in 0..200_000 {
            let key = PathVertexKey::new([11, 5], index);
            let pairs = [0, 4, 8, 12].map(|k| pair(&key, k));
            let x = f64x4::simd_from(simd, pairs.map(|(x, _)| x));
            let y = f64x4::simd_from(simd, pairs.map(|(_, y)| y));
            let (is_so, power) = powers(simd, x, y);
            for lane in 0..LANES {
                let (x, y) = pairs[lane];
                if is_so.to_bitmask() >> lane & 1 == 1 {
                    let one = pow(x, y);
                    assert_eq!(power[lane].to_bits(), one.to_bits(), "{x:?} to {y:?}");
                    shown += 1;
                }
            }
        }
        assert!(shown > 400_000, "{shown}");
    }
}
