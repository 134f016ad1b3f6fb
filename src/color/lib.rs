//! Colour: luminance, sRGB coding, quantization, and tone mapping.
//!
//! # Overview
//!
//! A linear value is proportional to radiance; colours are red, green and blue with Rec. 709
//! primaries. A display value is in [0, 1]; 1 is the largest integer of a pixel file.
//!
//! - [`Tone`] maps linear colours to display values: none, sRGB, AgX, or PBR Neutral of Khronos.
//! - [`srgb_encoded`] and [`srgb_decoded`] are the transfer function of sRGB and its inverse.
//! - [`quantize8`] and [`quantize16`] turn display values into integers.
//! - [`luminance`] is the weighted sum of the channels.
//!
//! # Data flow
//!
//! `render` sums linear values. `image` applies the [`Tone`] of a picture and quantizes the result.
//! Front ends decode sRGB colours of scene files with [`srgb_decoded`]. Scenes of the course use
//! display values throughout, with [`Tone::None`].
//!
//! # Guarantees
//!
//! - Every function accepts all f64 values; NaN quantizes to 0.
//! - Results have the same bits on every machine, since `pow` comes from `libm`.

mod tone;

pub use tone::Tone;

/// The luminance of a linear colour (Rec. 709-6, section 3).
#[must_use]
pub fn luminance([r, g, b]: [f64; 3]) -> f64 {
    0.2126 * r + 0.7152 * g + 0.0722 * b
}

/// ⌊255·v⌋ with `v` clamped to [0, 1]; NaN is 0.
#[must_use]
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "clamped; the cast takes NaN to 0"
)]
pub fn quantize8(v: f64) -> u8 {
    (v.clamp(0.0, 1.0) * f64::from(u8::MAX)) as u8
}

/// The byte nearest to 255·v, with `v` clamped to [0, 1]; NaN is 0.
#[must_use]
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "clamped; the cast takes NaN to 0"
)]
pub fn nearest8(v: f64) -> u8 {
    (v.clamp(0.0, 1.0) * f64::from(u8::MAX)).round() as u8
}

/// ⌊65535·v⌋ with `v` clamped to [0, 1]; NaN is 0.
#[must_use]
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "clamped; the cast takes NaN to 0"
)]
pub fn quantize16(v: f64) -> u16 {
    (v.clamp(0.0, 1.0) * f64::from(u16::MAX)) as u16
}

/// The linear value of a coded value of sRGB in [0, 1] (IEC 61966-2-1).
#[must_use]
pub fn srgb_decoded(v: f64) -> f64 {
    if v <= 0.040_45 {
        v / 12.92
    } else {
        libm::pow((v + 0.055) / 1.055, 2.4)
    }
}

/// The coded value of sRGB of a linear value, clamped to [0, 1].
#[must_use]
pub fn srgb_encoded(v: f64) -> f64 {
    match v {
        _ if v >= 1.0 => 1.0,
        _ if v > 0.003_130_8 => 1.055 * libm::pow(v, 1.0 / 2.4) - 0.055,
        _ => v.max(0.0) * 12.92,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_are_cut_down_and_clamped() {
        let eight = [f64::NAN, -1.0, -0.0, 0.5, 0.999, 1.0, 7.0, f64::INFINITY].map(quantize8);
        assert_eq!(eight, [0, 0, 0, 127, 254, 255, 255, 255]);
        let sixteen = [f64::NAN, f64::NEG_INFINITY, 0.5, 1.0, 1e300].map(quantize16);
        assert_eq!(sixteen, [0, 0, 32767, 65535, 65535]);
    }

    #[test]
    fn a_byte_goes_there_and_back() {
        assert!((0..=255u8).all(|byte| quantize8((f64::from(byte) + 0.5) / 255.0) == byte));
    }

    #[test]
    fn srgb_goes_there_and_back() {
        for byte in 0..=255 {
            let coded = f64::from(byte) / 255.0;
            assert!(
                (srgb_encoded(srgb_decoded(coded)) - coded).abs() < 1e-7,
                "{byte}"
            );
        }
        assert!((srgb_decoded(0.5) - 0.214_041_1).abs() < 1e-7);
        assert_eq!([f64::NAN, -1.0, 2.0].map(srgb_encoded), [0.0, 0.0, 1.0]);
    }
}
