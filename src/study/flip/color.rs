//! The colour spaces of FLIP, and its colour distance.

use rtc_math::{Vec3, pow};

/// The HyAB distance of two colours: city-block distance in lightness, Euclidean in chroma (Abasi
/// et al., "Distance metrics for very large color differences", Color Research & Application 45
/// (2020)).
pub(super) fn hyab(a: Vec3, b: Vec3) -> f64 {
    let d = a - b;
    d.x.abs() + (d.y * d.y + d.z * d.z).sqrt()
}

/// The distance of two display colours in CIELAB: ΔE*ab (CIE 1976), of which 1 is about the just
/// noticeable difference.
pub(crate) fn delta_e(a: [f64; 3], b: [f64; 3]) -> f64 {
    let [a, b] = [a, b].map(|color| linear_to_lab(to_linear(color)));
    (a - b).length()
}

/// The Hunt effect: dark colours look less saturated.
pub(super) fn hunt(lab: Vec3) -> Vec3 {
    Vec3::new(lab.x, 0.01 * lab.x * lab.y, 0.01 * lab.x * lab.z)
}

pub(super) fn to_linear(display: [f64; 3]) -> Vec3 {
    let channel = |v: f64| {
        if v <= 0.04045 {
            v / 12.92
        } else {
            pow((v + 0.055) / 1.055, 2.4)
        }
    };
    Vec3::from_array(display.map(|v| channel(v.clamp(0.0, 1.0))))
}

/// The rows of the matrix from linear sRGB to CIE XYZ (IEC 61966-2-1), as exact fractions.
const XYZ_FROM_LINEAR: [Vec3; 3] = [
    Vec3::new(
        10_135_552.0 / 24_577_794.0,
        8_788_810.0 / 24_577_794.0,
        4_435_075.0 / 24_577_794.0,
    ),
    Vec3::new(
        2_613_072.0 / 12_288_897.0,
        8_788_810.0 / 12_288_897.0,
        887_015.0 / 12_288_897.0,
    ),
    Vec3::new(
        1_425_312.0 / 73_733_382.0,
        8_788_810.0 / 73_733_382.0,
        70_074_185.0 / 73_733_382.0,
    ),
];

pub(super) fn linear_to_xyz(color: Vec3) -> Vec3 {
    Vec3::from_array(XYZ_FROM_LINEAR.map(|row| row.dot(color)))
}

/// The inverse, by Cramer's rule.
pub(super) fn xyz_to_linear(xyz: Vec3) -> Vec3 {
    let [r0, r1, r2] = XYZ_FROM_LINEAR;
    let determinant = r0.dot(r1.cross(r2));
    (r1.cross(r2) * xyz.x + r2.cross(r0) * xyz.y + r0.cross(r1) * xyz.z) / determinant
}

/// XYZ relative to the reference white.
fn relative(xyz: Vec3) -> Vec3 {
    xyz / linear_to_xyz(Vec3::ONE)
}

/// YCxCz, a linear form of CIELAB.
pub(super) fn xyz_to_opponent(xyz: Vec3) -> Vec3 {
    let q = relative(xyz);
    Vec3::new(116.0 * q.y - 16.0, 500.0 * (q.x - q.y), 200.0 * (q.y - q.z))
}

pub(super) fn opponent_to_xyz(color: Vec3) -> Vec3 {
    let y = (color.x + 16.0) / 116.0;
    Vec3::new(y + color.y / 500.0, y, y - color.z / 200.0) * linear_to_xyz(Vec3::ONE)
}

pub(super) fn linear_to_lab(color: Vec3) -> Vec3 {
    /// Below this value the cube root is replaced by a line (CIE 1976).
    const DELTA: f64 = 6.0 / 29.0;
    let f = |t: f64| {
        if t > DELTA * DELTA * DELTA {
            pow(t, 1.0 / 3.0)
        } else {
            t / (3.0 * DELTA * DELTA) + 4.0 / 29.0
        }
    };
    let q = relative(linear_to_xyz(color));
    let (x, y, z) = (f(q.x), f(q.y), f(q.z));
    Vec3::new(116.0 * y - 16.0, 500.0 * (x - y), 200.0 * (y - z))
}
