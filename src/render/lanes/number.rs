//! The numbers that a formula is written over once: an f64, or one in each of four lanes.
//! Conditions are masks, so each lane does the operations of one number in their order.

use super::lanes_of;
use fearless_simd::prelude::*;
use fearless_simd::{Simd, f64x4, mask64x4};
use std::ops::{Add, BitAnd, BitOr, Div, Mul, Neg, Not, Sub};

/// A number, or a number in each lane.
pub(crate) trait Number:
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
        + Not<Output = Self::Mask>;

    /// A constant, in as many lanes as `self` has.
    fn constant(self, x: f64) -> Self;

    fn sqrt(self) -> Self;

    fn abs(self) -> Self;

    fn less(self, other: Self) -> Self::Mask;

    fn less_or_equal(self, other: Self) -> Self::Mask;

    /// `yes` where a condition holds, `no` elsewhere.
    fn select(mask: Self::Mask, yes: Self, no: Self) -> Self;

    /// The lanes where a condition holds.
    fn lanes(mask: Self::Mask) -> impl Iterator<Item = usize>;

    /// Whether a condition holds nowhere.
    fn is_nowhere(mask: Self::Mask) -> bool;

    fn lane(self, lane: usize) -> f64;

    /// Replaces the number of a lane.
    fn put(&mut self, lane: usize, x: f64);
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
    fn select(mask: mask64x4<S>, yes: Self, no: Self) -> Self {
        mask.select(yes, no)
    }

    #[inline(always)]
    fn lanes(mask: mask64x4<S>) -> impl Iterator<Item = usize> {
        lanes_of(mask.to_bitmask())
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
