//! Colours and spectra as linear Rec. 709.

use rtc_color::srgb_decoded;
use rtc_ir::Conductor;
use rtc_math::{ComplexIndex, exp, pow};
use rtc_tables::METALS;

/// A reflectance by pairs of a wavelength in nanometres and a value, as linear Rec. 709; `None` if
/// the wavelengths do not ascend. Pairs are interpolated linearly.
pub(crate) fn from_spectrum(pairs: &[(f64, f64)]) -> Option<[f64; 3]> {
    if !pairs.is_sorted_by(|a, b| a.0 < b.0) {
        return None;
    }
    Some(integrated(|wavelength| interpolated(pairs, wavelength)))
}

/// The colour of a reflectance in the light of D65, as linear Rec. 709: a constant 1 is white.
pub(crate) fn integrated(spectrum: impl Fn(f64) -> f64) -> [f64; 3] {
    let (sum, white) = tristimulus(spectrum, daylight);
    let relative: [f64; 3] = std::array::from_fn(|channel| sum[channel] / white[channel]);
    linear(relative).map(|channel| channel.max(0.0))
}

/// The colour of emitted light, as linear Rec. 709 whose white is D65: a constant spectrum 1 has
/// the luminance 1, and is reddish.
pub(crate) fn emitted(spectrum: impl Fn(f64) -> f64) -> [f64; 3] {
    let (sum, white) = tristimulus(spectrum, |_| 1.0);
    from_xyz(sum.map(|channel| channel / white[1])).map(|channel| channel.max(0.0))
}

/// [`emitted`] of pairs; `None` if the wavelengths do not ascend.
pub(crate) fn emitted_spectrum(pairs: &[(f64, f64)]) -> Option<[f64; 3]> {
    let is_sorted = pairs.is_sorted_by(|a, b| a.0 < b.0);
    is_sorted.then(|| emitted(|wavelength| interpolated(pairs, wavelength)))
}

/// The sums of a spectrum and of a constant one, times an illuminant and the colour matching
/// functions.
fn tristimulus(
    spectrum: impl Fn(f64) -> f64,
    illuminant: impl Fn(usize) -> f64,
) -> ([f64; 3], [f64; 3]) {
    let (mut sum, mut white) = ([0.0; 3], [0.0; 3]);
    for (step, nanometres) in (360..=830).step_by(5).enumerate() {
        let wavelength = f64::from(nanometres);
        let light = illuminant(step);
        let matching = matching(wavelength).map(|weight| weight * light);
        let value = spectrum(wavelength);
        for channel in 0..3 {
            sum[channel] += matching[channel] * value;
            white[channel] += matching[channel];
        }
    }
    (sum, white)
}

/// The relative power of the illuminant D65 at 360, 370, … 830 nm (CIE 15:2018, table 6).
const D65: [f64; 48] = [
    46.6383, 52.0891, 49.9755, 54.6482, 82.7549, 91.486, 93.4318, 86.6823, 104.865, 117.008,
    117.812, 114.861, 115.923, 108.811, 109.354, 107.802, 104.79, 107.689, 104.405, 104.046, 100.0,
    96.3342, 95.788, 88.6856, 90.0062, 89.5991, 87.6987, 83.2886, 83.6992, 80.0268, 80.2146,
    82.2778, 78.2842, 69.7213, 71.6091, 74.349, 61.604, 69.8856, 75.087, 63.5927, 46.4182, 66.8054,
    63.3828, 64.304, 59.4519, 51.959, 57.4406, 60.3125,
];

/// D65 at 360, 365, … nm, interpolated linearly, as the CIE does.
fn daylight(step: usize) -> f64 {
    0.5 * (D65[step / 2] + D65[step.div_ceil(2)])
}

/// The radiance of a black body at a wavelength in nanometres, over that at its peak (Planck's law
/// and Wien's displacement law). The temperature is in kelvin, above 0.
pub(crate) fn planck(nanometres: f64, kelvin: f64) -> f64 {
    /// The second radiation constant, h·c/k, in nm·K.
    const C2: f64 = 1.438_776_877e7;
    /// Wien's constant, in nm·K.
    const PEAK: f64 = 2.897_771_955e6;
    let at = |nm: f64| pow(nm, -5.0) / (exp(C2 / (nm * kelvin)) - 1.0);
    at(nanometres) / at(PEAK / kelvin)
}

/// A colour scaled to the luminance 1 (Rec. 709, relative to its white); black stays black.
pub(crate) fn of_unit_luminance(color: [f64; 3]) -> [f64; 3] {
    let [r, g, b] = color;
    let luminance = 0.2126 * r + 0.7152 * g + 0.0722 * b;
    match luminance > 0.0 {
        true => color.map(|channel| channel / luminance),
        false => color,
    }
}

/// XYZ as linear Rec. 709, whose white is D65.
pub(crate) fn from_xyz([x, y, z]: [f64; 3]) -> [f64; 3] {
    linear([x / 0.950_47, y, z / 1.088_83])
}

/// A linear value as a byte of sRGB: the one whose linear value is closest.
pub(crate) fn encoded(value: f64) -> u8 {
    let linear = |byte: u8| srgb_decoded(f64::from(byte) / 255.0);
    // The last byte that is not above the value.
    let (mut below, mut above) = (0_u8, 255_u8);
    while above - below > 1 {
        let middle = below + (above - below) / 2;
        match linear(middle) <= value {
            true => below = middle,
            false => above = middle,
        }
    }
    match value - linear(below) <= linear(above) - value {
        true => below,
        false => above,
    }
}

/// The value of a spectrum between its pairs, 0 outside of them.
pub(crate) fn interpolated(pairs: &[(f64, f64)], wavelength: f64) -> f64 {
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
/// matrix of the primaries with the columns scaled to that white.
fn linear([x, y, z]: [f64; 3]) -> [f64; 3] {
    // Of D65, whose X and Z the factors take out.
    let (x, z) = (x * 0.950_47, z * 1.088_83);
    [
        3.240_97 * x - 1.537_383 * y - 0.498_611 * z,
        -0.969_244 * x + 1.875_968 * y + 0.041_555 * z,
        0.055_63 * x - 0.203_977 * y + 1.056_972 * z,
    ]
}

/// The index of a metal by its symbol, as Mitsuba and pbrt write it: `Au`, `Ni_palik`.
pub(crate) fn metal(name: &str) -> Option<Conductor> {
    let symbol = name.strip_suffix("_palik").unwrap_or(name);
    let symbol = if symbol == "Fe_alpha" { "Fe" } else { symbol };
    let known = METALS.iter().find(|metal| metal.symbol == symbol)?;
    let (eta, k) = (known.eta, known.k);
    Some(Conductor { eta, k })
}

/// The index of copper, for metals that are not known.
pub(crate) fn copper() -> Conductor {
    metal("Cu").unwrap_or(Conductor {
        eta: [1.0; 3],
        k: [1.0; 3],
    })
}

/// The index of a mirror, which reflects all light at all angles.
pub(crate) const MIRROR: Conductor = Conductor {
    eta: [0.0; 3],
    k: [1.0; 3],
};

/// The index with the real part η whose reflectance along the normal is closest to a value R:
/// R = ((η − 1)² + k²) / ((η + 1)² + k²).
pub(crate) fn of_reflectance(eta: [f64; 3], reflectance: [f64; 3]) -> Conductor {
    let k = std::array::from_fn(|channel| {
        let (eta, r) = (eta[channel], reflectance[channel].clamp(0.0, 0.9999));
        let square = (r * (eta + 1.0) * (eta + 1.0) - (eta - 1.0) * (eta - 1.0)) / (1.0 - r);
        square.max(0.0).sqrt()
    });
    Conductor { eta, k }
}

/// The reflectance of a metal in air along its normal.
pub(crate) fn normal_reflectance(index: Conductor) -> [f64; 3] {
    ComplexIndex::from(index).reflectance(1.0).to_array()
}

/// Indices of refraction by the names of Mitsuba.
pub(crate) fn named_ior(name: &str) -> Option<f64> {
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
    fn a_linear_value_becomes_the_closest_byte() {
        for byte in 0..=255_u8 {
            assert_eq!(encoded(srgb_decoded(f64::from(byte) / 255.0)), byte);
        }
        assert_eq!((encoded(-1.0), encoded(7.0)), (0, 255));
    }

    #[test]
    fn a_black_body_is_red_when_cool_and_near_white_at_6500_kelvin() {
        let body = |kelvin| of_unit_luminance(emitted(|nm| planck(nm, kelvin)));
        let [r, g, b] = body(2000.0);
        assert!(r > 1.5 * g && g > 2.0 * b, "{r} {g} {b}");
        assert!(
            body(6500.0)
                .iter()
                .all(|channel| (channel - 1.0).abs() < 0.08)
        );
        assert!((planck(500.0, 5795.54) - 1.0).abs() < 1e-6);
    }

    #[test]
    fn gold_reflects_red_more_than_blue() {
        let [r, g, b] = normal_reflectance(metal("Au").unwrap());
        assert!(r > g && g > b && r > 0.9 && b < 0.5, "{r} {g} {b}");
    }
}
