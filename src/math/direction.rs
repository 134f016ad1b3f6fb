//! Directions and lengths of vectors of any size. They are scaled by a power of two first, which is
//! exact, so no square overflows or underflows.

use super::{Vec3, ldexp};

/// `v` times the power of two that brings its largest component into [1, 2), and the exponent taken
/// out: `v = scaled·2^exponent`. `None` for the zero vector and for components that are not finite.
#[must_use]
#[inline(always)]
pub fn unit_scale(v: Vec3) -> Option<(Vec3, i32)> {
    let largest = v.abs().max_element();
    if !v.is_finite() || largest == 0.0 {
        return None;
    }
    let exponent = exponent_of(largest);
    let scaled = match power_of_two(-exponent) {
        Some(factor) => v * factor,
        None => Vec3::new(
            ldexp(v.x, -exponent),
            ldexp(v.y, -exponent),
            ldexp(v.z, -exponent),
        ),
    };
    Some((scaled, exponent))
}

/// The vector of length 1 along `v`. `None` for the zero vector and for components that are not
/// finite.
///
/// `unit(v·2^k)` has the bits of `unit(v)` for every k at which no component becomes subnormal or
/// infinite. Where the squares of the components are in range these are the bits of v·(1/‖v‖).
#[must_use]
#[inline]
pub fn unit(v: Vec3) -> Option<Vec3> {
    /// For vectors with such squares, scaling first changes no bit: terms that underflow are too
    /// small to affect the rounded sum.
    const SQUARES: std::ops::RangeInclusive<f64> = MIN_SQUARE..=1.0 / MIN_SQUARE;
    if SQUARES.contains(&v.length_squared()) {
        return Some(v.normalize());
    }
    unit_scale(v).map(|(scaled, _)| scaled.normalize())
}

/// 2⁻⁴⁰⁰.
const MIN_SQUARE: f64 = f64::from_bits((1023 - 400) << 52);

/// The length of a vector: finite unless it lies beyond the range of f64, and 0 only for the zero
/// vector.
#[must_use]
#[inline]
pub fn length(v: Vec3) -> f64 {
    unit_scale(v).map_or_else(
        || v.length(),
        |(scaled, exponent)| ldexp(scaled.length(), exponent),
    )
}

/// The exponent of a positive number, as `ilogb` says, read off a normal one.
#[inline(always)]
fn exponent_of(x: f64) -> i32 {
    match i32::try_from(x.to_bits() >> 52) {
        Ok(biased @ 1..2047) => biased - 1023,
        _ => libm::ilogb(x),
    }
}

/// 2^`exponent`, if it is a normal number.
#[inline(always)]
fn power_of_two(exponent: i32) -> Option<f64> {
    let biased = u64::try_from(exponent + 1023)
        .ok()
        .filter(|biased| (1..2047).contains(biased))?;
    Some(f64::from_bits(biased << 52))
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn unit_scale_reaches_subnormals_and_refuses_nothing_to_scale() {
        let (scaled, exponent) = unit_scale(Vec3::new(0.0, 5e-324, 0.0)).unwrap();
        assert_eq!((scaled.y, exponent), (1.0, -1074));
        let (scaled, exponent) = unit_scale(Vec3::new(f64::MAX, f64::MIN_POSITIVE, 1.0)).unwrap();
        assert_eq!(
            (scaled.x, scaled.z, exponent),
            (f64::MAX / ldexp(1.0, 1023), ldexp(1.0, -1023), 1023)
        );
        assert!(unit_scale(Vec3::ZERO).is_none() && unit(Vec3::ZERO).is_none());
        assert!(unit_scale(Vec3::new(f64::NAN, 1.0, 0.0)).is_none());
    }

    #[test]
    fn lengths_are_those_of_vectors_whose_squares_are_out_of_range() {
        let far = ldexp(1.0, 600);
        assert_eq!(length(Vec3::new(3.0 * far, 0.0, -4.0 * far)), 5.0 * far);
        assert_eq!(
            (length(Vec3::new(0.0, 5e-324, 0.0)), length(Vec3::ZERO)),
            (5e-324, 0.0)
        );
        assert!(
            length(Vec3::splat(f64::MAX)).is_infinite() && length(Vec3::splat(f64::NAN)).is_nan()
        );
    }

    /// A component of any size, or none.
    fn component() -> impl Strategy<Value = f64> {
        let sized =
            (-1.0..1.0, -60..60_i32).prop_map(|(fraction, exponent)| ldexp(fraction, exponent));
        prop_oneof![4 => -10.0..10.0, 2 => sized, 1 => Just(0.0), 1 => Just(1.0)]
    }

    proptest! {
        #[test]
        fn a_direction_has_no_length(
            x in component(),
            y in component(),
            z in component(),
            k in -900..900_i32,
        ) {
            let v = Vec3::new(x, y, z);
            let scaled = Vec3::new(ldexp(x, k), ldexp(y, k), ldexp(z, k));
            prop_assert_eq!(unit(scaled), unit(v));
            prop_assert_eq!(length(scaled), ldexp(length(v), k));
            if v != Vec3::ZERO {
                prop_assert_eq!(unit(v), Some(v.normalize()), "the bits of the plain formula");
                prop_assert!((unit(v).unwrap().length() - 1.0).abs() < 4.0 * crate::U);
            }
        }
    }
}
