//! Numbers in unquoted scalars, by the core schema of YAML 1.2.

/// The result of reading an unquoted scalar as a number.
pub(super) enum ScalarNumber {
    Number(f64),
    /// `.inf`, `.nan`, or a number beyond the range of a 64-bit float.
    NotFinite,
    NoNumber,
}

/// Reads an unquoted scalar as a number.
pub(super) fn parse_number(scalar: &str) -> ScalarNumber {
    if let Some(value) = short_decimal(scalar) {
        return ScalarNumber::Number(value);
    }
    let unsigned = scalar.strip_prefix(['+', '-']).unwrap_or(scalar);
    if matches!(unsigned, ".inf" | ".Inf" | ".INF") || matches!(scalar, ".nan" | ".NaN" | ".NAN") {
        return ScalarNumber::NotFinite;
    }
    let value = match scalar
        .strip_prefix("0x")
        .map(|digits| (digits, 16))
        .or(scalar.strip_prefix("0o").map(|d| (d, 8)))
    {
        Some((digits, radix)) => in_radix(digits, radix),
        None if is_decimal(unsigned) => scalar.parse().ok(),
        None => None,
    };
    match value {
        Some(value) if value.is_finite() => ScalarNumber::Number(value),
        Some(_) => ScalarNumber::NotFinite,
        None => ScalarNumber::NoNumber,
    }
}

/// The fast path for a decimal of at most 15 characters without an exponent. Its digits and the
/// power of ten are exact in 64 bits, so their quotient is the nearest number.
fn short_decimal(scalar: &str) -> Option<f64> {
    const TENS: [f64; 15] = [
        1e0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9, 1e10, 1e11, 1e12, 1e13, 1e14,
    ];
    let (sign, digits) = match scalar.as_bytes() {
        [b'-', digits @ ..] => (-1.0, digits),
        [b'+', digits @ ..] | digits => (1.0, digits),
    };
    let mut point = None;
    let mut integer = 0_u64;
    for (at, byte) in digits.iter().take(16).enumerate() {
        match byte {
            b'0'..=b'9' => integer = integer * 10 + u64::from(byte - b'0'),
            b'.' if point.is_none() => point = Some(at),
            _ => return None,
        }
    }
    if digits.len() > 15 || digits.len() == usize::from(point.is_some()) {
        return None;
    }
    let decimals = point.map_or(0, |at| digits.len() - at - 1);
    #[expect(clippy::cast_precision_loss, reason = "15 digits are below 2^53")]
    Some(sign * (integer as f64 / TENS[decimals]))
}

fn in_radix(digits: &str, radix: u32) -> Option<f64> {
    let add =
        |sum: f64, digit: char| Some(sum * f64::from(radix) + f64::from(digit.to_digit(radix)?));
    if digits.is_empty() {
        None
    } else {
        digits.chars().try_fold(0.0, add)
    }
}

/// Whether a scalar matches `([0-9]+(\.[0-9]*)?|\.[0-9]+)([eE][+-]?[0-9]+)?`.
fn is_decimal(scalar: &str) -> bool {
    let digits = |text: &str| text.bytes().take_while(u8::is_ascii_digit).count();
    let (integer, rest) = scalar.split_at(digits(scalar));
    let (fraction, rest) = match rest.strip_prefix('.') {
        Some(rest) => rest.split_at(digits(rest)),
        None => ("", rest),
    };
    if integer.is_empty() && fraction.is_empty() {
        return false;
    }
    match rest.strip_prefix(['e', 'E']) {
        None => rest.is_empty(),
        Some(exponent) => {
            let exponent = exponent.strip_prefix(['+', '-']).unwrap_or(exponent);
            !exponent.is_empty() && digits(exponent) == exponent.len()
        }
    }
}

/// Whether a scalar is how programs other than YAML write NaN or infinity.
pub(super) fn is_foreign_non_finite(scalar: &str) -> bool {
    const KEYWORDS: [&str; 3] = ["nan", "inf", "infinity"];
    let unsigned = scalar.trim_start_matches(['-', '+']);
    KEYWORDS
        .iter()
        .any(|keyword| keyword.eq_ignore_ascii_case(unsigned))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn value(scalar: &str) -> Option<f64> {
        match parse_number(scalar) {
            ScalarNumber::Number(value) => Some(value),
            ScalarNumber::NotFinite => Some(f64::INFINITY),
            ScalarNumber::NoNumber => None,
        }
    }

    #[test]
    fn the_core_schema_and_nothing_else_is_a_number() {
        for (scalar, expected) in [
            ("12", 12.0),
            ("-0.5", -0.5),
            (".5", 0.5),
            ("5.", 5.0),
            ("1e3", 1000.0),
            ("0x1F", 31.0),
        ] {
            assert_eq!(value(scalar), Some(expected), "{scalar}");
        }
        for scalar in ["+1.5E-3", "0o17"] {
            assert!(value(scalar).is_some_and(f64::is_finite), "{scalar}");
        }
        for scalar in [
            "0.1",
            "-123456789.12345",
            ".99999999999999",
            "-0",
            "+7.",
            "0.30000000000000004",
            "123456789012345678",
        ] {
            assert_eq!(
                value(scalar).map(f64::to_bits),
                scalar.parse().ok().map(f64::to_bits),
                "{scalar}"
            );
        }
        for scalar in ["1e400", ".inf", "-.INF", ".nan"] {
            assert_eq!(value(scalar), Some(f64::INFINITY), "{scalar}");
        }
        for scalar in [
            "", ".", "-", "1_000", "1.2.3", "1e", "inf", "nan", "0x", "1f", "+.nan", "e5", "1 2",
        ] {
            assert_eq!(value(scalar), None, "{scalar}");
        }
    }
}
