//! Ties: of surfaces that coincide within rounding, the first in the scene is hit, in any order of
//! traversal.
//!
//! Each hit has an interval of t, its rounding error. Consider all hits whose interval overlaps
//! that of the hit with the least upper end: the one with the lowest key wins. This set does not
//! depend on the order of traversal.

use crate::ray::{Interaction, Ray};
use rtc_math::U;

/// The maximum half-width of an interval, as a fraction of t: for a ray nearly parallel to a
/// surface, the error is unbounded.
const WIDEST: f64 = 1.0 / 8_388_608.0;

/// Intervals with centres farther apart than this ratio do not overlap. Hierarchies are searched
/// beyond that.
pub(crate) const CLOSE: f64 = 1.0 + 2.5 * WIDEST;

/// The bound on the rounding of a root, to either side: that of the root of a plane, plus the
/// displacement of the surface along its normal, which is half of the offset of new rays.
pub(crate) fn error(ray: &Ray, t: f64, at: &Interaction) -> f64 {
    const ROOT: f64 = 10.0 * U;
    let slope = ray.direction.dot(at.normal).abs();
    (ROOT * t + 0.5 * at.offset / slope).min(WIDEST * t)
}

/// The closest of some hits, and whether it ties with another.
#[derive(Clone, Copy)]
pub(crate) struct ClosestHit<K> {
    pub(crate) t: f64,
    pub(crate) key: K,
    /// The next one.
    next: f64,
}

impl<K: Copy + Ord> ClosestHit<K> {
    /// No hit yet, up to `t_max`; `none` is above all keys.
    #[inline]
    pub(crate) fn up_to(t_max: f64, none: K) -> Self {
        Self {
            t: t_max,
            key: none,
            next: f64::INFINITY,
        }
    }

    /// Adds a hit.
    #[inline]
    pub(crate) fn add(&mut self, t: f64, key: K) {
        if t < self.t || (t == self.t && key < self.key) {
            *self = Self {
                t,
                key,
                next: self.t,
            };
        } else if t < self.next {
            self.next = t;
        }
    }

    /// The largest t of a hit that may tie.
    #[inline]
    pub(crate) fn limit(&self) -> f64 {
        self.t * CLOSE
    }

    /// Whether another hit may tie.
    #[inline]
    pub(crate) fn is_tied(&self) -> bool {
        self.next <= self.limit()
    }
}

/// All hits that may be the closest.
pub(crate) struct ClosestHitCandidates<K> {
    hits: Vec<(f64, f64, K)>,
    /// The least upper end of their intervals.
    bound: f64,
}

impl<K: Copy + Ord> ClosestHitCandidates<K> {
    /// None yet.
    pub(crate) fn new() -> Self {
        Self {
            hits: Vec::new(),
            bound: f64::INFINITY,
        }
    }

    /// Adds a hit with its error.
    pub(crate) fn add(&mut self, t: f64, error: f64, key: K) {
        self.bound = self.bound.min(t + error);
        self.hits.push((t, error, key));
    }

    /// The hit that is taken.
    pub(crate) fn first(self) -> Option<(f64, K)> {
        let near = self
            .hits
            .into_iter()
            .filter(|(t, error, _)| t - error <= self.bound);
        near.min_by_key(|(_, _, key)| *key)
            .map(|(t, _, key)| (t, key))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// All orders of some hits.
    fn orders(hits: &[(f64, f64, u32)]) -> Vec<Vec<(f64, f64, u32)>> {
        let Some((last, rest)) = hits.split_last() else {
            return vec![Vec::new()];
        };
        let insert = |order: Vec<(f64, f64, u32)>| {
            (0..=order.len()).map(move |place| {
                let mut order = order.clone();
                order.insert(place, *last);
                order
            })
        };
        orders(rest).into_iter().flat_map(insert).collect()
    }

    #[test]
    fn the_first_of_those_that_meet_the_surely_nearest_wins_in_any_order() {
        // The first overlaps the second, and the second the third, which is certainly the nearest.
        let hits = [(5.0, 1.0, 0), (4.0, 0.5, 1), (3.3, 0.3, 2), (4.2, 0.1, 3)];
        for order in orders(&hits) {
            let mut tie = ClosestHitCandidates::new();
            order
                .iter()
                .for_each(|(t, error, key)| tie.add(*t, *error, *key));
            assert_eq!(tie.first(), Some((4.0, 1)), "{order:?}");
        }
    }

    #[test]
    fn the_nearest_knows_of_a_tie_in_any_order() {
        let next = 1.0 + 2.0 * WIDEST;
        for (hits, tied) in [
            ([1.0, next, 9.0], true),
            ([1.0, 1.0 + 4.0 * WIDEST, 9.0], false),
            ([9.0, 1.0, 1.0], true),
        ] {
            let hits = [(hits[0], 0.0, 0), (hits[1], 0.0, 1), (hits[2], 0.0, 2)];
            for order in orders(&hits) {
                let mut nearest = ClosestHit::up_to(f64::INFINITY, u32::MAX);
                order.iter().for_each(|(t, _, key)| nearest.add(*t, *key));
                assert_eq!((nearest.t, nearest.is_tied()), (1.0, tied), "{order:?}");
            }
        }
    }
}
