//! Sample values keyed by pixel, sample and path vertex.
//!
//! - [`PathVertexKey`] is the seed of a pixel, a vertex or a dimension; hashes derive one from
//!   another.
//! - `sobol` and `owen` are the sequence of path tracing: scrambled groups of four dimensions, with
//!   neighbouring pixels on one sequence.
//! - `sequence` are the samples of the Whitted integrator in the pixel and on the lens.
//! - `discrete` samples tabulated distributions, such as environment maps.
//!
//! A value depends neither on time nor on the order of calls.

pub(crate) mod discrete;
mod owen;
pub(crate) mod sequence;
pub(crate) mod sobol;

use rtc_math::{
    NonNegative, OrthonormalBasis, Vec3, cos_sin_revolutions, fraction, golden_revolutions, mix,
    pow,
};

/// The key of one vertex of one path.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct PathVertexKey(u64);

impl PathVertexKey {
    /// The key without randomness.
    pub(crate) const UNUSED: Self = Self(0);

    /// The key of a camera ray.
    #[must_use]
    pub(crate) fn new(pixel: [u32; 2], sample: u64) -> Self {
        Self(mix(u64::from(pixel[0]) << 32 | u64::from(pixel[1]))).child(sample)
    }

    /// The key with a seed mixed in; 0 changes nothing.
    #[must_use]
    pub(crate) fn seeded(self, seed: u64) -> Self {
        if seed == 0 {
            self
        } else {
            self.child(mix(seed))
        }
    }

    /// The key of branch `branch` of the path.
    #[must_use]
    pub(crate) fn child(self, branch: u64) -> Self {
        Self(mix(self.0.rotate_left(32) ^ mix(branch)))
    }

    /// 64 bits for one dimension of this point.
    pub(crate) fn bits(self, dimension: u64) -> u64 {
        self.child(dimension).0
    }

    /// A number in [0, 1) for one dimension of this point.
    pub(crate) fn uniform(self, dimension: u64) -> f64 {
        fraction(self.bits(dimension))
    }
}

/// The number of the next decision, in [0, 1), where a number was found in an interval: how far
/// above its lower end, over its width. An interval of no width gives a number, too.
#[expect(clippy::manual_clamp, reason = "0/0 becomes a number")]
#[inline]
pub(crate) fn remapped(above: f64, width: f64) -> f64 {
    (above / width).min(1.0 - f64::EPSILON).max(0.0)
}

/// Points spread evenly over a disc of radius 1: a golden spiral, turned by a number of the key.
#[derive(Clone, Copy, Debug)]
pub(crate) struct DiscPoints {
    count: u32,
    /// In [0, 1), as a fraction of the area of one point: uniform, it spreads any number of points
    /// without bias.
    shift: f64,
    /// In units of 2⁻⁶⁴ turns.
    rotation: u64,
}

impl DiscPoints {
    /// A set of `count` points, each in the middle of its ring or, if `spread`, anywhere in it.
    #[must_use]
    pub(crate) fn new(count: u32, key: PathVertexKey, spread: bool) -> Self {
        let shift = if spread { key.uniform(3) } else { 0.5 };
        Self {
            count,
            shift,
            rotation: key.bits(2),
        }
    }

    /// Point k.
    #[must_use]
    pub(crate) fn point(&self, k: u32) -> [f64; 2] {
        let r = ((f64::from(k) + self.shift) / f64::from(self.count)).sqrt();
        let (x, y) =
            cos_sin_revolutions(golden_revolutions(u64::from(k)).wrapping_add(self.rotation));
        [r * x, r * y]
    }
}

/// Directions around an axis with a density proportional to cosⁿ of the angle to it.
///
/// Stratified: the cosines take equal fractions of the distribution, the azimuths are golden angles
/// apart, and both are shifted by numbers of the key.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PhongLobeSampler {
    basis: OrthonormalBasis,
    exponent: f64,
    count: u32,
    shift: f64,
    /// In units of 2⁻⁶⁴ turns.
    rotation: u64,
}

impl PhongLobeSampler {
    /// The lobe of `count` directions around the unit vector `axis`.
    #[must_use]
    pub(crate) fn new(axis: Vec3, n: NonNegative, count: u32, key: PathVertexKey) -> Self {
        let (shift, rotation) = (key.uniform(0), key.bits(1));
        Self {
            basis: OrthonormalBasis::around(axis),
            exponent: 1.0 / (n.get() + 1.0),
            count,
            shift,
            rotation,
        }
    }

    /// Direction k, a unit vector.
    #[must_use]
    pub(crate) fn direction(&self, k: u32) -> Vec3 {
        let fraction = (f64::from(k) + self.shift) / f64::from(self.count);
        let cosine = pow(fraction, self.exponent).min(1.0);
        let sine = ((1.0 - cosine) * (1.0 + cosine)).sqrt();
        let (x, y) =
            cos_sin_revolutions(golden_revolutions(u64::from(k)).wrapping_add(self.rotation));
        self.basis
            .to_world(Vec3::new(sine * x, sine * y, cosine))
            .normalize()
    }

    /// The number of directions on the side of both normals, as long as the count continues.
    #[must_use]
    pub(crate) fn count_above(
        &self,
        normals: [Vec3; 2],
        mut should_continue: impl FnMut() -> bool,
    ) -> u32 {
        let directions = (0..self.count)
            .take_while(|_| should_continue())
            .map(|k| self.direction(k));
        let above = directions
            .filter(|direction| is_above(*direction, normals))
            .count();
        u32::try_from(above).unwrap_or(self.count)
    }
}

/// Whether a direction is on the side of both normals.
pub(crate) fn is_above(direction: Vec3, normals: [Vec3; 2]) -> bool {
    normals
        .into_iter()
        .all(|normal| direction.dot(normal) > 0.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_mean_cosine_of_a_lobe_is_that_of_its_density() {
        for n in [0.0, 1.0, 8.0, 64.0] {
            let lobe = PhongLobeSampler::new(
                Vec3::Z,
                NonNegative::new(n).unwrap(),
                1 << 14,
                PathVertexKey::new([3, 4], 5),
            );
            let mean =
                (0..lobe.count).map(|k| lobe.direction(k).z).sum::<f64>() / f64::from(lobe.count);
            // ∫ cosⁿ⁺¹ / ∫ cosⁿ over the hemisphere.
            assert!(
                (mean - (n + 1.0) / (n + 2.0)).abs() < 1e-4,
                "n = {n}: {mean}"
            );
        }
    }

    #[test]
    fn directions_of_a_lobe_balance_around_its_axis() {
        let lobe = PhongLobeSampler::new(
            Vec3::X,
            NonNegative::new(8.0).unwrap(),
            1 << 12,
            PathVertexKey::new([0, 0], 1),
        );
        let sum = (0..lobe.count).map(|k| lobe.direction(k)).sum::<Vec3>() / f64::from(lobe.count);
        assert!(sum.y.abs() < 1e-3 && sum.z.abs() < 1e-3, "{sum}");
    }

    #[test]
    fn keys_of_neighbours_differ() {
        let keys = [
            PathVertexKey::new([0, 1], 0),
            PathVertexKey::new([1, 0], 0),
            PathVertexKey::new([0, 0], 1),
            PathVertexKey::new([0, 0], 0).child(1),
        ];
        for (i, a) in keys.iter().enumerate() {
            assert!(keys[i + 1..].iter().all(|b| a != b));
        }
    }
}
