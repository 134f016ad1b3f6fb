//! Splits a list of boxes into two or eight with the surface area heuristic over bins (Wald, "On
//! fast construction of SAH-based bounding volume hierarchies", 2007).

use super::{BvhBuilders, HEURISTIC_DEPTH};
use crate::accel::lanes::{TRIANGLES, TriangleRow, WIDTH};
use arrayvec::ArrayVec;
use rayon::prelude::*;
use rtc_math::{Lanes, Vec3};
use std::collections::BTreeSet;

/// The most bins of an axis.
const BINS: usize = 16;

/// The number of items that one thread bins at a time.
const CHUNK: usize = 1 << 14;

/// The bins of an axis for this many items: few items need few.
#[inline(always)]
fn bins_of(count: usize) -> usize {
    (4 + count / 4).min(BINS)
}

/// The box of a triangle in the cube, and its number: in the row that the triangle has later, so
/// that building needs no memory of its own.
pub(super) trait BoxedItem {
    /// Of a number and the lowest and the highest corner of its box.
    fn of_box(number: u32, ends: [[f32; 3]; 2]) -> Self;

    /// Its number.
    fn number(&self) -> u32;

    /// The lowest corner of its box; the fourth lane is unused.
    fn low(&self) -> Lanes;

    /// The highest one.
    fn high(&self) -> Lanes;

    /// Twice its centre.
    #[inline(always)]
    fn center(&self) -> Lanes {
        self.low() + self.high()
    }
}

impl BoxedItem for TriangleRow {
    fn of_box(number: u32, [[a, b, c], [d, e, f]]: [[f32; 3]; 2]) -> Self {
        [a, b, c, f32::from_bits(number), d, e, f, 0.0, 0.0, 0.0]
    }

    #[inline(always)]
    fn number(&self) -> u32 {
        self[3].to_bits()
    }

    #[inline(always)]
    fn low(&self) -> Lanes {
        Lanes::from_slice(&self[..4])
    }

    #[inline(always)]
    fn high(&self) -> Lanes {
        Lanes::from_slice(&self[4..8])
    }
}

/// A box, with unused fourth lanes.
#[derive(Clone, Copy)]
struct LaneBox {
    min: Lanes,
    max: Lanes,
}

impl LaneBox {
    const EMPTY: Self = Self {
        min: Lanes::INFINITY,
        max: Lanes::NEG_INFINITY,
    };

    #[inline(always)]
    fn add(&mut self, min: Lanes, max: Lanes) {
        self.min = self.min.min(min);
        self.max = self.max.max(max);
    }

    #[inline(always)]
    fn half_area(&self) -> f32 {
        let size = (self.max - self.min).max(Lanes::ZERO);
        size.x * size.y + size.y * size.z + size.z * size.x
    }
}

/// Some items side by side from a row on, the box around them, and that around twice their centres.
pub(super) struct BuildRange<'items> {
    pub(super) first: usize,
    pub(super) items: &'items mut [TriangleRow],
    bounds: LaneBox,
    centers: LaneBox,
    /// All of them have distinct corners.
    is_sifted: bool,
}

/// A border between two bins of an axis.
#[derive(Clone, Copy)]
struct SplitPlane {
    work: f32,
    axis: usize,
    bin: usize,
    /// The boxes below and above it.
    sides: [LaneBox; 2],
}

/// The bins of all axes: the box and the count of each.
type Bins = ArrayVec<[(LaneBox, u32); 3], BINS>;

impl<'items> BuildRange<'items> {
    /// A range of items, the first of which is in this row.
    pub(super) fn of(first: usize, items: &'items mut [TriangleRow]) -> Self {
        let (mut bounds, mut centers) = (LaneBox::EMPTY, LaneBox::EMPTY);
        for item in items.iter() {
            bounds.add(item.low(), item.high());
            centers.add(item.center(), item.center());
        }
        Self {
            first,
            items,
            bounds,
            centers,
            is_sifted: false,
        }
    }

    /// Whether it is large, with all boxes at one position, and some of its triangles may be the
    /// same.
    pub(super) fn may_hold_copies(&self) -> bool {
        let is_point = |axis: usize| self.centers.min[axis] == self.centers.max[axis];
        !self.is_sifted && self.items.len() > TRIANGLES && (0..3).all(is_point)
    }

    /// Removes each triangle that has the corners of one with a lower number: a ray through both
    /// hits that one. The rows of the removed triangles stay unused.
    pub(super) fn without_copies(self, corners: impl Fn(u32) -> [Vec3; 3]) -> Self {
        self.items.sort_unstable_by_key(BoxedItem::number);
        let mut known = BTreeSet::new();
        let mut kept = 0;
        for at in 0..self.items.len() {
            let corners = corners(self.items[at].number());
            // Zeros of both signs are equal.
            let bits = corners.map(|corner| (corner + Vec3::ZERO).to_array().map(f64::to_bits));
            if known.insert(bits) {
                self.items.swap(kept, at);
                kept += 1;
            }
        }
        Self {
            is_sifted: true,
            ..Self::of(self.first, &mut self.items[..kept])
        }
    }

    /// The lower and the upper end of its box along an axis.
    pub(super) fn ends(&self, axis: usize) -> [f32; 2] {
        [self.bounds.min[axis], self.bounds.max[axis]]
    }

    /// Its parts, at most eight: the one with the largest area, which is hit most often, is split
    /// next, or, deep down, the one with the most items.
    pub(super) fn into_children(
        self,
        builders: BvhBuilders,
        depth: usize,
    ) -> ArrayVec<Self, WIDTH> {
        let is_deep = depth >= HEURISTIC_DEPTH;
        let weight = |part: &Self| match part.items.len() {
            0..=TRIANGLES => 0.0,
            _ if part.may_hold_copies() => 0.0,
            count if is_deep => count as f32,
            _ => part.bounds.half_area().max(f32::MIN_POSITIVE),
        };
        let mut parts = ArrayVec::from_iter([self]);
        while !parts.is_full() {
            let heaviest = (0..parts.len())
                .map(|part| (weight(&parts[part]), part))
                .fold(
                    (0.0, 0),
                    |best, next| if next.0 > best.0 { next } else { best },
                );
            if heaviest.0 == 0.0 {
                break;
            }
            let halves = parts.swap_remove(heaviest.1).split(builders, !is_deep);
            parts.extend(halves);
        }
        parts
    }

    /// Two parts of it, neither empty; it has two items at least.
    fn split(self, builders: BvhBuilders, by_heuristic: bool) -> [Self; 2] {
        let size = self.centers.max - self.centers.min;
        let count = bins_of(self.items.len());
        let scale = Lanes::splat(count as f32 * 0.9999) / size.max(Lanes::splat(1e-30));
        let bins = |item: &TriangleRow| (item.center() - self.centers.min) * scale;
        let split_plane = if by_heuristic {
            best_split(&self.fill(builders, count, &bins), size)
        } else {
            None
        };
        match split_plane {
            Some(split_plane) => self.partitioned(&split_plane, scale),
            None => self.median_split(size),
        }
    }

    /// Sorts the items into `count` bins.
    fn fill(
        &self,
        builders: BvhBuilders,
        count: usize,
        place: &(impl Fn(&TriangleRow) -> Lanes + Sync),
    ) -> Bins {
        if builders == BvhBuilders::One || self.items.len() <= 2 * CHUNK {
            return binned(self.items, count, place);
        }
        self.items
            .par_chunks(CHUNK)
            .map(|items| binned(items, count, place))
            .reduce(|| empty_bins(count), merged)
    }

    /// The items below a border, and those above.
    fn partitioned(self, split_plane: &SplitPlane, scale: Lanes) -> [Self; 2] {
        let (axis, origin) = (split_plane.axis, self.centers.min[split_plane.axis]);
        let is_below = |item: &TriangleRow| {
            bin((item.center()[axis] - origin) * scale[axis]) < split_plane.bin
        };
        let mut centers = [LaneBox::EMPTY; 2];
        let (mut next, mut end) = (0, self.items.len());
        while next < end {
            let item = self.items[next];
            let below = is_below(&item);
            centers[usize::from(!below)].add(item.center(), item.center());
            if below {
                next += 1;
            } else {
                end -= 1;
                self.items.swap(next, end);
            }
        }
        let (below, above) = self.items.split_at_mut(next);
        let part = |items, side: usize| Self {
            first: self.first + side * next,
            items,
            bounds: split_plane.sides[side],
            centers: centers[side],
            is_sifted: self.is_sifted,
        };
        [part(below, 0), part(above, 1)]
    }

    /// Two halves along the widest axis.
    fn median_split(self, size: Lanes) -> [Self; 2] {
        let widest = (0..3).max_by(|a, b| size[*a].total_cmp(&size[*b]));
        let axis = widest.unwrap_or(0);
        let middle = self.items.len() / 2;
        self.items.select_nth_unstable_by(middle, |a, b| {
            let order = a.center()[axis].total_cmp(&b.center()[axis]);
            order.then(a.number().cmp(&b.number()))
        });
        let (first, second) = self.items.split_at_mut(middle);
        let (second, is_sifted) = (Self::of(self.first + middle, second), self.is_sifted);
        [Self::of(self.first, first), second].map(|half| Self { is_sifted, ..half })
    }
}

/// Empty bins.
#[inline(always)]
fn empty_bins(count: usize) -> Bins {
    let mut bins = Bins::new();
    for _ in 0..count {
        bins.push([(LaneBox::EMPTY, 0); 3]);
    }
    bins
}

/// The bins of some items.
#[inline(always)]
fn binned(items: &[TriangleRow], count: usize, place: &impl Fn(&TriangleRow) -> Lanes) -> Bins {
    let mut bins = empty_bins(count);
    for item in items {
        let places = place(item).to_array();
        for (axis, place) in places.into_iter().take(3).enumerate() {
            let (bounds, count) = &mut bins[bin(place)][axis];
            bounds.add(item.low(), item.high());
            *count += 1;
        }
    }
    bins
}

/// The bins of the items of both.
fn merged(mut bins: Bins, others: Bins) -> Bins {
    for ((bounds, count), (other, more)) in bins.iter_mut().flatten().zip(others.iter().flatten()) {
        bounds.add(other.min, other.max);
        *count += more;
    }
    bins
}

/// The bin of a position.
#[inline(always)]
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "places are from 0 on and below 16"
)]
fn bin(place: f32) -> usize {
    place as i32 as usize & (BINS - 1)
}

/// The border with the least expected work on both sides, if any has items on both. So many
/// triangles are tested at once as a leaf has.
fn best_split(bins: &Bins, size: Lanes) -> Option<SplitPlane> {
    let mut best: Option<SplitPlane> = None;
    let mut above = [(f32::INFINITY, LaneBox::EMPTY); BINS];
    for axis in (0..3).filter(|axis| size[*axis] > 0.0) {
        let mut side = (LaneBox::EMPTY, 0);
        for bin in (1..bins.len()).rev() {
            above[bin] = (add_work(&mut side, &bins[bin][axis]), side.0);
        }
        let mut side = (LaneBox::EMPTY, 0);
        for bin in 1..bins.len() {
            let work = add_work(&mut side, &bins[bin - 1][axis]) + above[bin].0;
            if work < best.as_ref().map_or(f32::INFINITY, |best| best.work) {
                let sides = [side.0, above[bin].1];
                best = Some(SplitPlane {
                    work,
                    axis,
                    bin,
                    sides,
                });
            }
        }
    }
    best
}

/// Adds a bin to one side, and returns its SAH cost; infinite while it is empty.
fn add_work(side: &mut (LaneBox, u32), (bounds, count): &(LaneBox, u32)) -> f32 {
    side.0.add(bounds.min, bounds.max);
    side.1 += count;
    match side.1 {
        0 => f32::INFINITY,
        count => side.0.half_area() * count.div_ceil(TRIANGLES as u32) as f32,
    }
}
