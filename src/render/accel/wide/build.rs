//! Construction of the wide BVH, top down: a node splits its ranges until it has eight children
//! (Dammertz, Hanika, Keller, "Shallow bounding volume hierarchies", 2008).
//!
//! The upper levels are built first, then the subtrees, on all threads if that is allowed. The
//! result does not depend on the number of threads.

use super::split::{BoxedItem, BuildRange};
use super::{LEAF, NONE, WideBvh};
use crate::accel::conservative_ray::QuantizationFrame;
use crate::accel::lanes::{
    ITEM, LINKS, ROWS_AFTER, TRIANGLES, TriangleRow, WIDTH, WideNode, place,
};
use crate::accel::pages::PagedRows;
use crate::accel::simd::SimdLevel;
use arrayvec::ArrayVec;
use rayon::prelude::*;
use rtc_math::{Bounds, Vec3, to_u32};

/// A link to a leaf counts no more triangles, which would take 21 GB.
pub(crate) const MOST: usize = 1 << 29;

/// Ranges of so few triangles are built by one thread.
const ALONE: usize = 4096;

/// The builder of a BVH.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum BvhBuilders {
    /// This thread. It must be so where others wait until the BVH is there: a thread that is helped
    /// may meanwhile be handed work which waits for that too, and would wait for itself.
    One,
    /// All threads of the pool.
    All,
}

impl WideBvh {
    /// Builds the BVH of some triangles, each known by its number, with corners that may be wrong
    /// by `error_bound`; `None` if there is none.
    pub(crate) fn build(
        builders: BvhBuilders,
        simd: SimdLevel,
        count: usize,
        error_bound: f64,
        corners: impl Fn(u32) -> [Vec3; 3] + Sync,
    ) -> Option<Self> {
        assert!(count <= MOST, "a proven scene has no more triangles");
        let count = count as u32;
        if count == 0 {
            return None;
        }
        // Quantize the boxes to f32 in a cube around the geometry, rounded outward.
        let frame = frame_around(builders, count, error_bound, &corners);
        let bounds = |item| Bounds::of(corners(item)).grown(error_bound);
        let item = |item| TriangleRow::of_box(item, frame.rounded_outward(bounds(item)));
        let mut triangles = PagedRows::zeroed(count as usize + ROWS_AFTER);
        let rows = &mut triangles.rows_mut()[..count as usize];
        match builders {
            BvhBuilders::One => rows.iter_mut().zip(0..).for_each(|(row, n)| *row = item(n)),
            BvhBuilders::All => rows
                .par_iter_mut()
                .zip(0..count)
                .for_each(|(row, n)| *row = item(n)),
        }
        // Build the nodes, and merge the branches.
        let leaves = LeafBuilder {
            builders,
            frame,
            error_bound,
            corners,
        };
        let (root, branches) = grow_all(rows, &leaves);
        let is_exact = branches.iter().all(|branch| branch.is_exact);
        let nodes = branches.into_iter().map(|branch| branch.nodes).collect();
        Some(Self {
            simd,
            frame,
            nodes: PagedRows::merged(nodes),
            triangles,
            root,
            unit: frame.unit().filter(|_| is_exact),
        })
    }
}

/// The cube around some triangles with corners that may be wrong by `error_bound`.
pub(super) fn frame_around(
    builders: BvhBuilders,
    count: u32,
    error_bound: f64,
    corners: &(impl Fn(u32) -> [Vec3; 3] + Sync),
) -> QuantizationFrame {
    let bounds = |item| Bounds::of(corners(item));
    let whole = match builders {
        BvhBuilders::One => (0..count).map(bounds).fold(Bounds::EMPTY, Bounds::union),
        BvhBuilders::All => {
            let all = (0..count).into_par_iter().map(bounds);
            all.reduce(|| Bounds::EMPTY, Bounds::union)
        }
    };
    let center = |item| bounds(item).grown(error_bound).center();
    let mean = || {
        let centers = (0..count).map(|item| center(item) / f64::from(count));
        centers.sum::<Vec3>()
    };
    // Rounding keeps order, so this is the box around the boxes of the triangles.
    QuantizationFrame::around(whole.grown(error_bound), mean, error_bound)
}

/// The source of leaves, and their builder.
pub(super) struct LeafBuilder<C> {
    pub(super) builders: BvhBuilders,
    pub(super) frame: QuantizationFrame,
    /// What a coordinate of a corner may be wrong by.
    pub(super) error_bound: f64,
    pub(super) corners: C,
}

impl<C: Fn(u32) -> [Vec3; 3]> LeafBuilder<C> {
    /// Makes some items a leaf in place; returns whether it has their exact corners.
    fn fill(&self, items: &mut [TriangleRow]) -> bool {
        let numbers: ArrayVec<u32, TRIANGLES> = items.iter().map(BoxedItem::number).collect();
        let leaf = items.as_flattened_mut();
        let mut is_exact = true;
        for (lane, number) in numbers.iter().enumerate() {
            let corners = (self.corners)(*number);
            is_exact &= self.put(leaf, (lane, numbers.len()), *number, &corners);
        }
        is_exact
    }

    /// Makes rows a leaf of these triangles; returns the box around it in the cube, and whether it
    /// has their exact corners.
    #[inline(always)]
    pub(super) fn fill_from(
        &self,
        rows: &mut [TriangleRow],
        numbers: &[u32],
    ) -> ([[f32; 3]; 2], bool) {
        let leaf = rows.as_flattened_mut();
        let (mut bounds, mut is_exact) = (Bounds::EMPTY, true);
        for (lane, number) in numbers.iter().enumerate() {
            let corners = (self.corners)(*number);
            bounds = bounds.union(Bounds::of(corners));
            is_exact &= self.put(leaf, (lane, numbers.len()), *number, &corners);
        }
        // Rounding keeps order, so this is the box around the boxes of the triangles.
        let ends = self.frame.rounded_outward(bounds.grown(self.error_bound));
        (ends, is_exact)
    }

    /// Puts a triangle into a lane of a leaf of `count`; returns whether its corners are exact.
    #[inline(always)]
    fn put(
        &self,
        leaf: &mut [f32],
        (lane, count): (usize, usize),
        number: u32,
        corners: &[Vec3; 3],
    ) -> bool {
        let mut is_exact = true;
        leaf[ITEM * count + lane] = f32::from_bits(number);
        for (corner, point) in corners.iter().enumerate() {
            let rounded = self.frame.enter(*point).as_vec3();
            let exact = self.frame.unit().map(|unit| rounded.as_dvec3() * unit);
            is_exact &= exact == Some(*point);
            for (axis, coordinate) in rounded.to_array().into_iter().enumerate() {
                leaf[place(corner, axis) * count + lane] = coordinate;
            }
        }
        is_exact
    }
}

/// Nodes that lead to each other and to leaves.
struct BuildBranch {
    nodes: Vec<WideNode>,
    is_exact: bool,
}

/// A branch that is done.
struct GrownBranch {
    nodes: PagedRows<WideNode>,
    is_exact: bool,
}

/// A range deferred to later, and the address of its link.
struct DeferredRange<'items> {
    part: BuildRange<'items>,
    depth: usize,
    node: usize,
    lane: usize,
}

/// The link to the root, and all branches: links count the nodes of all, in order.
fn grow_all<C: Fn(u32) -> [Vec3; 3] + Sync>(
    items: &mut [TriangleRow],
    leaves: &LeafBuilder<C>,
) -> (u32, Vec<GrownBranch>) {
    let alone = ALONE.max(items.len() / 64);
    // Build the top of the hierarchy, and leave small ranges for later.
    let mut top = BuildBranch::new();
    let mut left = Vec::new();
    let root = top.grow(BuildRange::of(0, items), 0, leaves, &mut |part| {
        let is_small = part.part.items.len() <= alone;
        if is_small {
            left.push(part);
            return None;
        }
        Some(part)
    });
    // Build these ranges, in parallel if requested.
    let grow = |left: DeferredRange<'_>| {
        let mut branch = BuildBranch::new();
        let link = branch.grow(left.part, left.depth, leaves, &mut Some);
        (left.node, left.lane, link, branch.grown())
    };
    let grown: Vec<_> = match leaves.builders {
        BvhBuilders::One => left.into_iter().map(grow).collect(),
        BvhBuilders::All => left.into_par_iter().map(grow).collect(),
    };
    // Append the branches, and renumber the links into them.
    let mut nodes = top.nodes.len();
    let mut branches = Vec::with_capacity(grown.len() + 1);
    for (node, lane, link, mut branch) in grown {
        let moved = |link: u32| match link & LEAF {
            0 => link + to_u32(nodes),
            _ => link,
        };
        top.nodes[node][LINKS + lane] = f32::from_bits(moved(link));
        let rows = branch.nodes.rows_mut();
        for link in rows.iter_mut().flat_map(|node| &mut node[LINKS..][..WIDTH]) {
            *link = f32::from_bits(moved(link.to_bits()));
        }
        nodes += rows.len();
        branches.push(branch);
    }
    branches.insert(0, top.grown());
    (root, branches)
}

impl BuildBranch {
    fn new() -> Self {
        Self {
            nodes: Vec::new(),
            is_exact: true,
        }
    }

    fn grown(self) -> GrownBranch {
        GrownBranch {
            nodes: PagedRows::put_aside(&self.nodes),
            is_exact: self.is_exact,
        }
    }

    /// Adds the node of a range and returns the link to it. `take` may defer the children of a
    /// node.
    fn grow<'items, C: Fn(u32) -> [Vec3; 3]>(
        &mut self,
        part: BuildRange<'items>,
        depth: usize,
        leaves: &LeafBuilder<C>,
        take: &mut impl FnMut(DeferredRange<'items>) -> Option<DeferredRange<'items>>,
    ) -> u32 {
        let part = match part.may_hold_copies() {
            true => part.without_copies(&leaves.corners),
            false => part,
        };
        if part.items.len() <= TRIANGLES {
            self.is_exact &= leaves.fill(part.items);
            return LEAF | to_u32(part.first) << 2 | to_u32(part.items.len() - 1);
        }
        let children = part.into_children(leaves.builders, depth);
        let here = self.nodes.len();
        self.nodes.push(node(&children));
        for (lane, part) in children.into_iter().enumerate() {
            let left = DeferredRange {
                part,
                depth: depth + 1,
                node: here,
                lane,
            };
            if let Some(DeferredRange { part, depth, .. }) = take(left) {
                let link = self.grow(part, depth, leaves, take);
                self.nodes[here][LINKS + lane] = f32::from_bits(link);
            }
        }
        to_u32(here)
    }
}

/// The node of some children, without their links; no ray hits the boxes of missing ones.
fn node(children: &[BuildRange<'_>]) -> WideNode {
    let mut node = [0.0; LINKS + 2 * WIDTH];
    for axis in 0..3 {
        for lane in 0..WIDTH {
            let nothing = [f32::INFINITY, f32::NEG_INFINITY];
            let [low, high] = children.get(lane).map_or(nothing, |part| part.ends(axis));
            node[2 * WIDTH * axis + lane] = low;
            node[2 * WIDTH * axis + WIDTH + lane] = high;
        }
    }
    node[LINKS..][..WIDTH].fill(f32::from_bits(NONE));
    node
}
