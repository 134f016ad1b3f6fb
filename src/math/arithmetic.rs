//! The numbers that a formula is written over once: f32, f64, four f64 in lanes, double-double, and
//! enclosures of real numbers.

use super::DoubleDouble;
use fearless_simd::prelude::*;
use fearless_simd::{Simd, f64x4, mask64x4};
use std::ops::{Add, BitAnd, BitOr, BitXor, Div, Mul, Neg, Not, Sub};

/// A number, a number in each lane, or a set of real numbers. Conditions are masks, so each lane
/// does the operations of one number in their order.
pub trait Number:
    Copy
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
{
    /// Where a condition holds.
    type Mask: Copy
        + BitAnd<Output = Self::Mask>
        + BitOr<Output = Self::Mask>
        + BitXor<Output = Self::Mask>
        + Not<Output = Self::Mask>;

    /// A constant, in as many lanes as `self` has.
    #[must_use]
    fn constant(self, x: f64) -> Self;

    /// The square root.
    #[must_use]
    fn sqrt(self) -> Self;

    /// The absolute value.
    #[must_use]
    fn abs(self) -> Self;

    /// Where it is below another.
    fn less(self, other: Self) -> Self::Mask;

    /// Where it is not above another.
    fn less_or_equal(self, other: Self) -> Self::Mask;

    /// `yes` where a condition holds, `no` elsewhere.
    #[must_use]
    fn select(mask: Self::Mask, yes: Self, no: Self) -> Self;

    /// The square.
    #[inline(always)]
    #[must_use]
    fn square(self) -> Self {
        self * self
    }

    /// Where it equals another.
    #[inline(always)]
    fn equal(self, other: Self) -> Self::Mask {
        self.less_or_equal(other) & other.less_or_equal(self)
    }

    /// The lesser of two; `other` if one is NaN.
    #[inline(always)]
    #[must_use]
    fn least(self, other: Self) -> Self {
        Self::select(self.less(other), self, other)
    }

    /// The greater of two; `other` if one is NaN.
    #[inline(always)]
    #[must_use]
    fn greatest(self, other: Self) -> Self {
        Self::select(other.less(self), self, other)
    }
}

/// An f64, or one in each of four lanes.
pub trait Double: Number {
    /// The rounding error of a product, where the build knows one instruction for it.
    #[inline(always)]
    fn fused_error(self, _other: Self, _product: Self) -> Option<Self> {
        None
    }

    /// The lanes where a condition holds.
    fn lanes(mask: Self::Mask) -> impl Iterator<Item = usize>;

    /// Whether a condition holds nowhere.
    fn is_nowhere(mask: Self::Mask) -> bool;

    /// The number of a lane.
    #[must_use]
    fn lane(self, lane: usize) -> f64;

    /// Replaces the number of a lane.
    fn put(&mut self, lane: usize, x: f64);
}

impl Number for f32 {
    type Mask = bool;

    #[inline(always)]
    #[expect(
        clippy::cast_possible_truncation,
        reason = "rounding is what the choice of f32 asks for"
    )]
    fn constant(self, x: f64) -> Self {
        x as Self
    }

    #[inline(always)]
    fn sqrt(self) -> Self {
        self.sqrt()
    }

    #[inline(always)]
    fn abs(self) -> Self {
        self.abs()
    }

    #[inline(always)]
    fn less(self, other: Self) -> bool {
        self < other
    }

    #[inline(always)]
    fn less_or_equal(self, other: Self) -> bool {
        self <= other
    }

    #[inline(always)]
    fn select(mask: bool, yes: Self, no: Self) -> Self {
        if mask { yes } else { no }
    }
}

impl Number for f64 {
    type Mask = bool;

    #[inline(always)]
    fn constant(self, x: f64) -> Self {
        x
    }

    #[inline(always)]
    fn sqrt(self) -> Self {
        self.sqrt()
    }

    #[inline(always)]
    fn abs(self) -> Self {
        self.abs()
    }

    #[inline(always)]
    fn less(self, other: Self) -> bool {
        self < other
    }

    #[inline(always)]
    fn less_or_equal(self, other: Self) -> bool {
        self <= other
    }

    #[inline(always)]
    fn select(mask: bool, yes: Self, no: Self) -> Self {
        if mask { yes } else { no }
    }
}

impl Double for f64 {
    #[inline(always)]
    #[expect(
        clippy::disallowed_methods,
        reason = "only where it is one instruction"
    )]
    fn fused_error(self, other: Self, product: Self) -> Option<Self> {
        cfg!(target_feature = "fma").then(|| self.mul_add(other, -product))
    }

    #[inline(always)]
    fn lanes(mask: bool) -> impl Iterator<Item = usize> {
        mask.then_some(0).into_iter()
    }

    #[inline(always)]
    fn is_nowhere(mask: bool) -> bool {
        !mask
    }

    #[inline(always)]
    fn lane(self, _: usize) -> f64 {
        self
    }

    #[inline(always)]
    fn put(&mut self, _: usize, x: f64) {
        *self = x;
    }
}

impl<S: Simd> Number for f64x4<S> {
    type Mask = mask64x4<S>;

    #[inline(always)]
    fn constant(self, x: f64) -> Self {
        Self::splat(self.simd, x)
    }

    #[inline(always)]
    fn sqrt(self) -> Self {
        self.simd.sqrt_f64x4(self)
    }

    #[inline(always)]
    fn abs(self) -> Self {
        self.simd.abs_f64x4(self)
    }

    #[inline(always)]
    fn less(self, other: Self) -> mask64x4<S> {
        self.simd_lt(other)
    }

    #[inline(always)]
    fn less_or_equal(self, other: Self) -> mask64x4<S> {
        self.simd_le(other)
    }

    #[inline(always)]
    fn equal(self, other: Self) -> mask64x4<S> {
        self.simd_eq(other)
    }

    #[inline(always)]
    fn select(mask: mask64x4<S>, yes: Self, no: Self) -> Self {
        mask.select(yes, no)
    }
}

/// Whether the machine of a SIMD level multiplies and adds with a single rounding; known when the
/// program is compiled, as a level is a type.
#[inline(always)]
pub fn fuses<S: Simd>(simd: S) -> bool {
    let level = simd.level();
    #[cfg(target_arch = "x86_64")]
    return level.as_avx2().is_some();
    #[cfg(target_arch = "aarch64")]
    return level.as_neon().is_some();
    #[cfg(not(any(target_arch = "x86_64", target_arch = "aarch64")))]
    {
        let _ = level;
        false
    }
}

impl<S: Simd> Double for f64x4<S> {
    #[inline(always)]
    fn lanes(mask: mask64x4<S>) -> impl Iterator<Item = usize> {
        let bits = mask.to_bitmask();
        (0..4).filter(move |lane| bits >> lane & 1 == 1)
    }

    #[inline(always)]
    fn is_nowhere(mask: mask64x4<S>) -> bool {
        mask.all_false()
    }

    #[inline(always)]
    fn lane(self, lane: usize) -> f64 {
        self[lane]
    }

    #[inline(always)]
    fn put(&mut self, lane: usize, x: f64) {
        self[lane] = x;
    }
}

impl Number for DoubleDouble {
    type Mask = bool;

    fn constant(self, x: f64) -> Self {
        Self::from(x)
    }

    fn sqrt(self) -> Self {
        self.sqrt()
    }

    fn abs(self) -> Self {
        if self.to_f64() < 0.0 { -self } else { self }
    }

    fn less(self, other: Self) -> bool {
        (self - other).to_f64() < 0.0
    }

    fn less_or_equal(self, other: Self) -> bool {
        (self - other).to_f64() <= 0.0
    }

    fn select(mask: bool, yes: Self, no: Self) -> Self {
        if mask { yes } else { no }
    }
}
