//! Numbers, vectors, colours and matrices of a Mitsuba scene, as it writes them.

use crate::exchange::color::{emitted, emitted_spectrum, from_spectrum};
use crate::exchange::transform::AffineTransform;
use rtc_color::srgb_decoded;
use rtc_math::Vec3;

/// One number.
pub(super) fn number(text: &str) -> Option<f64> {
    text.trim()
        .parse()
        .ok()
        .filter(|number: &f64| number.is_finite())
}

/// The numbers of a list, between commas or white space.
pub(super) fn numbers(text: &str) -> Option<Vec<f64>> {
    let words = text.split(|c: char| c == ',' || c.is_whitespace());
    words.filter(|word| !word.is_empty()).map(number).collect()
}

/// Three numbers, or one for all three.
pub(super) fn vector(text: &str) -> Option<[f64; 3]> {
    match numbers(text)?[..] {
        [x, y, z] => Some([x, y, z]),
        [all] => Some([all; 3]),
        _ => None,
    }
}

/// The affine map of a matrix of 4 × 4 or 3 × 3 numbers, in rows.
pub(super) fn matrix(text: &str) -> Option<AffineTransform> {
    let numbers = numbers(text)?;
    let side = match numbers.len() {
        16 => 4,
        9 => 3,
        _ => return None,
    };
    let column = |k: usize| {
        let [x, y, z] = std::array::from_fn(|row| numbers[row * side + k]);
        Vec3::new(x, y, z)
    };
    let origin = if side == 4 { column(3) } else { Vec3::ZERO };
    Some(AffineTransform([column(0), column(1), column(2), origin]))
}

/// The value of an `<rgb>`: three numbers, one, or `#rrggbb` in sRGB.
pub(super) fn rgb(text: &str) -> Option<[f64; 3]> {
    if let Some(hex) = text.trim().strip_prefix('#') {
        let value = u32::from_str_radix(hex, 16)
            .ok()
            .filter(|_| hex.len() == 6)?;
        let byte = |shift: u32| f64::from(value >> shift & 0xff) / 255.0;
        return Some([byte(16), byte(8), byte(0)].map(srgb_decoded));
    }
    match numbers(text)?[..] {
        [r, g, b] => Some([r, g, b]),
        [all] => Some([all; 3]),
        _ => None,
    }
}

/// The value of a `<spectrum>`: one number for all wavelengths, or pairs `nanometres:value`, as a
/// reflectance in the light of D65, or as emitted light, whose constant spectrum is reddish.
pub(super) fn spectrum(text: &str, is_emitted: bool) -> Option<[f64; 3]> {
    if let Some(constant) = number(text) {
        return Some(match is_emitted {
            true => emitted(|_| constant),
            false => [constant; 3],
        });
    }
    if !text.contains(':') {
        return rgb(text);
    }
    let words = text.split(|c: char| c == ',' || c.is_whitespace());
    let pairs: Option<Vec<(f64, f64)>> = words
        .filter(|word| !word.is_empty())
        .map(|word| {
            let (wavelength, value) = word.split_once(':')?;
            Some((number(wavelength)?, number(value)?))
        })
        .collect();
    match is_emitted {
        true => emitted_spectrum(&pairs?),
        false => from_spectrum(&pairs?),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lists_have_commas_or_spaces() {
        assert_eq!(vector("1, 2 3"), Some([1.0, 2.0, 3.0]));
        assert_eq!(vector("2"), Some([2.0; 3]));
        assert_eq!((vector("1 2"), number("inf")), (None, None));
    }

    #[test]
    fn a_constant_spectrum_is_white_and_a_long_wave_is_red() {
        let white = spectrum("300:0.5, 900:0.5", false).unwrap();
        assert!(
            white.iter().all(|channel| (channel - 0.5).abs() < 2e-3),
            "{white:?}"
        );
        // The numbers of Mitsuba 3.9.1.
        let emitted = spectrum("1", true).unwrap();
        for (found, known) in emitted.into_iter().zip([1.204_88, 0.948_228, 0.909_267]) {
            assert!((found - known).abs() < 7e-3, "{emitted:?}");
        }
        let ramp = spectrum("400:0.04, 700:0.642", false).unwrap();
        for (found, known) in ramp.into_iter().zip([0.523_911, 0.326_816, 0.121_694]) {
            assert!((found - known).abs() < 5e-3, "{ramp:?}");
        }
        let [r, g, b] = spectrum("360:0 600:0 610:1 700:1 710:0 900:0", false).unwrap();
        assert!(r > 3.0 * g.max(b), "{r} {g} {b}");
        assert_eq!(spectrum("500:1 400:1", true), None);
    }

    #[test]
    fn colours_are_numbers_or_hexadecimal() {
        assert_eq!(rgb("0.5"), Some([0.5; 3]));
        assert_eq!(rgb("#ffffff"), Some([1.0; 3]));
        assert_eq!((rgb("#fff"), rgb("1 2")), (None, None));
    }
}
