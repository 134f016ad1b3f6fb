//! Points on the hull of others: their extremes in some directions.

use rtc_ir::Mesh;
use rtc_math::{Vec3, cos_sin_revolutions, golden_revolutions, to_u32};
use std::sync::LazyLock;

/// The directions besides the axes. Two neighbours are 16° apart, so that the hull is at most 3 %
/// too narrow.
const BETWEEN: usize = 122;

/// The directions: those of the axes, and a Fibonacci lattice on the sphere.
static DIRECTIONS: LazyLock<Vec<Vec3>> = LazyLock::new(|| {
    let axes = Vec3::AXES.into_iter().flat_map(|axis| [axis, -axis]);
    let between = (0..BETWEEN as u64).map(|at| {
        let z = 1.0 - (2 * at + 1) as f64 / BETWEEN as f64;
        let (c, s) = cos_sin_revolutions(golden_revolutions(at));
        let radius = (1.0 - z * z).sqrt();
        Vec3::new(radius * c, radius * s, z)
    });
    axes.chain(between).collect()
});

/// The extremes of points; none before the first point.
#[derive(Default)]
pub(crate) struct SweptHull(Vec<Vec3>);

impl SweptHull {
    /// The most points of a hull.
    pub(crate) const POINTS: usize = BETWEEN + 6;

    /// The hull of points.
    pub(crate) fn of(points: &[Vec3]) -> Self {
        let mut hull = Self::default();
        points.iter().for_each(|point| hull.add(*point));
        hull
    }

    /// Adds a point.
    pub(crate) fn add(&mut self, point: Vec3) {
        if !point.is_finite() {
            return;
        }
        if self.0.is_empty() {
            self.0 = vec![point; DIRECTIONS.len()];
        }
        for (extreme, direction) in self.0.iter_mut().zip(DIRECTIONS.iter()) {
            if direction.dot(point) > direction.dot(*extreme) {
                *extreme = point;
            }
        }
    }

    /// The extreme points.
    pub(crate) fn points(mut self) -> Vec<Vec3> {
        let key = |point: &Vec3| point.to_array().map(f64::to_bits);
        self.0.sort_unstable_by_key(key);
        self.0.dedup_by_key(|point| key(point));
        self.0
    }

    /// A mesh that uses the extreme points as vertices; its triangles have no area.
    pub(crate) fn mesh(self) -> Mesh {
        let points = self.points();
        Mesh {
            triangles: (0..to_u32(points.len())).map(|at| [at; 3]).collect(),
            positions: points.iter().map(|point| point.to_array()).collect(),
            ..Mesh::default()
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_hull_of_a_ball_is_a_ball_of_few_points() {
        let ball = (0..20_000_u64).map(|at| {
            let z = 1.0 - (2 * at + 1) as f64 / 20_000.0;
            let (c, s) = cos_sin_revolutions(golden_revolutions(at));
            Vec3::new((1.0 - z * z).sqrt() * c, (1.0 - z * z).sqrt() * s, z)
        });
        let points = SweptHull::of(&ball.collect::<Vec<_>>()).points();
        assert!(points.len() <= SweptHull::POINTS);
        for at in 0..1000 {
            let (c, s) = cos_sin_revolutions(golden_revolutions(7 * at));
            let z = at as f64 / 500.0 - 1.0;
            let direction = Vec3::new((1.0 - z * z).sqrt() * c, (1.0 - z * z).sqrt() * s, z);
            let reach = points.iter().map(|point| point.dot(direction));
            assert!(reach.fold(0.0, f64::max) > 0.96, "{direction}");
        }
        // The box of a hull is that of the points.
        let [low, high] = [Vec3::new(-3.0, 0.5, 2.0), Vec3::new(1.0, 4.0, 2.5)];
        let corners = SweptHull::of(&[low, high, (low + high) / 2.0]).points();
        assert_eq!(corners.len(), 2);
        assert!(SweptHull::of(&[]).points().is_empty());
    }
}
