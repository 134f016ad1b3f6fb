//! Tests on boxes and planes with a margin for rounding errors: every statement of a rule about
//! positions holds with this margin.
//!
//! Hits are accurate to about 10² ulps of the coordinates. The rules use [`MARGIN`], 2²¹ ulps, so
//! that boxes that a rule finds disjoint are disjoint for rays, too.

use rtc_math::{Bounds, Vec3};

/// The margin, as a fraction of the coordinates: 2⁻³².
pub(crate) const MARGIN: f64 = 1.0 / 4_294_967_296.0;

/// Tests on boxes with a margin.
pub(crate) trait BoxMargins {
    /// Whether two boxes are certainly disjoint.
    fn is_disjoint_from(&self, other: &Self) -> bool;

    /// Whether a segment from this box to `end` may hit `other`.
    ///
    /// At the parameter τ all segments are in the box `(1 − τ)·self + τ·end`. Each face of `other`
    /// bounds τ by a linear inequality (a slab test); if no τ satisfies all of them, no segment
    /// hits it.
    fn segment_may_hit(&self, end: &Self, other: &Self) -> bool;
}

impl BoxMargins for Bounds {
    fn is_disjoint_from(&self, other: &Self) -> bool {
        let margin = MARGIN * (self.reach() + other.reach());
        (self.min - other.max)
            .max(other.min - self.max)
            .max_element()
            > margin
    }

    fn segment_may_hit(&self, end: &Self, other: &Self) -> bool {
        /// A bound far above the rounding error of the bounds on τ, which are at most 1.
        const SLACK: f64 = MARGIN;
        let near = MARGIN * (self.reach() + other.reach());
        let (start, end) = (
            self.widened(near),
            end.widened(MARGIN * (end.reach() + self.reach())),
        );
        let other = other.widened(near);
        let (mut low, mut high) = (0.0_f64, 1.0_f64);
        let mut limit = |at_start: f64, at_end: f64| {
            // at_start + τ·(at_end − at_start) ≤ 0
            let root = at_start / (at_start - at_end);
            match (at_start > 0.0, at_end > 0.0) {
                (true, true) => high = -1.0,
                (true, false) => low = low.max(root),
                (false, true) => high = high.min(root),
                (false, false) => {}
            }
        };
        for axis in 0..3 {
            limit(
                start.min[axis] - other.max[axis],
                end.min[axis] - other.max[axis],
            );
            limit(
                other.min[axis] - start.max[axis],
                other.min[axis] - end.max[axis],
            );
        }
        low <= high + SLACK
    }
}

/// A plane with a point and its unit normal.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct OrientedPlane {
    pub(crate) point: Vec3,
    pub(crate) normal: Vec3,
}

/// The visible sides of a surface.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct VisibleSides {
    /// The side of the normal: the outside of a closed shape.
    pub(crate) front: bool,
    /// The other side.
    pub(crate) back: bool,
}

impl VisibleSides {
    pub(crate) const BOTH: Self = Self {
        front: true,
        back: true,
    };
    pub(crate) const FRONT: Self = Self {
        front: true,
        back: false,
    };
    pub(crate) const BACK: Self = Self {
        front: false,
        back: true,
    };

    pub(crate) fn opposite(self) -> Self {
        Self {
            front: self.back,
            back: self.front,
        }
    }

    pub(crate) fn with(self, other: Self) -> Self {
        Self {
            front: self.front || other.front,
            back: self.back || other.back,
        }
    }
}

impl OrientedPlane {
    /// The side of the plane on which a box lies; both if that is uncertain.
    pub(crate) fn sides(&self, aabb: &Bounds) -> VisibleSides {
        let margin = 4.0 * MARGIN * (aabb.reach() + self.point.abs().max_element());
        let heights = aabb
            .corners()
            .map(|corner| (corner - self.point).dot(self.normal));
        let low = heights.iter().copied().fold(f64::INFINITY, f64::min);
        let high = heights.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        if low > margin {
            VisibleSides::FRONT
        } else if high < -margin {
            VisibleSides::BACK
        } else {
            VisibleSides::BOTH
        }
    }
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;

    /// Asserts that a statement holds with the margin but not with a slightly smaller one.
    pub(crate) fn has_margin(margin: f64, is_certain: impl Fn(f64) -> bool) {
        assert!(
            !is_certain((1.0 - 1e-5) * margin),
            "the margin is smaller than {margin:e}"
        );
        assert!(
            is_certain((1.0 + 1e-5) * margin),
            "the margin is larger than {margin:e}"
        );
    }

    /// A box with these corners.
    pub(crate) fn span(min: [f64; 3], max: [f64; 3]) -> Bounds {
        Bounds {
            min: Vec3::from_array(min),
            max: Vec3::from_array(max),
        }
    }

    fn unit(x: f64, y: f64, z: f64) -> Bounds {
        Bounds::about(Vec3::new(x, y, z), Vec3::splat(0.5))
    }

    #[test]
    fn boxes_that_touch_are_not_disjoint() {
        assert!(unit(0.0, 0.0, 0.0).is_disjoint_from(&unit(1.1, 0.0, 0.0)));
        assert!(!unit(0.0, 0.0, 0.0).is_disjoint_from(&unit(1.0, 0.0, 0.0)));
        assert!(!unit(0.0, 0.0, 0.0).is_disjoint_from(&unit(0.0, 1.0 + 1e-12, 0.0)));
    }

    #[test]
    fn a_box_between_start_and_end_may_be_hit_and_one_beside_may_not() {
        let (from, light) = (
            unit(0.0, 0.0, 0.0),
            Bounds::about(Vec3::new(10.0, 0.0, 0.0), Vec3::ZERO),
        );
        assert!(from.segment_may_hit(&light, &unit(5.0, 0.0, 0.0)));
        assert!(
            !from.segment_may_hit(&light, &unit(11.0, 0.0, 0.0)),
            "behind the light"
        );
        assert!(
            !from.segment_may_hit(&light, &unit(-1.5, 0.0, 0.0)),
            "behind the surface"
        );
        assert!(
            from.segment_may_hit(&light, &unit(2.0, 0.8, 0.0)),
            "the way is still broad here"
        );
        assert!(
            !from.segment_may_hit(&light, &unit(8.0, 0.8, 0.0)),
            "the way has narrowed"
        );
        let soft = Bounds::about(Vec3::new(10.0, 0.0, 0.0), Vec3::splat(0.5));
        assert!(
            from.segment_may_hit(&soft, &unit(8.0, 0.8, 0.0)),
            "a soft light is broad"
        );
    }

    #[test]
    fn a_box_across_a_plane_is_on_both_sides() {
        let plane = OrientedPlane {
            point: Vec3::ZERO,
            normal: Vec3::Y,
        };
        assert_eq!(plane.sides(&unit(0.0, 3.0, 0.0)), VisibleSides::FRONT);
        assert_eq!(plane.sides(&unit(0.0, -3.0, 0.0)), VisibleSides::BACK);
        assert_eq!(plane.sides(&unit(0.0, 0.5, 0.0)), VisibleSides::BOTH);
    }

    /// The boxes of a test with permuted and reflected axes.
    fn permuted(boxes: [Bounds; 3], axis: usize, mirror: bool) -> [Bounds; 3] {
        let permute = |v: Vec3| {
            [
                Vec3::new(v.x, v.y, v.z),
                Vec3::new(v.z, v.x, v.y),
                Vec3::new(v.y, v.z, v.x),
            ][axis]
        };
        boxes.map(|Bounds { min, max }| {
            let [min, max] = if mirror { [-max, -min] } else { [min, max] };
            Bounds {
                min: permute(min),
                max: permute(max),
            }
        })
    }

    /// Asserts that three boxes are disjoint from a certain gap on, in any arrangement.
    fn have_margin(
        margin: f64,
        boxes: impl Fn(f64) -> [Bounds; 3],
        are_disjoint: impl Fn([Bounds; 3]) -> bool,
    ) {
        for (axis, mirror) in (0..3).flat_map(|axis| [(axis, false), (axis, true)]) {
            has_margin(margin, |gap| {
                are_disjoint(permuted(boxes(gap), axis, mirror))
            });
        }
    }

    #[test]
    fn boxes_are_disjoint_by_a_margin_of_both() {
        let small = span([2.0, -1.0, -1.0], [3.0, 1.0, 1.0]);
        let boxes = |gap| [small, small, span([3.0 + gap, -2.0, -2.0], [8.0, 2.0, 2.0])];
        have_margin(11.0 * MARGIN, boxes, |[small, _, large]| {
            small.is_disjoint_from(&large)
        });
        let [_, _, large] = boxes(11.0 * MARGIN);
        assert!(!small.is_disjoint_from(&large), "in doubt they are not");
    }

    #[test]
    fn a_box_beside_either_end_is_missed_by_a_margin_of_both() {
        let (near, far) = (
            span([-3.0, -1.0, -3.0], [3.0, 1.0, 3.0]),
            span([0.0, -10.0, 0.0], [0.0, -10.0, 0.0]),
        );
        let boxes = |gap| [near, far, span([-7.0, 1.0 + gap, -7.0], [7.0, 2.0, 7.0])];
        let occludes = |[start, end, other]: [Bounds; 3]| start.segment_may_hit(&end, &other);
        // The start has the size 3 and the other 7; twice, as both are expanded.
        have_margin(20.0 * MARGIN, boxes, |boxes| !occludes(boxes));
        // The end and the start have the sizes 3 and 10, the start and the other 10 and 7.
        have_margin(30.0 * MARGIN, boxes, |[start, end, other]| {
            !occludes([end, start, other])
        });
        let [[start, end, _], [_, _, at_start], [_, _, at_end]] =
            [0.0, 20.0 * MARGIN, 30.0 * MARGIN].map(boxes);
        assert!(
            occludes([start, end, at_start]) && occludes([end, start, at_end]),
            "in doubt it does"
        );
    }

    #[test]
    fn a_box_beside_the_middle_of_a_segment_is_missed_by_a_larger_margin() {
        let point = |at: f64| span([at, at, 0.0], [at, at, 0.0]);
        let boxes = |gap| {
            [
                point(0.0),
                point(1.0),
                span([0.5 + gap, -2.0, -1.0], [3.0, 0.5, 1.0]),
            ]
        };
        // The other has the size 3 and takes the margin three times, the end once, the parameter τ
        // once.
        have_margin(11.0 * MARGIN, boxes, |[start, end, other]| {
            !start.segment_may_hit(&end, &other)
        });
    }

    #[test]
    fn a_box_is_off_a_plane_by_a_margin_of_both() {
        let plane = OrientedPlane {
            point: Vec3::new(0.0, 5.0, -3.0),
            normal: Vec3::Z,
        };
        let above = |gap: f64| span([-2.0, -6.0, gap - 3.0], [2.0, 1.0, -1.0]);
        let below = |gap: f64| span([-2.0, -6.0, -5.0], [2.0, 1.0, -3.0 - gap]);
        has_margin(44.0 * MARGIN, |gap| {
            plane.sides(&above(gap)) == VisibleSides::FRONT
        });
        has_margin(44.0 * MARGIN, |gap| {
            plane.sides(&below(gap)) == VisibleSides::BACK
        });
        assert_eq!(
            [above(44.0 * MARGIN), below(44.0 * MARGIN)].map(|aabb| plane.sides(&aabb)),
            [VisibleSides::BOTH; 2],
            "in doubt"
        );
    }
}
