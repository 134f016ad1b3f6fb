//! The t-interval of a ray inside a convex region. A capped solid is the intersection of such
//! intervals, so there is no gap between its side and its caps.

use crate::ray::{OFFSET, Ray};
use crate::shape::geometry::SolidCrossing;
use rtc_math::{U, Vec3, dot};

/// The size of the numbers from which the distance of a ray's start is computed from a solid of
/// some extent about an anchor.
pub(crate) fn size_of_start(ray: &Ray, anchor: Vec3, extent: f64) -> f64 {
    (ray.origin.abs() + anchor.abs()).element_sum() + extent
}

/// A distance from a surface, computed from numbers of a size; 0 where it may be rounding alone: a
/// ray that starts no farther from a surface than one that leaves it starts on it.
pub(crate) fn off_surface(distance: f64, size: f64) -> f64 {
    if distance.abs() <= OFFSET * U * size {
        0.0
    } else {
        distance
    }
}

/// The interval of t inside a region, with the part crossed at either end.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Interval<Part> {
    pub(crate) enter: (f64, Part),
    pub(crate) leave: (f64, Part),
}

impl<Part: Copy> Interval<Part> {
    /// The intersection of both; `None` if it is empty. If both end at the same t, `self` wins.
    pub(crate) fn and(self, other: Self) -> Option<Self> {
        let enter = if other.enter.0 > self.enter.0 {
            other.enter
        } else {
            self.enter
        };
        let leave = if other.leave.0 < self.leave.0 {
            other.leave
        } else {
            self.leave
        };
        (enter.0 <= leave.0).then_some(Self { enter, leave })
    }

    /// Both ends through `change`, which must be increasing.
    pub(crate) fn map(self, change: impl Fn(f64) -> f64) -> Self {
        Self {
            enter: (change(self.enter.0), self.enter.1),
            leave: (change(self.leave.0), self.leave.1),
        }
    }

    /// The same for a convex region where a convex function is below 0, by its value and its
    /// derivative at t = 0: where rounding moved a root of 0 to the other side they decide, so an
    /// origin on the surface does not hit its own surface. What is behind the origin is at −∞.
    pub(crate) fn seen_from(mut self, value: f64, slope: f64) -> Self {
        let is_behind = value >= 0.0 && slope >= 0.0;
        if value <= 0.0 || is_behind {
            self.enter.0 = f64::NEG_INFINITY;
        }
        if is_behind {
            self.leave.0 = f64::NEG_INFINITY;
        }
        self
    }

    /// Visits both ends, each with the number of its part.
    pub(crate) fn visit(self, number: impl Fn(Part) -> u32, visit: &mut dyn FnMut(SolidCrossing)) {
        let [enter, leave] = [self.enter, self.leave].map(|(t, part)| (t, number(part)));
        SolidCrossing::visit_both(enter, leave, visit);
    }

    /// The first end with t > 0.
    pub(crate) fn first_in_front(self) -> Option<(f64, Part)> {
        [self.enter, self.leave]
            .into_iter()
            .find(|(t, _)| *t > 0.0 && t.is_finite())
    }
}

/// The stretch of the ray from `f` along `d` between the planes through 0 and `height` on the axis,
/// which is a unit vector, with the part at either plane. The size is that of
/// [`size_of_start`].
pub(crate) fn between_planes<Part>(
    axis: Vec3,
    height: f64,
    f: Vec3,
    d: Vec3,
    size: f64,
    [base, top]: [Part; 2],
) -> Option<Interval<Part>> {
    let (above, rise) = (dot(axis, f), dot(axis, d));
    let (above, below) = (off_surface(above, size), off_surface(height - above, size));
    if rise == 0.0 {
        let everywhere = Interval {
            enter: (f64::NEG_INFINITY, base),
            leave: (f64::INFINITY, top),
        };
        return (above >= 0.0 && below >= 0.0).then_some(everywhere);
    }
    let (base, top) = ((-above / rise, base), (below / rise, top));
    Some(if rise > 0.0 {
        Interval {
            enter: base,
            leave: top,
        }
    } else {
        Interval {
            enter: top,
            leave: base,
        }
    })
}

/// The roots of `a·t² − 2·b·t + c`, in order, from `discriminant = b² − a·c > 0` computed with
/// care: neither cancels.
pub(crate) fn roots(a: f64, b: f64, c: f64, discriminant: f64) -> (f64, f64) {
    let root = discriminant.max(0.0).sqrt();
    let q = if b >= 0.0 { b + root } else { b - root };
    let (first, second) = if q == 0.0 { (0.0, 0.0) } else { (c / q, q / a) };
    if first <= second {
        (first, second)
    } else {
        (second, first)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn intervals_meet_or_do_not() {
        let interval = |enter, leave, part| Interval {
            enter: (enter, part),
            leave: (leave, part),
        };
        let (a, b) = (interval(1.0, 4.0, 'a'), interval(2.0, 9.0, 'b'));
        assert_eq!(
            a.and(b),
            Some(Interval {
                enter: (2.0, 'b'),
                leave: (4.0, 'a')
            })
        );
        assert_eq!(a.and(interval(5.0, 6.0, 'c')), None);
        assert_eq!(interval(-3.0, 2.0, 'd').first_in_front(), Some((2.0, 'd')));
        assert_eq!(interval(-3.0, -2.0, 'e').first_in_front(), None);
    }

    #[test]
    fn an_origin_on_the_border_does_not_see_it() {
        let rounded = |enter, leave| Interval {
            enter: (enter, 'a'),
            leave: (leave, 'b'),
        };
        let ends = |interval: Interval<char>| (interval.enter.0, interval.leave.0);
        let outwards = rounded(-2.0, 1e-17).seen_from(0.0, 1.0);
        assert_eq!(outwards.first_in_front(), None);
        let inwards = rounded(1e-17, 2.0).seen_from(0.0, -1.0);
        assert_eq!(inwards.first_in_front(), Some((2.0, 'b')));
        let before = f64::NEG_INFINITY;
        assert_eq!(ends(rounded(-1.0, 1.0).seen_from(-1.0, 1.0)), (before, 1.0));
        assert_eq!(ends(rounded(1.0, 2.0).seen_from(1.0, -1.0)), (1.0, 2.0));
    }

    #[test]
    fn roots_come_in_order_without_cancellation() {
        assert_eq!(roots(1.0, 1e8, 1.0, 1e16 - 1.0).0, 5e-9);
        assert_eq!(roots(1.0, -1.5, 2.0, 0.25), (-2.0, -1.0));
    }
}
