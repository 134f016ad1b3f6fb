//! Polygons cut into triangles: as the fan of the first corner where that covers them, else ear by
//! ear (Meisters, "Polygons have ears", American Mathematical Monthly 82, 1975).
//!
//! Corners are projected along the axis nearest to the normal. The side of an edge is decided
//! exactly, so rounding closes no notch.

use rtc_math::{two_difference, two_product, two_sum};

/// A point as seen along an axis.
type Point2 = [f64; 2];

/// The maximum number of comparisons for ears, per file and per corner; the rest of the polygon
/// becomes a fan.
const COMPARED: usize = 1 << 23;
const COMPARED_PER_CORNER: usize = 32;

/// Triangulates the polygons of a file by ear clipping.
#[derive(Debug)]
pub(crate) struct EarClipper {
    /// The remaining number of comparisons.
    left: usize,
    /// The corners of the polygon, flat.
    flat: Vec<Point2>,
    /// The corners that are not cut off so far.
    ring: Vec<usize>,
}

impl EarClipper {
    /// A triangulator for a file whose polygons have `corners` corners in all.
    pub(crate) fn new(corners: usize) -> Self {
        Self {
            left: COMPARED.saturating_add(COMPARED_PER_CORNER.saturating_mul(corners)),
            flat: Vec::new(),
            ring: Vec::new(),
        }
    }

    /// The triangles of a polygon of `count` corners, two less than those, each by three of them.
    /// `position` says where a corner is.
    pub(crate) fn cut(
        &mut self,
        count: usize,
        position: impl Fn(usize) -> [f64; 3],
        mut take: impl FnMut([usize; 3]),
    ) {
        let is_fan = count < 4 || {
            self.flatten(count, &position);
            self.is_fan()
        };
        if is_fan {
            return (2..count).for_each(|at| take([0, at - 1, at]));
        }
        self.ring.clear();
        self.ring.extend(0..count);
        while self.ring.len() > 3 && self.left > 0 {
            let Some(ear) = self.ear() else { break };
            take(self.around(ear));
            self.ring.remove(ear);
        }
        (2..self.ring.len()).for_each(|at| take([self.ring[0], self.ring[at - 1], self.ring[at]]));
    }

    /// Looks at the corners along the axis nearest to the normal, so that they go round to the
    /// left.
    fn flatten(&mut self, count: usize, position: impl Fn(usize) -> [f64; 3]) {
        // The normal of Newell, from the first corner.
        let first = position(0);
        let from_first = |at: usize| {
            let point = position(at);
            [0, 1, 2].map(|axis| point[axis] - first[axis])
        };
        let mut normal = [0.0; 3];
        for at in 2..count {
            let (a, b) = (from_first(at - 1), from_first(at));
            for (axis, sum) in normal.iter_mut().enumerate() {
                let (k, l) = ((axis + 1) % 3, (axis + 2) % 3);
                *sum += a[k] * b[l] - a[l] * b[k];
            }
        }
        let larger = |a: usize, b: usize| {
            if normal[b].abs() > normal[a].abs() {
                b
            } else {
                a
            }
        };
        let axis = larger(larger(0, 1), 2);
        let (mut k, mut l) = ((axis + 1) % 3, (axis + 2) % 3);
        if normal[axis] < 0.0 {
            (k, l) = (l, k);
        }
        self.flat.clear();
        self.flat.extend((0..count).map(|at| {
            let point = position(at);
            [point[k], point[l]]
        }));
    }

    /// Whether all triangles of the fan of the first corner have the same orientation.
    fn is_fan(&self) -> bool {
        let [first, rest @ ..] = &*self.flat else {
            return true;
        };
        rest.windows(2)
            .all(|pair| turn(*first, pair[0], pair[1]) >= 0.0)
    }

    /// A corner of the ring and its neighbours.
    fn around(&self, at: usize) -> [usize; 3] {
        let count = self.ring.len();
        [(at + count - 1) % count, at, (at + 1) % count].map(|place| self.ring[place])
    }

    /// A corner of the ring that can be cut off; a degenerate one only if there is no other.
    fn ear(&mut self) -> Option<usize> {
        let mut flat = None;
        for at in 0..self.ring.len() {
            let [a, b, c] = self.around(at).map(|corner| self.flat[corner]);
            let turn = turn(a, b, c);
            if turn == 0.0 {
                flat = flat.or(Some(at));
            }
            if turn <= 0.0 {
                continue;
            }
            self.left = self.left.saturating_sub(self.ring.len());
            // Coincident corners occur where a seam leads to a hole.
            let is_in = |p: Point2| {
                ![a, b, c].contains(&p)
                    && self::turn(a, b, p) >= 0.0
                    && self::turn(b, c, p) >= 0.0
                    && self::turn(c, a, p) >= 0.0
            };
            if !self.ring.iter().any(|corner| is_in(self.flat[*corner])) {
                return Some(at);
            }
        }
        flat
    }
}

/// Above 0 if the path from `a` over `b` to `c` turns left, below if right, 0 if straight: the sign
/// is exact (Shewchuk, "Adaptive precision floating-point arithmetic", 1997).
fn turn([ax, ay]: Point2, [bx, by]: Point2, [cx, cy]: Point2) -> f64 {
    /// (3 + 16 u)·u, for the rounding of two differences, a product and a difference.
    const ROUNDING: f64 = 3.330_669_073_875_471_6e-16;
    let (left, right) = ((ax - cx) * (by - cy), (ay - cy) * (bx - cx));
    let turn = left - right;
    if turn.abs() >= ROUNDING * (left.abs() + right.abs()) && turn != 0.0 {
        return turn;
    }
    let differences = [(ax, cx), (by, cy), (ay, cy), (bx, cx)].map(|(a, b)| two_difference(a, b));
    let [dx, ey, dy, ex] = differences.map(|(high, low)| [high, low]);
    let mut sum = [0.0; 16];
    let mut used = 0;
    for (factors, sign) in [([dx, ey], 1.0), ([dy, ex], -1.0)] {
        for (p, q) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
            let (high, low) = two_product(sign * factors[0][p], factors[1][q]);
            for term in [low, high] {
                add(&mut sum[..=used], term);
                used += 1;
            }
        }
    }
    // The last part that is not 0 outweighs all before it.
    sum.into_iter().rfind(|part| *part != 0.0).unwrap_or(0.0)
}

/// Adds a term to a sum without rounding, whose last part is still 0.
fn add(sum: &mut [f64], term: f64) {
    let mut carried = term;
    let Some((last, parts)) = sum.split_last_mut() else {
        return;
    };
    for part in parts {
        (carried, *part) = two_sum(carried, *part);
    }
    *last = carried;
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The triangles of a flat polygon.
    fn cut(corners: &[Point2]) -> Vec<[usize; 3]> {
        let (mut clipper, mut triangles) = (EarClipper::new(corners.len()), Vec::new());
        let position = |at: usize| [corners[at][0], 7.0, -corners[at][1]];
        clipper.cut(corners.len(), position, |triangle| triangles.push(triangle));
        triangles
    }

    fn area(corners: &[Point2], [a, b, c]: [usize; 3]) -> f64 {
        let [[ax, ay], [bx, by], [cx, cy]] = [corners[a], corners[b], corners[c]];
        ((bx - ax) * (cy - ay) - (by - ay) * (cx - ax)) / 2.0
    }

    #[test]
    fn a_convex_polygon_is_the_fan_of_its_first_corner() {
        let corners = [[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [1.0, 2.0], [0.0, 1.0]];
        assert_eq!(cut(&corners), [[0, 1, 2], [0, 2, 3], [0, 3, 4]]);
    }

    #[test]
    fn a_notch_stays_open() {
        let corners = [[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [1.0, 0.5], [0.0, 2.0]];
        let triangles = cut(&corners);
        let areas: Vec<f64> = triangles
            .iter()
            .map(|three| area(&corners, *three))
            .collect();
        assert!(areas.iter().all(|area| *area > 0.0), "{triangles:?}");
        assert_eq!((areas.len(), areas.iter().sum::<f64>()), (3, 2.5));
    }

    #[test]
    fn a_seam_leads_to_a_hole() {
        // A square of 4 × 4, with a seam to a square hole of 2 × 2 of opposite orientation.
        let corners = [
            [0.0, 0.0],
            [4.0, 0.0],
            [4.0, 4.0],
            [0.0, 4.0],
            [0.0, 0.0],
            [1.0, 1.0],
            [1.0, 3.0],
            [3.0, 3.0],
            [3.0, 1.0],
            [1.0, 1.0],
        ];
        let triangles = cut(&corners);
        let areas = triangles.iter().map(|three| area(&corners, *three));
        assert!(areas.clone().all(|area| area >= 0.0), "{triangles:?}");
        assert_eq!((triangles.len(), areas.sum::<f64>()), (8, 12.0));
    }

    #[test]
    fn sides_are_told_exactly() {
        // On the line, and a last bit off it, far from the origin.
        let far = 1e8;
        assert_eq!(
            turn([far, far], [far + 0.1, far + 0.1], [far + 0.3, far + 0.3]),
            0.0
        );
        let up = (far + 0.3).next_up();
        assert!(turn([far, far], [far + 0.1, far + 0.1], [far + 0.3, up]) > 0.0);
        assert!(turn([far, far], [far + 0.1, far + 0.1], [up, far + 0.3]) < 0.0);
    }

    #[test]
    fn what_is_left_after_many_comparisons_is_a_fan() {
        // A comb: every other corner is a notch.
        let count = 4096;
        let tooth = |at: usize| [at as f64, if at.is_multiple_of(2) { 1.0 } else { 2.0 }];
        let mut corners = vec![[(count - 1) as f64, 0.0], [0.0, 0.0]];
        corners.extend((0..count).map(tooth));
        corners.reverse();
        let triangles = cut(&corners);
        assert_eq!(triangles.len(), corners.len() - 2);
        let mut clipper = EarClipper::new(corners.len());
        let before = clipper.left;
        clipper.cut(
            corners.len(),
            |at| [corners[at][0], corners[at][1], 0.0],
            |_| {},
        );
        assert!(clipper.left < before, "it is counted");
    }
}
