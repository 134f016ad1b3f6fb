//! Tone mapping: linear Rec. 709 values to display values. Every operator accepts every number, and
//! all but [`Tone::None`] return values in [0, 1].

use super::srgb_encoded;
use arbitrary::Arbitrary;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// How linear values become those of a display.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema, Arbitrary)]
#[serde(rename_all = "camelCase")]
pub enum Tone {
    /// Linear values, unchanged.
    None,
    /// Clipped at 1, with sRGB encoding.
    Srgb,
    /// Troy Sobotka's AgX, the base look: highlights roll off over 16.5 stops and lose their colour
    /// on the way.
    Agx,
    /// The PBR Neutral tone map of Khronos with sRGB encoding: colours below the highlights keep
    /// their values.
    PbrNeutral,
}

impl Tone {
    /// All of them.
    pub const ALL: [Self; 4] = [Self::None, Self::Srgb, Self::Agx, Self::PbrNeutral];

    /// Its name on the command line and in scene files.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::None => "none",
            Self::Srgb => "srgb",
            Self::Agx => "agx",
            Self::PbrNeutral => "pbr-neutral",
        }
    }

    /// The display values of linear ones.
    #[must_use]
    pub fn display(self, linear: [f64; 3]) -> [f64; 3] {
        match self {
            Self::None => linear,
            Self::Srgb => linear.map(srgb_encoded),
            Self::Agx => agx(linear),
            Self::PbrNeutral => pbr_neutral(linear).map(srgb_encoded),
        }
    }
}

/// PBR Neutral (Khronos, "PBR Neutral Specification", 2024, in its own symbols); linear in, linear
/// out.
fn pbr_neutral(linear: [f64; 3]) -> [f64; 3] {
    const F90: f64 = 0.04;
    const KS: f64 = 0.8 - F90;
    const KD: f64 = 0.15;
    let linear = linear.map(|v| if v > 0.0 { v.min(f64::MAX) } else { 0.0 });
    // The reflection of a dielectric in white light is taken off, less of it in the dark.
    let x = min(linear);
    let f = if x <= 2.0 * F90 {
        x - x * x / (4.0 * F90)
    } else {
        F90
    };
    let base = linear.map(|v| v - f);
    let p = max(base);
    if p <= KS {
        return base;
    }
    // The peak is compressed to below 1, and colours fade to grey as far as that moved it.
    let pn = 1.0 - (1.0 - KS) * (1.0 - KS) / (p + 1.0 - 2.0 * KS);
    let g = 1.0 / (KD * (p - pn) + 1.0);
    base.map(|v| v / p * pn * g + pn * (1.0 - g))
}

/// Stops of middle grey below and above that AgX shows, 0.18·2⁻¹⁰ … 0.18·2^6.5.
const BELOW: f64 = 10.0;
const ABOVE: f64 = 6.5;

/// Middle grey on the curve of AgX.
const PIVOT: f64 = BELOW / (BELOW + ABOVE);

/// The power and the scale of the curve of AgX below the pivot and above.
const TOE: (f64, f64) = (3.0, 59.507_875);
const SHOULDER: (f64, f64) = (3.25, 69.862_789_135_455_37);

/// AgX as in Sobotka's configuration of 2022: inset, logarithm, sigmoid, and the inverse of the
/// inset.
fn agx(linear: [f64; 3]) -> [f64; 3] {
    const GREY: f64 = 0.18;
    // Each channel takes a fifth of the grey, so that no colour is out of reach of white.
    let grey = agx_grey(linear);
    let inset = linear.map(|v| 0.8 * v + 0.2 * grey);
    let shown = inset.map(|v| {
        let stops = libm::log2(v.max(0.0) / GREY);
        sigmoid(((stops + BELOW) / (BELOW + ABOVE)).clamp(0.0, 1.0))
    });
    let grey = agx_grey(shown);
    shown.map(|v| (1.25 * v - 0.25 * grey).clamp(0.0, 1.0))
}

/// The mean by the weights that the compressed primaries of AgX give: they sum to 1, so the inset
/// is 0.8·1 + 0.2·(this), and its inverse 1.25·1 − 0.25·(this).
fn agx_grey([r, g, b]: [f64; 3]) -> f64 {
    0.212_005_354_752_34 * r + 0.392_182_507_809_01 * g + 0.395_812_137_438_65 * b
}

/// The curve of AgX on [0, 1]: through (0, 0), (pivot, ½) with slope 2, and (1, 1), bent with power
/// 3 in the toe and 3.25 in the shoulder. The scale of a power p is (2·slope)ᵖ less the −p-th power
/// of the way from the pivot to the end.
fn sigmoid(v: f64) -> f64 {
    const SLOPE: f64 = 2.0;
    let d = v - PIVOT;
    let (power, scale) = if d < 0.0 { TOE } else { SHOULDER };
    let denominator = libm::pow(1.0 + scale * libm::pow(d.abs(), power), 1.0 / power);
    0.5 + SLOPE * d / denominator
}

fn min(v: [f64; 3]) -> f64 {
    v[0].min(v[1]).min(v[2])
}

fn max(v: [f64; 3]) -> f64 {
    v[0].max(v[1]).max(v[2])
}

#[cfg(test)]
mod tests {
    use super::super::srgb_decoded;
    use super::*;

    const ALL: [Tone; 3] = [Tone::Srgb, Tone::Agx, Tone::PbrNeutral];

    fn near(a: [f64; 3], b: [f64; 3], tolerance: f64) -> bool {
        (0..3).all(|k| (a[k] - b[k]).abs() <= tolerance)
    }

    #[test]
    fn every_number_is_shown() {
        let odd = [
            f64::NAN,
            f64::INFINITY,
            f64::NEG_INFINITY,
            -1.0,
            0.0,
            -0.0,
            5e-324,
            1e308,
            f64::MAX,
        ];
        for tone in ALL {
            for (r, g) in odd.iter().flat_map(|r| odd.iter().map(move |g| (*r, *g))) {
                let shown = tone.display([r, g, 0.5]);
                assert!(
                    shown.iter().all(|v| (0.0..=1.0).contains(v)),
                    "{tone:?} {r} {g}: {shown:?}"
                );
            }
        }
    }

    #[test]
    fn greys_stay_grey_and_grow() {
        for tone in ALL {
            let shown = |v: f64| tone.display([v; 3]);
            let mut before = -1.0;
            for step in 0..200 {
                let grey = shown(libm::exp2(f64::from(step) / 10.0 - 14.0));
                assert!(
                    near(grey, [grey[0]; 3], 1e-12) && grey[0] >= before,
                    "{tone:?} {step}: {grey:?}"
                );
                before = grey[0];
            }
        }
    }

    #[test]
    fn agx_shows_middle_grey_in_the_middle_and_its_ends_at_the_ends() {
        let shown = |v: f64| Tone::Agx.display([v; 3])[0];
        assert!((shown(0.18) - 0.5).abs() < 1e-12);
        // 2^−12.47393 and 2^4.026069, the ends of the range.
        assert!(
            shown(libm::exp2(-12.473_931_188)) < 1e-9
                && shown(libm::exp2(4.026_068_812)) > 1.0 - 1e-9
        );
        assert!(
            near(Tone::Agx.display([1e9, 0.0, 0.0]), [1.0; 3], 1e-9),
            "a blinding red is white"
        );
    }

    #[test]
    fn the_scales_of_agx_are_those_of_its_formula() {
        for ((power, scale), reach) in [(TOE, PIVOT), (SHOULDER, 1.0 - PIVOT)] {
            assert_eq!(scale, libm::pow(4.0, power) - libm::pow(reach, -power));
        }
    }

    #[test]
    fn the_curve_of_agx_is_the_one_that_polynomials_are_fitted_to() {
        // The fit of degree 6 by Benjamin Wrensch ("Minimal AgX", 2023).
        let fit = [-0.002_32, 0.119_1, 0.429_8, -6.868, 31.96, -40.14, 15.5];
        for k in 0..=1000 {
            let x = f64::from(k) / 1000.0;
            let polynomial = fit.iter().rev().fold(0.0, |sum, c| sum * x + c);
            let difference = (sigmoid(x) - polynomial).abs();
            assert!(difference < 0.006, "{x}: {difference}");
        }
    }

    #[test]
    fn the_inset_of_agx_has_the_matrix_published() {
        let [r, g, b] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]].map(agx_grey);
        let diagonal = [
            0.842_401_070_950_5,
            0.878_436_501_561_8,
            0.879_162_427_487_7,
        ];
        let inverse = [
            1.196_998_661_311_9,
            1.151_954_373_047_7,
            1.151_046_965_640_3,
        ];
        assert!(near([r, g, b].map(|w| 0.8 + 0.2 * w), diagonal, 1e-12));
        assert!(near([r, g, b].map(|w| 1.25 - 0.25 * w), inverse, 1e-12));
    }

    #[test]
    fn neutral_keeps_base_colours_and_compresses_highlights() {
        let shown = |linear: [f64; 3]| Tone::PbrNeutral.display(linear).map(srgb_decoded);
        // Under white light a base colour c has the radiance c + 0.04, and shows as c up to 0.8.
        assert!(near(shown([0.54, 0.24, 0.14]), [0.5, 0.2, 0.1], 1e-6));
        assert!(near(shown([0.8; 3]), [0.76; 3], 1e-6));
        // By hand: p = 0.96, pn = 1 − 0.0576/0.44; greys do not fade.
        assert!(near(shown([1.0; 3]), [1.0 - 0.0576 / 0.44; 3], 1e-6));
        // By hand: x = 0, p = 2, pn = 1 − 0.0576/1.48, g = 1/(0.15·(2 − pn) + 1).
        let pn = 1.0 - 0.0576 / 1.48;
        let g = 1.0 / (0.15 * (2.0 - pn) + 1.0);
        assert!(near(
            shown([2.0, 1.0, 0.0]),
            [pn, pn * g / 2.0 + pn * (1.0 - g), pn * (1.0 - g)],
            1e-6
        ));
        assert!(
            near(shown([0.04; 3]), [0.01; 3], 1e-6),
            "0.04 − (0.04 − 0.04²/0.16)"
        );
    }
}
