//! Axis-aligned boxes. A box that is rounded outward contains the exact box.

use super::{SetStep, U, Vec3};

/// An axis-aligned box.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds {
    /// The lowest corner.
    pub min: Vec3,
    /// The highest corner.
    pub max: Vec3,
}

impl Bounds {
    /// The empty box.
    pub const EMPTY: Self = Self {
        min: Vec3::INFINITY,
        max: Vec3::NEG_INFINITY,
    };

    /// The infinite box.
    pub const EVERYTHING: Self = Self {
        min: Vec3::NEG_INFINITY,
        max: Vec3::INFINITY,
    };

    /// The box of the half-space behind the plane through `center`: bounded only where the normal
    /// leads along an axis.
    #[must_use]
    pub fn of_half_space(center: Vec3, normal: Vec3) -> Self {
        let mut bounds = Self::EVERYTHING;
        for axis in 0..3 {
            if normal.abs().element_sum() != normal[axis].abs() {
                continue;
            }
            if normal[axis] > 0.0 {
                bounds.max[axis] = center[axis].next_up();
            } else {
                bounds.min[axis] = center[axis].next_down();
            }
        }
        bounds
    }

    /// The box of an expression of sets, by the boxes of its operands; `None` if it is unbounded.
    #[must_use]
    pub fn of_set(steps: &[SetStep], operands: impl IntoIterator<Item = Self>) -> Option<Self> {
        let mut operands = operands.into_iter();
        let mut stack = Vec::new();
        for step in steps {
            if *step == SetStep::Operand {
                stack.push(operands.next()?);
                continue;
            }
            let (b, a): (Self, Self) = (stack.pop()?, stack.pop()?);
            stack.push(match step {
                SetStep::Union => a.union(b),
                // The intersection; for disjoint boxes, a box between them.
                SetStep::Intersection => Self {
                    min: a.min.max(b.min).min(a.max.min(b.max)),
                    max: a.max.min(b.max).max(a.min.max(b.min)),
                },
                SetStep::Operand | SetStep::Difference => a,
            });
        }
        let bounds = stack.pop()?;
        (bounds.min.is_finite() && bounds.max.is_finite()).then_some(bounds)
    }

    /// The box of some points.
    #[must_use]
    pub fn of(points: impl IntoIterator<Item = Vec3>) -> Self {
        points.into_iter().fold(Self::EMPTY, |bounds, point| Self {
            min: bounds.min.min(point),
            max: bounds.max.max(point),
        })
    }

    /// The box with a middle and half its size along each axis, rounded to nearest.
    #[must_use]
    pub fn about(center: Vec3, half_size: Vec3) -> Self {
        Self {
            min: center - half_size,
            max: center + half_size,
        }
    }

    /// The box around a sphere, rounded outward.
    #[must_use]
    pub fn around(center: Vec3, radius: f64) -> Self {
        let (low, high) = (center - Vec3::splat(radius), center + Vec3::splat(radius));
        Self {
            min: Vec3::new(low.x.next_down(), low.y.next_down(), low.z.next_down()),
            max: Vec3::new(high.x.next_up(), high.y.next_up(), high.z.next_up()),
        }
    }

    /// The box around a disc with a unit normal, rounded outward.
    #[must_use]
    pub fn around_disc(center: Vec3, normal: Vec3, radius: f64) -> Self {
        let half =
            |n: f64| radius * (1.0 - n * n).max(0.0).sqrt() * (1.0 + 16.0 * U) + radius * 16.0 * U;
        let half_size = Vec3::new(half(normal.x), half(normal.y), half(normal.z));
        Self::around(center - half_size, 0.0).union(Self::around(center + half_size, 0.0))
    }

    /// The box around the image of the unit sphere under the map with these images of the axes,
    /// rounded outward.
    #[must_use]
    pub fn around_ellipsoid(center: Vec3, [x, y, z]: [Vec3; 3]) -> Self {
        let half = |square: f64| square.sqrt() * (1.0 + 16.0 * U);
        let half_size = (x * x + y * y + z * z).map(half);
        Self::around(center - half_size, 0.0).union(Self::around(center + half_size, 0.0))
    }

    /// The box with all points nearer to it than a distance along an axis, rounded outward; the
    /// same box for 0.
    #[must_use]
    pub fn grown(self, by: f64) -> Self {
        if by > 0.0 {
            Self::around(self.min, by).union(Self::around(self.max, by))
        } else {
            self
        }
    }

    /// The box with a margin on all sides, rounded to nearest.
    #[must_use]
    pub fn widened(self, by: f64) -> Self {
        Self {
            min: self.min - Vec3::splat(by),
            max: self.max + Vec3::splat(by),
        }
    }

    /// The union.
    #[must_use]
    pub fn union(self, other: Self) -> Self {
        Self {
            min: self.min.min(other.min),
            max: self.max.max(other.max),
        }
    }

    /// The middle.
    #[must_use]
    pub fn center(self) -> Vec3 {
        self.min * 0.5 + self.max * 0.5
    }

    /// Half the surface area; 0 for the empty box.
    #[must_use]
    pub fn half_area(self) -> f64 {
        let size = (self.max - self.min).max(Vec3::ZERO);
        size.x * size.y + size.y * size.z + size.z * size.x
    }

    /// The size of the largest coordinate.
    #[must_use]
    pub fn reach(&self) -> f64 {
        self.min.abs().max(self.max.abs()).max_element()
    }

    /// The eight corners.
    #[must_use]
    pub fn corners(&self) -> [Vec3; 8] {
        let pick = |bit: usize, axis: usize| {
            if bit == 0 {
                self.min[axis]
            } else {
                self.max[axis]
            }
        };
        std::array::from_fn(|k| Vec3::new(pick(k & 1, 0), pick(k >> 1 & 1, 1), pick(k >> 2, 2)))
    }

    /// The distance from a point to the nearest of the box.
    #[must_use]
    pub fn distance(&self, point: Vec3) -> f64 {
        (self.min - point)
            .max(point - self.max)
            .max(Vec3::ZERO)
            .length()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A box, by its corners.
    fn span(min: [f64; 3], max: [f64; 3]) -> Bounds {
        Bounds {
            min: Vec3::from_array(min),
            max: Vec3::from_array(max),
        }
    }

    #[test]
    fn boxes_grow_on_all_sides_and_know_their_size_and_distances() {
        let space = span([-1.0, 2.0, -4.0], [3.0, 2.5, 0.0]);
        assert_eq!(space.widened(0.5), span([-1.5, 1.5, -4.5], [3.5, 3.0, 0.5]));
        assert_eq!(space.reach(), 4.0);
        assert_eq!(
            [space.corners()[0], space.corners()[7]],
            [space.min, space.max]
        );
        assert_eq!(space.distance(Vec3::new(6.0, 6.5, -1.0)), 5.0);
        assert_eq!(space.distance(Vec3::new(0.0, 2.0, -7.0)), 3.0);
        assert_eq!(space.distance(Vec3::new(0.0, 2.0, -2.0)), 0.0);
    }
}
