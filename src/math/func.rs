//! Elementary functions from `libm`: std's differ between platforms, these do not.

/// The error function, `2/√π·∫₀ˣ exp(−t²) dt`.
#[must_use]
pub fn erf(x: f64) -> f64 {
    libm::erf(x)
}

/// The sine of an angle in radians.
#[must_use]
pub fn sin(x: f64) -> f64 {
    libm::sin(x)
}

/// The cosine of an angle in radians.
#[must_use]
pub fn cos(x: f64) -> f64 {
    libm::cos(x)
}

/// The sine and the cosine of an angle in radians: the bits of [`sin`] and [`cos`], in one call.
#[must_use]
pub fn sin_cos(x: f64) -> (f64, f64) {
    libm::sincos(x)
}

/// The arc cosine in radians, in [0, π].
#[must_use]
pub fn acos(x: f64) -> f64 {
    libm::acos(x)
}

/// The angle of the point (x, y) in radians, in (−π, π].
#[must_use]
pub fn atan2(y: f64, x: f64) -> f64 {
    libm::atan2(y, x)
}

/// `x` to the power `y`.
#[must_use]
pub fn pow(x: f64, y: f64) -> f64 {
    libm::pow(x, y)
}

/// e to the power `x`.
#[must_use]
pub fn exp(x: f64) -> f64 {
    libm::exp(x)
}

/// The natural logarithm.
#[must_use]
pub fn ln(x: f64) -> f64 {
    libm::log(x)
}

/// `x·2^exponent`, rounded once.
#[must_use]
pub fn ldexp(x: f64, exponent: i32) -> f64 {
    libm::ldexp(x, exponent)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn sine_and_cosine_together_have_the_bits_of_each(x in -7.0..7.0, exponent in -40..12_i32) {
            let x = ldexp(x, exponent);
            let (sine, cosine) = sin_cos(x);
            prop_assert_eq!(sine.to_bits(), sin(x).to_bits(), "{}", x);
            prop_assert_eq!(cosine.to_bits(), cos(x).to_bits(), "{}", x);
        }
    }
}
