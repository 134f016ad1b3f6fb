//! A binary bounding volume hierarchy over boxes. It finds candidates and decides no hits.
//!
//! It is built with the binned surface area heuristic (Wald, "On fast construction of SAH-based
//! bounding volume hierarchies", 2007). A few boxes form a single leaf, which is a linear loop.

use crate::accel::bounds::SlabTest;
use crate::ray::Ray;
use rtc_math::{Bounds, to_u32};

/// Boxes in one leaf at most, where splitting helps.
const LEAF: usize = 4;

/// For so few boxes a linear loop is faster.
const LOOP: usize = 8;

const BINS: usize = 16;

/// Below this depth the heuristic chooses; above it the middle, which needs at most 32 more.
const HEURISTIC_DEPTH: usize = 28;

const MAX_DEPTH: usize = 64;

#[derive(Debug)]
struct BvhNode {
    bounds: Bounds,
    /// The first entry of `order` for a leaf, the second child for an inner node; the first child
    /// follows the node.
    link: u32,
    /// Entries of a leaf; 0 for an inner node.
    count: u32,
    axis: u8,
}

/// The BVH.
#[derive(Debug)]
pub(crate) struct Bvh {
    nodes: Vec<BvhNode>,
    order: Vec<u32>,
}

impl Bvh {
    /// Builds the BVH of the boxes given; an item is known by its index.
    #[must_use]
    pub(crate) fn build(boxes: &[Bounds]) -> Self {
        let items = (0_u32..)
            .zip(boxes)
            .map(|(index, bounds)| BvhItem {
                index,
                bounds: *bounds,
            })
            .collect::<Vec<_>>();
        let mut builder = BvhBuilder {
            items,
            nodes: Vec::new(),
        };
        if !boxes.is_empty() {
            builder.node(0, boxes.len(), 0);
        }
        Self {
            nodes: builder.nodes,
            order: builder.items.into_iter().map(|item| item.index).collect(),
        }
    }

    /// Calls `visit` with the items whose boxes the ray may hit before `t_max`, nearer boxes
    /// roughly first; `visit` returns the new `t_max`, which ends the traversal when it falls below
    /// 0.
    #[inline]
    pub(crate) fn traverse(
        &self,
        ray: &Ray,
        mut t_max: f64,
        mut visit: impl FnMut(u32, f64) -> f64,
    ) {
        let mut visit_leaf = |node: &BvhNode, mut t_max: f64| {
            for item in &self.order[node.link as usize..(node.link + node.count) as usize] {
                t_max = visit(*item, t_max);
            }
            t_max
        };
        // Test the items of a single leaf without the box test.
        match self.nodes.as_slice() {
            [] => return,
            [only] => {
                visit_leaf(only, t_max);
                return;
            }
            _ => {}
        }
        // Traverse the nodes from a stack, the nearer child first.
        let slabs = SlabTest::new(ray);
        let mut open = [0_u32; MAX_DEPTH];
        let mut depth = 1;
        while depth > 0 && t_max >= 0.0 {
            depth -= 1;
            let index = open[depth];
            let node = &self.nodes[index as usize];
            // Skip nodes beyond the current end.
            if !slabs.meet(&node.bounds, t_max) {
                continue;
            }
            // Test the items of a leaf.
            if node.count > 0 {
                t_max = visit_leaf(node, t_max);
                continue;
            }
            // Push both children, the nearer one last.
            let (first, second) = (index + 1, node.link);
            let down = slabs.runs_down(usize::from(node.axis));
            open[depth] = if down { first } else { second };
            open[depth + 1] = if down { second } else { first };
            depth += 2;
        }
    }
}

/// The input of a BVH build.
#[derive(Clone, Copy)]
pub(crate) struct BvhItem {
    pub(crate) index: u32,
    pub(crate) bounds: Bounds,
}

struct BvhBuilder {
    items: Vec<BvhItem>,
    nodes: Vec<BvhNode>,
}

impl BvhBuilder {
    /// Builds the node over `items[start..end]` and its descendants.
    fn node(&mut self, start: usize, end: usize, depth: usize) {
        let items = &mut self.items[start..end];
        let bounds = items
            .iter()
            .fold(Bounds::EMPTY, |bounds, item| bounds.union(item.bounds));
        let here = self.nodes.len();
        let leaf = BvhNode {
            bounds,
            link: to_u32(start),
            count: to_u32(end - start),
            axis: 0,
        };
        self.nodes.push(leaf);
        let leaf_size = if depth == 0 { LOOP } else { LEAF };
        if items.len() <= leaf_size {
            return;
        }
        let (axis, middle) = split(items, 1, depth < HEURISTIC_DEPTH);
        self.node(start, start + middle, depth + 1);
        let second = to_u32(self.nodes.len());
        self.node(start + middle, end, depth + 1);
        let node = &mut self.nodes[here];
        (node.link, node.count, node.axis) = (second, 0, to_axis(axis));
    }
}

/// Partitions the items, at least two, into two non-empty groups and returns the axis and the size
/// of the first: by the heuristic where it is requested and finds a split, else at the median.
/// Leaves test `at_once` items together.
pub(crate) fn split(items: &mut [BvhItem], at_once: u32, by_heuristic: bool) -> (usize, usize) {
    let center = |bounds: Bounds, item: &BvhItem| {
        let center = item.bounds.center();
        Bounds {
            min: bounds.min.min(center),
            max: bounds.max.max(center),
        }
    };
    // Bin the centres of the boxes along each axis.
    let spread = items.iter().fold(Bounds::EMPTY, center);
    let size = spread.max - spread.min;
    let scale = size.recip() * BINS as f64;
    let bin = |item: &BvhItem, axis: usize| {
        let place = (item.bounds.center()[axis] - spread.min[axis]) * scale[axis];
        (place as usize).min(BINS - 1)
    };
    // Choose the split of least SAH cost.
    if by_heuristic {
        let wide = (0..3).filter(|axis| size[*axis] > 0.0 && scale[*axis].is_finite());
        let borders = wide.filter_map(|axis| {
            best_split(items, at_once, |item| bin(item, axis)).map(|cut| (axis, cut))
        });
        if let Some((axis, (split_plane, _))) = borders.min_by(|a, b| a.1.1.total_cmp(&b.1.1)) {
            let first = partition(items, |item| bin(item, axis) < split_plane);
            return (axis, first);
        }
    }
    // Otherwise split at the median of the longest axis.
    let axis = (0..3)
        .max_by(|a, b| size[*a].total_cmp(&size[*b]))
        .unwrap_or(0);
    let middle = items.len() / 2;
    items.sort_unstable_by(|a, b| {
        a.bounds.center()[axis]
            .total_cmp(&b.bounds.center()[axis])
            .then(a.index.cmp(&b.index))
    });
    (axis, middle)
}

/// The border between bins with the least expected work on both sides, and that work, if any has
/// items on both.
fn best_split(
    items: &[BvhItem],
    at_once: u32,
    bin: impl Fn(&BvhItem) -> usize,
) -> Option<(usize, f64)> {
    let mut bins = [(Bounds::EMPTY, 0_u32); BINS];
    for item in items {
        let (bounds, count) = &mut bins[bin(item)];
        *bounds = bounds.union(item.bounds);
        *count += 1;
    }
    let add = |sum: &mut (Bounds, u32), bin: &(Bounds, u32)| {
        *sum = (sum.0.union(bin.0), sum.1 + bin.1);
        Some(if sum.1 > 0 {
            sum.0.half_area() * f64::from(sum.1.div_ceil(at_once))
        } else {
            f64::NAN
        })
    };
    let mut above = [f64::NAN; BINS];
    let works = bins.iter().rev().scan((Bounds::EMPTY, 0), add);
    above
        .iter_mut()
        .rev()
        .zip(works)
        .for_each(|(above, work)| *above = work);
    let below = bins.iter().scan((Bounds::EMPTY, 0), add);
    let works = below.zip(&above[1..]).map(|(below, above)| below + above);
    (1..BINS)
        .zip(works)
        .filter(|(_, work)| !work.is_nan())
        .min_by(|a, b| a.1.total_cmp(&b.1))
}

/// Moves the items that belong first to the front, keeping the order within both groups.
fn partition(items: &mut [BvhItem], first: impl Fn(&BvhItem) -> bool) -> usize {
    let (front, back): (Vec<BvhItem>, Vec<BvhItem>) = items.iter().partition(|item| first(item));
    items[..front.len()].copy_from_slice(&front);
    items[front.len()..].copy_from_slice(&back);
    front.len()
}

fn to_axis(axis: usize) -> u8 {
    u8::try_from(axis).unwrap_or(0)
}
