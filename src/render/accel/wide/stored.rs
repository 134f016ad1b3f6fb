//! A BVH as numbers, and back: its topology alone, without boxes.
//!
//! The boxes are computed from the triangles, from the leaves up, so a stored BVH has the same bits
//! as one that was built, and no box can lie. What remains to be checked in linear time is that
//! each triangle is in exactly one leaf and each node below the root, no deeper than the stack of a
//! traversal allows. A topology that passes may be slow; it hides no triangle.

use super::build::{LeafBuilder, frame_around};
use super::{BvhBuilders, LEAF, MAX_DEPTH, MOST, NONE, WideBvh, leaf_rows};
use crate::accel::lanes::{LINKS, ROWS_AFTER, WIDTH, WideNode};
use crate::accel::pages::PagedRows;
use crate::accel::simd::SimdLevel;
use rtc_math::Vec3;

/// The version of the layout.
pub(crate) const VERSION: u32 = 1;

/// The topology of a BVH: the triangles in the order of their rows, and the links of each node,
/// the root first. A link is the number of a node, or that of a leaf, or missing.
#[derive(Clone, Copy, Debug)]
pub(crate) struct BvhTopology<'a> {
    pub(crate) items: &'a [u32],
    pub(crate) links: &'a [[u32; WIDTH]],
}

/// Numbers below a count, each of which may be taken once.
struct Unused(Vec<u64>);

impl Unused {
    fn below(count: usize) -> Self {
        Self(vec![0; count.div_ceil(64)])
    }

    /// Takes a number below the count; false if it was taken before.
    #[inline(always)]
    fn take(&mut self, number: usize) -> bool {
        let (word, bit) = (&mut self.0[number / 64], 1 << (number % 64));
        let is_unused = *word & bit == 0;
        *word |= bit;
        is_unused
    }
}

impl BvhTopology<'_> {
    /// Whether it is a BVH over triangles 0 to `count` that a traversal can walk: each row and each
    /// triangle in exactly one leaf, each node except the first below exactly one other, at a depth
    /// that is allowed.
    fn is_sound(&self, count: usize) -> bool {
        let nodes = self.links.len();
        let is_countable = nodes < LEAF as usize && nodes > 0 && self.items.len() == count;
        is_countable && self.has_each_item_once(count) && self.is_tree(count)
    }

    fn has_each_item_once(&self, count: usize) -> bool {
        let mut unused = Unused::below(count);
        let mut items = self.items.iter().map(|item| *item as usize);
        items.all(|item| item < count && unused.take(item))
    }

    /// Whether links lead from each node to nodes after it and to leaves, to each once.
    fn is_tree(&self, count: usize) -> bool {
        let mut rows = Unused::below(count);
        let mut rows_left = count;
        // The depth of each node that a link leads to; 0 before.
        let mut depths = vec![0_u8; self.links.len()];
        depths[0] = 1;
        for (node, links) in self.links.iter().enumerate() {
            let depth = depths[node];
            if depth == 0 || usize::from(depth) > MAX_DEPTH {
                return false;
            }
            for link in links.iter().filter(|link| **link != NONE) {
                let is_new = if link & LEAF == 0 {
                    let child = *link as usize;
                    let is_new = child > node && depths.get(child) == Some(&0);
                    if is_new {
                        depths[child] = depth + 1;
                    }
                    is_new
                } else {
                    let (first, items) = leaf_rows(*link);
                    rows_left = rows_left.saturating_sub(items);
                    first + items <= count && (first..first + items).all(|row| rows.take(row))
                };
                if !is_new {
                    return false;
                }
            }
        }
        rows_left == 0
    }
}

impl WideBvh {
    /// The items and the links of a BVH over `count` triangles; `None` if it is a single leaf, or
    /// if copies of triangles were left out.
    pub(crate) fn topology(&self, count: usize) -> Option<(Vec<u32>, Vec<[u32; WIDTH]>)> {
        let links = |node: &WideNode| std::array::from_fn(|lane| node[LINKS + lane].to_bits());
        let links: Vec<[u32; WIDTH]> = self.nodes.rows().iter().map(links).collect();
        let mut items = vec![u32::MAX; count];
        let leaves = links.iter().flatten().filter(|link| **link & LEAF != 0);
        for link in leaves.filter(|link| **link != NONE) {
            let leaf = super::leaf_at(self.triangles.rows(), *link);
            let (first, _) = leaf_rows(*link);
            (0..leaf.count()).for_each(|lane| items[first + lane] = leaf.item(lane));
        }
        let topology = BvhTopology {
            items: &items,
            links: &links,
        };
        topology.is_sound(count).then_some((items, links))
    }

    /// The BVH of this topology over `count` triangles, as [`WideBvh::build`] makes it; `None` if
    /// the topology is not that of a BVH over them.
    pub(crate) fn of_topology(
        topology: BvhTopology<'_>,
        simd: SimdLevel,
        count: usize,
        error_bound: f64,
        corners: impl Fn(u32) -> [Vec3; 3] + Sync,
    ) -> Option<Self> {
        if count > MOST || !topology.is_sound(count) {
            return None;
        }
        let frame = frame_around(BvhBuilders::All, count as u32, error_bound, &corners);
        let leaves = LeafBuilder {
            builders: BvhBuilders::All,
            frame,
            error_bound,
            corners,
        };
        let mut triangles = PagedRows::zeroed(count + ROWS_AFTER);
        let mut nodes = PagedRows::zeroed(topology.links.len());
        let (rows, boxes) = (triangles.rows_mut(), nodes.rows_mut());
        let mut is_exact = true;
        // Children come after their node, so their boxes are there.
        for (node, links) in topology.links.iter().enumerate().rev() {
            let (before, after) = boxes.split_at_mut(node + 1);
            let own = &mut before[node];
            for (lane, link) in links.iter().enumerate() {
                let [low, high] = match *link {
                    NONE => [[f32::INFINITY; 3], [f32::NEG_INFINITY; 3]],
                    link if link & LEAF == 0 => bounds_of(&after[link as usize - node - 1]),
                    link => {
                        let (first, count) = leaf_rows(link);
                        let items = &topology.items[first..first + count];
                        let (bounds, exact) =
                            leaves.fill_from(&mut rows[first..first + count], items);
                        is_exact &= exact;
                        bounds
                    }
                };
                for axis in 0..3 {
                    own[2 * WIDTH * axis + lane] = low[axis];
                    own[2 * WIDTH * axis + WIDTH + lane] = high[axis];
                }
                own[LINKS + lane] = f32::from_bits(*link);
            }
        }
        Some(Self {
            simd,
            frame,
            nodes,
            triangles,
            root: 0,
            unit: frame.unit().filter(|_| is_exact),
        })
    }
}

/// The box around the children of a node.
fn bounds_of(node: &WideNode) -> [[f32; 3]; 2] {
    let ends = |at: usize| &node[at..at + WIDTH];
    let low = |axis: usize| {
        let ends = ends(2 * WIDTH * axis).iter().copied();
        ends.fold(f32::INFINITY, f32::min)
    };
    let high = |axis: usize| {
        let ends = ends(2 * WIDTH * axis + WIDTH).iter().copied();
        ends.fold(f32::NEG_INFINITY, f32::max)
    };
    [[low(0), low(1), low(2)], [high(0), high(1), high(2)]]
}
