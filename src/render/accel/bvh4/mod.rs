//! A hierarchy over triangles, four wide: it finds candidates and decides nothing about a hit.
//!
//! A binary hierarchy by the surface area heuristic whose nodes hold their grandchildren, as in
//! Dammertz, Hanika, Keller, "Shallow bounding volume hierarchies" (2008); both boxes and triangles
//! are tested four at a time.

use crate::math::Vec3;
use crate::render::accel::bounds::Bounds;
use crate::render::accel::bvh::{Item, split, to_u32};
use crate::render::accel::lanes::{Beam, Boxes, Corners, NoBeam, QuantizationFrame};
use crate::render::ray::Ray;
use arrayvec::ArrayVec;

/// Children of a node, and triangles of a leaf.
const WIDTH: usize = 4;

/// Below this depth the heuristic chooses; above it the middle, which needs at most 16 more.
const HEURISTIC_DEPTH: usize = 16;

/// What a walk has left for later, with where the ray enters it: each level leaves at most three
/// children.
type TraversalStack = ArrayVec<(f32, u32), { (HEURISTIC_DEPTH + 16) * (WIDTH - 1) + 1 }>;

/// The bit of a link that leads to a leaf; the two lowest are then one less than the triangles in
/// it.
const LEAF: u32 = 1 << 31;

/// Where a leaf has no triangle.
const NONE: u32 = u32::MAX;

#[derive(Debug)]
#[repr(align(64))]
struct Node {
    boxes: Boxes,
    links: [u32; WIDTH],
}

#[derive(Debug)]
struct Leaf {
    corners: Corners,
    items: [u32; WIDTH],
}

/// The hierarchy.
#[derive(Debug)]
pub(in crate::render) struct Bvh4 {
    frame: QuantizationFrame,
    nodes: Vec<Node>,
    leaves: Vec<Leaf>,
    root: u32,
}

impl Bvh4 {
    /// Builds the hierarchy of some triangles, each known by its index, and corners that may be
    /// wrong by `error_bound`; `None` if there is none.
    pub(in crate::render) fn build(
        count: usize,
        error_bound: f64,
        corners: impl Fn(u32) -> [Vec3; 3],
    ) -> Option<Self> {
        let bounds = |index| Bounds::of(&corners(index)).grown(error_bound);
        let mut items = (0..to_u32(count))
            .map(|index| Item {
                index,
                bounds: bounds(index),
            })
            .collect::<Vec<_>>();
        if items.is_empty() {
            return None;
        }
        let frame = QuantizationFrame::around(items.iter().map(|item| item.bounds), error_bound);
        let mut wide = Self {
            frame,
            nodes: Vec::new(),
            leaves: Vec::new(),
            root: 0,
        };
        wide.root = wide.add(&mut items, &corners, 0);
        wide.nodes.shrink_to_fit();
        wide.leaves.shrink_to_fit();
        Some(wide)
    }

    /// Adds what is needed for some items and returns the link to it.
    fn add(
        &mut self,
        items: &mut [Item],
        corners: &impl Fn(u32) -> [Vec3; 3],
        depth: usize,
    ) -> u32 {
        if items.len() <= WIDTH {
            return self.add_leaf(items, corners);
        }
        let mut parts = vec![items];
        // The largest part is met most often.
        while let Some(next) = largest(&parts, depth).filter(|_| parts.len() < WIDTH) {
            let part = parts.swap_remove(next);
            let (_, middle) = split(part, 4, depth < HEURISTIC_DEPTH);
            let (first, second) = part.split_at_mut(middle);
            parts.extend([first, second]);
        }
        let boxes = parts.iter().map(|part| whole(part)).collect::<Vec<_>>();
        let here = self.nodes.len();
        self.nodes.push(Node {
            boxes: self.frame.boxes(&boxes),
            links: [LEAF; WIDTH],
        });
        for (child, part) in parts.into_iter().enumerate() {
            self.nodes[here].links[child] = self.add(part, corners, depth + 1);
        }
        to_u32(here)
    }

    fn add_leaf(&mut self, items: &[Item], corners: &impl Fn(u32) -> [Vec3; 3]) -> u32 {
        let triangles = items
            .iter()
            .map(|item| corners(item.index))
            .collect::<Vec<_>>();
        let mut indices = [NONE; WIDTH];
        indices
            .iter_mut()
            .zip(items)
            .for_each(|(index, item)| *index = item.index);
        let link = LEAF | to_u32(self.leaves.len()) << 2 | to_u32(items.len() - 1);
        self.leaves.push(Leaf {
            corners: self.frame.corners(&triangles),
            items: indices,
        });
        link
    }

    /// Calls `visit` with the triangles that the ray may hit before `t_max`, or, if not `CULL`,
    /// with all whose boxes it may meet, nearer ones roughly first; `visit` returns the new
    /// `t_max`, which ends the walk when it falls below 0.
    #[inline]
    pub(in crate::render) fn walk<const CULL: bool>(
        &self,
        ray: &Ray,
        mut t_max: f64,
        mut visit: impl FnMut(u32) -> f64,
    ) {
        let beam = match Beam::new(&self.frame, ray) {
            Ok(beam) => beam,
            Err(NoBeam::Missed) => return,
            Err(NoBeam::Untold) => {
                let mut items = self
                    .leaves
                    .iter()
                    .flat_map(|leaf| leaf.items)
                    .filter(|item| *item != NONE);
                while t_max >= 0.0
                    && let Some(item) = items.next()
                {
                    t_max = visit(item);
                }
                return;
            }
        };
        let mut limit = beam.limit(t_max);
        let mut open = TraversalStack::new();
        let mut link = self.root;
        loop {
            if link & LEAF == 0 {
                let node = &self.nodes[link as usize];
                let (met, enter) = beam.meet(&node.boxes, limit);
                if met != 0 {
                    link = nearest(&mut open, met, &enter.to_array(), &node.links);
                    continue;
                }
            } else {
                let leaf = &self.leaves[((link & !LEAF) >> 2) as usize];
                let all = 0b1111 >> (3 - (link & 3));
                let mut candidates = if CULL {
                    all & beam.may_hit(&leaf.corners, limit)
                } else {
                    all
                };
                if candidates != 0 {
                    while candidates != 0 {
                        t_max =
                            visit(leaf.items[candidates.trailing_zeros() as usize & (WIDTH - 1)]);
                        if t_max < 0.0 {
                            return;
                        }
                        candidates &= candidates - 1;
                    }
                    limit = beam.limit(t_max);
                }
            }
            // The last one left for later that may still count.
            loop {
                let Some((near, next)) = open.pop() else {
                    return;
                };
                if near <= limit {
                    link = next;
                    break;
                }
            }
        }
    }
}

/// The nearest of the children met; the others are left for later.
#[inline(always)]
fn nearest(
    open: &mut TraversalStack,
    mut met: u32,
    enter: &[f32; WIDTH],
    links: &[u32; WIDTH],
) -> u32 {
    let lane = met.trailing_zeros() as usize & (WIDTH - 1);
    let mut first = (enter[lane], links[lane]);
    met &= met - 1;
    while met != 0 {
        let lane = met.trailing_zeros() as usize & (WIDTH - 1);
        let mut other = (enter[lane], links[lane]);
        if other.0 < first.0 {
            (first, other) = (other, first);
        }
        open.push(other);
        met &= met - 1;
    }
    first.1
}

fn whole(items: &[Item]) -> Bounds {
    items
        .iter()
        .fold(Bounds::EMPTY, |bounds, item| bounds.union(item.bounds))
}

/// The part to be split next: that of the largest area, or, deep down, of the most items.
fn largest(parts: &[&mut [Item]], depth: usize) -> Option<usize> {
    let weight = |part: &[Item]| {
        if depth < HEURISTIC_DEPTH {
            whole(part).half_area()
        } else {
            part.len() as f64
        }
    };
    let able = (0..parts.len()).filter(|part| parts[*part].len() > WIDTH);
    able.max_by(|a, b| weight(parts[*a]).total_cmp(&weight(parts[*b])))
}

#[cfg(test)]
mod tests;
