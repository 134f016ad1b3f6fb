//! The curve that colours are compared and blended after: √(x / (1 + x)), from 0 to 1.

/// More is as good as infinite.
const MOST: f64 = 1e9;

/// A value after the curve.
pub(super) fn compress(value: f64) -> f64 {
    // Not a number counts as none.
    let value = if value > 0.0 { value.min(MOST) } else { 0.0 };
    (value / (1.0 + value)).sqrt()
}

/// The first linear value, a share of the way to the second after the curve √(x / (1 + x)): so a
/// firefly fades with the share that a display shows of it.
#[must_use]
pub fn blend(from: f64, to: f64, share: f64) -> f64 {
    if share <= 0.0 {
        return from;
    }
    let compressed = compress(from) + share * (compress(to) - compress(from));
    let square = (compressed * compressed).min(MOST / (1.0 + MOST));
    square / (1.0 - square)
}
