//! Colours and spectra as linear Rec. 709.

use super::value::{number, numbers};
use rtc_math::{exp, pow};

/// The value of an `<rgb>`: three numbers, one, or `#rrggbb` in sRGB.
pub(super) fn rgb(text: &str) -> Option<[f64; 3]> {
    if let Some(hex) = text.trim().strip_prefix('#') {
        let value = u32::from_str_radix(hex, 16)
            .ok()
            .filter(|_| hex.len() == 6)?;
        let byte = |shift: u32| f64::from(value >> shift & 0xff) / 255.0;
        return Some([byte(16), byte(8), byte(0)].map(decode));
    }
    match numbers(text)?[..] {
        [r, g, b] => Some([r, g, b]),
        [all] => Some([all; 3]),
        _ => None,
    }
}

/// A channel of sRGB as a linear value (IEC 61966-2-1).
pub(super) fn decode(value: f64) -> f64 {
    if value <= 0.04045 {
        value / 12.92
    } else {
        pow((value + 0.055) / 1.055, 2.4)
    }
}

/// The value of a `<spectrum>`: one number for all wavelengths, or pairs `nanometres:value`.
///
/// Pairs are interpolated linearly, weighted by the colour matching functions, and divided by the
/// integral of a constant spectrum, so that a constant 1 is white.
pub(super) fn spectrum(text: &str) -> Option<[f64; 3]> {
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
    let pairs = pairs.filter(|pairs| pairs.is_sorted_by(|a, b| a.0 < b.0))?;
    let (mut sum, mut white) = ([0.0; 3], [0.0; 3]);
    for step in 0..=94 {
        let wavelength = 360.0 + 5.0 * f64::from(step);
        let matching = matching(wavelength);
        let value = interpolated(&pairs, wavelength);
        for channel in 0..3 {
            sum[channel] += matching[channel] * value;
            white[channel] += matching[channel];
        }
    }
    let relative: [f64; 3] = std::array::from_fn(|channel| sum[channel] / white[channel]);
    Some(linear(relative).map(|channel| channel.max(0.0)))
}

/// The value of a spectrum between its pairs, 0 outside of them.
fn interpolated(pairs: &[(f64, f64)], wavelength: f64) -> f64 {
    let after = pairs.partition_point(|(known, _)| *known < wavelength);
    match (after.checked_sub(1).map(|at| pairs[at]), pairs.get(after)) {
        (_, Some((known, value))) if *known == wavelength => *value,
        (Some((low, a)), Some((high, b))) => a + (b - a) * (wavelength - low) / (high - low),
        _ => 0.0,
    }
}

/// The CIE 1931 colour matching functions by the multi-lobe fit of Wyman, Sloan, Shirley 2013,
/// "Simple analytic approximations to the CIE XYZ color matching functions", section 2.2.
fn matching(nm: f64) -> [f64; 3] {
    let lobe = |height: f64, center: f64, below: f64, above: f64| {
        let width = if nm < center { below } else { above };
        let t = (nm - center) * width;
        height * exp(-0.5 * t * t)
    };
    [
        lobe(0.362, 442.0, 0.0624, 0.0374)
            + lobe(1.056, 599.8, 0.0264, 0.0323)
            + lobe(-0.065, 501.1, 0.0490, 0.0382),
        lobe(0.821, 568.8, 0.0213, 0.0247) + lobe(0.286, 530.9, 0.0613, 0.0322),
        lobe(1.217, 437.0, 0.0845, 0.0278) + lobe(0.681, 459.0, 0.0385, 0.0725),
    ]
}

/// XYZ, each relative to that of a white, as linear Rec. 709 with the white at (1, 1, 1): the
/// matrix
/// of the primaries with the columns scaled to that white.
fn linear([x, y, z]: [f64; 3]) -> [f64; 3] {
    // Of D65, whose X and Z the factors take out.
    let (x, z) = (x * 0.950_47, z * 1.088_83);
    [
        3.240_97 * x - 1.537_383 * y - 0.498_611 * z,
        -0.969_244 * x + 1.875_968 * y + 0.041_555 * z,
        0.055_63 * x - 0.203_977 * y + 1.056_972 * z,
    ]
}

/// The complex index of refraction of a metal, η and k at the wavelengths of the primaries.
pub(super) type ComplexIndex = ([f64; 3], [f64; 3]);

/// Metals by Mitsuba's names: the indices that are usual for RGB renderers, from the tables of
/// Rakić et al. 1998 and Palik 1985.
pub(super) fn metal(name: &str) -> Option<ComplexIndex> {
    Some(match name {
        "Ag" => ([0.155, 0.117, 0.138], [4.828, 3.122, 2.147]),
        "Al" => ([1.657, 0.880, 0.521], [9.224, 6.270, 4.837]),
        "Au" => ([0.143, 0.375, 1.442], [3.983, 2.386, 1.603]),
        "Cr" => ([3.110, 3.180, 2.230], [3.310, 3.330, 3.130]),
        "Cu" => ([0.200, 0.924, 1.102], [3.912, 2.452, 2.142]),
        "Fe" | "Fe_alpha" => ([2.870, 2.950, 2.650], [3.350, 2.930, 2.810]),
        "Ni" => ([1.990, 1.930, 1.650], [4.220, 3.650, 2.810]),
        "Ti" => ([2.740, 2.540, 2.270], [3.810, 3.430, 3.040]),
        "W" => ([3.550, 3.480, 3.340], [2.860, 2.760, 2.620]),
        _ => return None,
    })
}

/// The reflectance of a metal in air along its normal: ((η − 1)² + k²) / ((η + 1)² + k²).
pub(super) fn normal_reflectance((eta, k): ComplexIndex) -> [f64; 3] {
    std::array::from_fn(|channel| {
        let (eta, k) = (eta[channel], k[channel]);
        let square = |x: f64| x * x;
        (square(eta - 1.0) + square(k)) / (square(eta + 1.0) + square(k))
    })
}

/// Indices of refraction by Mitsuba's names.
pub(super) fn named_ior(name: &str) -> Option<f64> {
    Some(match name {
        "vacuum" => 1.0,
        "helium" => 1.000_036,
        "hydrogen" => 1.000_132,
        "air" => 1.000_277,
        "carbon dioxide" => 1.000_45,
        "water" => 1.333,
        "acetone" => 1.36,
        "ethanol" => 1.361,
        "carbon tetrachloride" => 1.461,
        "glycerol" => 1.4729,
        "benzene" => 1.501,
        "silicone oil" => 1.520_45,
        "bromine" => 1.661,
        "water ice" => 1.31,
        "fused quartz" => 1.458,
        "pyrex" => 1.470,
        "acrylic glass" => 1.49,
        "polypropylene" => 1.49,
        "bk7" => 1.5046,
        "sodium chloride" => 1.544,
        "amber" => 1.55,
        "pet" => 1.575,
        "diamond" => 2.419,
        _ => return None,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_constant_spectrum_is_white_and_a_long_wave_is_red() {
        let white = spectrum("300:0.5, 900:0.5").unwrap();
        assert!(
            white.iter().all(|channel| (channel - 0.5).abs() < 2e-3),
            "{white:?}"
        );
        let [r, g, b] = spectrum("360:0 600:0 610:1 700:1 710:0 900:0").unwrap();
        assert!(r > 3.0 * g.max(b), "{r} {g} {b}");
        assert_eq!(spectrum("500:1 400:1"), None);
    }

    #[test]
    fn colours_are_numbers_or_hexadecimal() {
        assert_eq!(rgb("0.5"), Some([0.5; 3]));
        assert_eq!(rgb("#ffffff"), Some([1.0; 3]));
        assert_eq!((rgb("#fff"), rgb("1 2")), (None, None));
    }

    #[test]
    fn gold_reflects_red_more_than_blue() {
        let [r, g, b] = normal_reflectance(metal("Au").unwrap());
        assert!(r > g && g > b && r > 0.9 && b < 0.5, "{r} {g} {b}");
    }
}
