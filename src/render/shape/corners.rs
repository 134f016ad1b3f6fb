//! Attributes at the corners of a triangle, and their interpolation.

use rtc_math::VertexColumn;

/// The side of the second axis of a normal map: against v, which glTF counts downwards.
pub(in crate::shape) fn handedness([a, b, c]: [[f64; 2]; 3]) -> f64 {
    let area = (b[0] - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (b[1] - a[1]);
    -1.0_f64.copysign(area)
}

/// The values of a column, which may be empty, at three corners.
#[inline]
pub(in crate::shape) fn corner_values<const N: usize>(
    column: &VertexColumn<N>,
    [a, b, c]: [u32; 3],
) -> Option<[[f64; N]; 3]> {
    (!column.is_empty()).then(|| {
        [
            column.at(a as usize),
            column.at(b as usize),
            column.at(c as usize),
        ]
    })
}

/// The mean with these weights of the corners.
#[inline]
pub(in crate::shape) fn blend([a, b, c]: [[f64; 4]; 3], [u, v, w]: [f64; 3]) -> [f64; 4] {
    let mean = |k: usize| u * a[k] + v * b[k] + w * c[k];
    [mean(0), mean(1), mean(2), mean(3)]
}

/// The uv at a point with these weights of the corners.
#[inline]
pub(crate) fn interpolate([a, b, c]: [[f64; 2]; 3], [u, v, w]: [f64; 3]) -> [f64; 2] {
    let mean = |k: usize| u * a[k] + v * b[k] + w * c[k];
    [mean(0), mean(1)]
}
