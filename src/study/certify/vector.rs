//! Vectors whose coordinates are sets of numbers.

use super::number::CertifiedNumber;
use rtc_math::{U, Vec3, Vector};

/// A vector of certified numbers.
pub(super) trait CertifiedVector: Sized {
    /// One vector, which must be finite.
    fn point(vector: Vec3) -> Self;

    /// The unit vector along it; its components have no bound but 1 if it may be 0.
    fn normalized(self) -> Self;

    /// The sum of its coordinates times three vectors.
    fn combined(self, vectors: [Self; 3]) -> Self;

    /// A vector about in the middle, and a bound on the distance of the others.
    fn middle(self) -> (Vec3, f64);
}

impl<N: CertifiedNumber> CertifiedVector for Vector<N> {
    fn point(vector: Vec3) -> Self {
        Self::from(vector.to_array().map(N::point))
    }

    fn normalized(self) -> Self {
        let length = self.length();
        self.map(|x| (x / length).clamp(-1.0, 1.0))
    }

    fn combined(self, [x, y, z]: [Self; 3]) -> Self {
        x * self.x + y * self.y + z * self.z
    }

    fn middle(self) -> (Vec3, f64) {
        let [x, y, z] = self.into_array().map(|part| {
            let (low, high) = (part.low(), part.high());
            let middle = 0.5 * low + 0.5 * high;
            (middle, (high - middle).max(middle - low))
        });
        let radius = (x.1 + y.1 + z.1) * (1.0 + 8.0 * U);
        (Vec3::new(x.0, y.0, z.0), radius)
    }
}
