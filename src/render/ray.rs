//! Rays, and interactions of rays with surfaces: alone, or in lanes.

use rtc_math::{Double, U, Vec3, Vector, ldexp, unit_scale};

/// How far from a surface rays start, in units of its rounding error: enough for the error of the
/// point, of the surface's own numbers, and of the sum that moves the point.
pub(crate) const OFFSET: f64 = 8.0;

/// A half-line; `t` counts in lengths of `direction`, which need not be a unit vector.
#[derive(Clone, Copy, Debug)]
pub struct Ray {
    /// The origin.
    pub origin: Vec3,
    /// The direction.
    pub direction: Vec3,
}

impl Ray {
    /// The ray with its direction rescaled so that its square does not overflow, and the factor
    /// from its `t` to the `t` of `self`.
    ///
    /// Lengths from about 2^−64 to 2^64 stay as they are; others are scaled to about 1 by a power
    /// of two, which is exact.
    #[must_use]
    #[inline]
    pub fn rescaled(self) -> (Self, f64) {
        if self.is_scaled() {
            return (self, 1.0);
        }
        match unit_scale(self.direction) {
            Some((direction, exponent)) => (Self { direction, ..self }, ldexp(1.0, -exponent)),
            None => (self, 1.0),
        }
    }

    /// Whether [`Self::rescaled`] leaves it as it is.
    #[must_use]
    #[inline]
    pub(crate) fn is_scaled(&self) -> bool {
        const MOST: f64 = 18_446_744_073_709_551_616.0;
        let size = self.direction.abs().max_element();
        (1.0 / MOST..=MOST).contains(&size)
    }

    /// The unit normal of the hit surface, on the outside. Where the eye is 10¹⁶ times as far away
    /// as the surface is large, it may round to zero: then the surface faces the ray.
    #[must_use]
    pub(crate) fn outward(&self, out: Vec3) -> Vec3 {
        out.normalize_or(-self.direction.normalize())
    }
}

/// A point of a surface, with a bound on how far rounding may have moved it.
#[derive(Clone, Copy, Debug)]
pub struct Interaction {
    /// The point, on the surface to within the rounding error that `offset` covers, along `normal`.
    pub point: Vec3,
    /// The geometric unit normal: outward for closed shapes, else as declared.
    pub normal: Vec3,
    /// Rays start this far from the point along the normal.
    pub offset: f64,
    /// The way back along the ray that hit, of length 1 or a little less.
    pub back: Vec3,
}

impl Interaction {
    /// The interaction at `point`, where `ray` meets a surface whose own numbers are about
    /// `anchor`, with the extra `extent` that its size adds: the offset is 8 u·(Σ|nᵢ|(|pᵢ| +
    /// |aᵢ|) + extent).
    #[must_use]
    pub fn new(ray: &Ray, point: Vec3, normal: Vec3, anchor: Vec3, extent: f64) -> Self {
        let [point, normal] = [point, normal].map(|v| Vector::constant(0.0, v));
        Interactions::new(&Rays::one(ray), point, normal, anchor, extent).lane(0)
    }

    /// A start for rays along `direction`, on the side of the surface the direction points to.
    ///
    /// On the side that the ray came from, the start also moves back along that ray, where nothing
    /// is hit: so a ray from the very edge of two mirrors starts on the inner side of both.
    #[must_use]
    pub fn start(&self, direction: Vec3) -> Vec3 {
        let [point, normal, back] =
            [self.point, self.normal, self.back].map(|v| Vector::constant(0.0, v));
        let offset = self.offset;
        let all = Interactions {
            point,
            normal,
            offset,
            back,
        };
        all.start(Vector::constant(0.0, direction)).lane(0)
    }

    /// The ray from this point along `direction`.
    #[must_use]
    pub fn ray(&self, direction: Vec3) -> Ray {
        Ray {
            origin: self.start(direction),
            direction,
        }
    }
}

/// A ray, or a ray in each lane.
#[derive(Clone, Copy)]
pub(crate) struct Rays<N> {
    pub(crate) origin: Vector<N>,
    pub(crate) direction: Vector<N>,
}

impl Rays<f64> {
    /// One ray.
    #[inline(always)]
    pub(crate) fn one(ray: &Ray) -> Self {
        Self {
            origin: Vector::constant(0.0, ray.origin),
            direction: Vector::constant(0.0, ray.direction),
        }
    }
}

impl<N: Double> Rays<N> {
    /// The ray of a lane.
    #[inline(always)]
    pub(crate) fn lane(&self, lane: usize) -> Ray {
        Ray {
            origin: self.origin.lane(lane),
            direction: self.direction.lane(lane),
        }
    }
}

/// An [`Interaction`], or one in each lane.
#[derive(Clone, Copy)]
pub(crate) struct Interactions<N> {
    pub(crate) point: Vector<N>,
    pub(crate) normal: Vector<N>,
    pub(crate) offset: N,
    pub(crate) back: Vector<N>,
}

impl<N: Double> Interactions<N> {
    /// See [`Interaction::new`].
    #[inline(always)]
    pub(crate) fn new(
        rays: &Rays<N>,
        point: Vector<N>,
        normal: Vector<N>,
        anchor: Vec3,
        extent: f64,
    ) -> Self {
        let number = |x: f64| point.x.constant(x);
        let sizes = point.abs() + Vector::constant(point.x, anchor.abs());
        let size = normal.abs().dot(sizes) + number(extent);
        Self {
            point,
            normal,
            offset: number(OFFSET * U) * size,
            back: -rays.direction / rays.direction.abs().sum(),
        }
    }

    /// The interaction of a lane.
    #[inline(always)]
    pub(crate) fn lane(&self, lane: usize) -> Interaction {
        Interaction {
            point: self.point.lane(lane),
            normal: self.normal.lane(lane),
            offset: self.offset.lane(lane),
            back: self.back.lane(lane),
        }
    }

    /// Selects `self` in the lanes of a mask, and `other` elsewhere.
    #[inline(always)]
    pub(crate) fn select(self, mask: N::Mask, other: Self) -> Self {
        Self {
            point: self.point.select(mask, other.point),
            normal: self.normal.select(mask, other.normal),
            offset: N::select(mask, self.offset, other.offset),
            back: self.back.select(mask, other.back),
        }
    }

    /// See [`Interaction::start`].
    #[inline(always)]
    pub(crate) fn start(&self, direction: Vector<N>) -> Vector<N> {
        let zero = self.offset.constant(0.0);
        let is_below = direction.dot(self.normal).less(zero);
        let side = N::select(is_below, -self.offset, self.offset);
        let returns = !(self.back.dot(self.normal).less(zero) ^ side.less(zero));
        let step = self.normal * side;
        self.point + (step + self.back * self.offset).select(returns, step)
    }
}
