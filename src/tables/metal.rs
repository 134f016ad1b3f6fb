//! The complex indices of refraction of conductors at red, green and blue.
//!
//! The rows come from measured spectra (Palik, "Handbook of Optical Constants of Solids", 1985, and
//! the tables of SOPRA) as `conductor` of Mitsuba 3 has them: the variant `scalar_rgb` integrates
//! each spectrum into `eta.value` and `k.value`, here rounded to six digits. The last rows have no
//! such spectrum and are the numbers that RGB renderers use.

/// A conductor.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Metal {
    /// Its chemical symbol, as the files of pbrt and Mitsuba have it.
    pub symbol: &'static str,
    /// The name in scene files, of the usual metals.
    pub name: Option<&'static str>,
    /// The real part η of the index, for red, green and blue.
    pub eta: [f64; 3],
    /// The absorption coefficient k, for red, green and blue.
    pub k: [f64; 3],
}

const fn metal(
    symbol: &'static str,
    name: Option<&'static str>,
    eta: [f64; 3],
    k: [f64; 3],
) -> Metal {
    Metal {
        symbol,
        name,
        eta,
        k,
    }
}

/// Conductors by their symbols. The numbers are those of linear Rec. 709 that Mitsuba 3 computes
/// from the measured spectra.
#[rustfmt::skip]
pub const METALS: &[Metal] = &[
    metal("Ag", Some("silver"), [0.155276, 0.116728, 0.138388], [4.82835, 3.12222, 2.1469]),
    metal("Al", Some("aluminium"), [1.6575, 0.880405, 0.521244], [9.22381, 6.2695, 4.837]),
    metal("AlAs", None, [3.6053, 3.23294, 2.21632], [0.000679437, 0.0, 0.00751271]),
    metal("AlSb", None, [0.0, 4.13937, 4.66925], [0.0, 0.0940091, 1.30057]),
    metal("Au", Some("gold"), [0.143036, 0.375307, 1.44205], [3.983, 2.38556, 1.60336]),
    metal("Be", None, [4.18501, 3.18503, 2.78406], [3.83547, 3.01012, 2.86899]),
    metal("Cr", Some("chromium"), [4.36967, 2.91651, 1.6549], [5.20655, 4.23131, 3.7547]),
    metal("CsI", None, [2.1449, 1.70232, 1.66243], [0.0, 0.0, 0.0]),
    metal("Cu", Some("copper"), [0.201005, 0.92375, 1.10222], [3.91326, 2.45305, 2.14209]),
    metal("Cu2O", None, [3.55177, 2.94987, 2.75188], [0.114207, 0.193897, 0.606134]),
    metal("CuO", None, [3.24754, 2.44781, 2.21022], [0.52109, 0.570031, 0.722179]),
    metal("Hg", None, [2.39894, 1.44003, 0.90957], [6.32759, 4.37192, 3.42176]),
    metal("HgTe", None, [4.77904, 3.2312, 2.6599], [1.63161, 1.58081, 1.72929]),
    metal("Ir", None, [3.0863, 2.08219, 1.61791], [5.59215, 4.06709, 3.26731]),
    metal("K", None, [0.0640432, 0.0464098, 0.0381849], [2.1042, 1.34894, 0.913126]),
    metal("Li", None, [0.265791, 0.195618, 0.220949], [3.54015, 2.31112, 1.66861]),
    metal("MgO", None, [2.08958, 1.65072, 1.59488], [4.3327e-12, 0.0, 2.49865e-11]),
    metal("Mo", None, [4.48397, 3.52513, 2.77631], [4.11144, 3.42083, 3.15061]),
    metal("Na", None, [0.0602694, 0.0561409, 0.0619884], [3.17927, 2.11249, 1.57904]),
    metal("Nb", None, [3.42007, 2.79009, 2.39563], [3.44139, 2.73767, 2.57975]),
    metal("Ni", Some("nickel"), [2.3673, 1.66337, 1.46708], [4.49881, 3.05015, 2.34544]),
    metal("Rh", None, [2.58579, 1.86022, 1.55426], [6.78226, 4.70299, 3.97607]),
    metal("Se", None, [4.05831, 2.84294, 2.82085], [0.75405, 0.638444, 0.521808]),
    metal("SiC", None, [3.17234, 2.52597, 2.47937], [7.53766e-07, 0.0, 1.01925e-05]),
    metal("SnTe", None, [4.52425, 1.98164, 1.28159], [0.0, 0.0, 0.0]),
    metal("Ta", None, [2.06272, 2.39294, 2.62793], [2.40836, 1.74149, 1.94703]),
    metal("Te", None, [7.39023, 4.4821, 2.63711], [3.25602, 3.52706, 3.29205]),
    metal("ThF4", None, [1.83071, 1.44223, 1.38765], [0.0, 0.0, 0.0]),
    metal("TiC", None, [3.70053, 2.83742, 2.58229], [3.26564, 2.35159, 2.17279]),
    metal("TiN", None, [1.64845, 1.15052, 1.37982], [3.36833, 1.9435, 1.10207]),
    metal("TiO2", None, [3.45661, 2.80174, 2.90517], [0.000105265, 0.0, 0.000652887]),
    metal("VC", None, [3.65757, 2.75274, 2.53267], [3.0683, 2.19869, 1.96319]),
    metal("VN", None, [2.8656, 2.11919, 1.94009], [3.03224, 2.05612, 1.61631]),
    metal("V", None, [4.27758, 3.51295, 2.76107], [3.4913, 2.88945, 3.11152]),
    metal("W", Some("tungsten"), [4.37082, 3.30025, 2.99841], [3.50064, 2.60487, 2.27323]),
    metal("a-C", None, [2.94405, 2.22714, 1.96816], [0.887465, 0.799299, 0.81529]),
    metal("d-C", None, [2.70872, 2.31883, 2.2289], [0.0, 0.0, 0.0]),
    metal("CuZn", Some("brass"), [0.444, 0.527, 1.094], [3.695, 2.765, 1.829]),
    metal("Fe", Some("iron"), [2.87, 2.95, 2.65], [3.35, 2.93, 2.81]),
    metal("Ti", Some("titanium"), [2.74, 2.54, 2.27], [3.81, 3.43, 3.04]),
];
