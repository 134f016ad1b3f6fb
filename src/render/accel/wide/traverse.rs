//! BVH traversal of a ray.

use super::{Candidate, LEAF, NONE, TraversalStack, WideBvh, leaf_at};
use crate::accel::conservative_ray::{ConservativeRay, RayRejection};
use crate::accel::lanes::{BoxLanes, HitMask, LINKS, TriangleLanes, TriangleRow, WIDTH, WideNode};
use crate::accel::simd::at_level;
use crate::ray::Ray;
use fearless_simd::Simd;
use rtc_math::fuses;

/// A BVH and a ray through it.
struct Traversal<'traverse, S: Simd> {
    nodes: &'traverse [WideNode],
    rows: &'traverse [TriangleRow],
    unit: Option<f64>,
    conservative_ray: ConservativeRay,
    boxes: BoxLanes<S>,
    triangles: TriangleLanes<S>,
    t_certain: f32,
}

/// The callbacks of a traversal, for the triangles that the ray may hit.
pub(crate) trait TriangleVisitor {
    /// Whether triangles that the ray certainly misses are skipped. Otherwise all triangles are
    /// visited whose boxes the ray may hit.
    const CULLS: bool = true;

    /// Whether certain hits before the end of the ray are reported to
    /// [`TriangleVisitor::accepts_certain`].
    const IS_CERTAIN: bool = false;

    /// Visits a candidate and returns the new far bound of t; a value below 0 ends the traversal.
    fn visit(&mut self, candidate: Candidate<'_>) -> f64;

    /// Receives a triangle that is certainly hit. Returns whether to end the traversal.
    fn accepts_certain(&mut self, _item: u32) -> bool {
        false
    }
}

impl<F: FnMut(Candidate<'_>) -> f64> TriangleVisitor for F {
    #[inline(always)]
    fn visit(&mut self, candidate: Candidate<'_>) -> f64 {
        self(candidate)
    }
}

impl WideBvh {
    /// Has the triangles visited that the ray may hit before `t_max`, nearer ones roughly first.
    #[inline]
    pub(crate) fn traverse(&self, ray: &Ray, t_max: f64, visitor: &mut impl TriangleVisitor) {
        at_level!(self.simd, simd => self.traverse_one(simd, ray, t_max, visitor));
    }

    #[inline(always)]
    fn traverse_one<S: Simd, V: TriangleVisitor>(
        &self,
        simd: S,
        ray: &Ray,
        t_max: f64,
        visitor: &mut V,
    ) {
        if let Some(conservative_ray) = self.conservative_ray(ray, t_max, visitor) {
            let t_far = conservative_ray.t_far(t_max);
            let traversal = self.start::<S, V>(simd, conservative_ray, t_max);
            traversal.run(simd, visitor, t_far, self.root);
        }
    }

    /// The conservative ray of a ray; `None` if it meets nothing, or where arithmetic cannot decide
    /// and all triangles have been visited.
    #[inline(always)]
    fn conservative_ray<V: TriangleVisitor>(
        &self,
        ray: &Ray,
        t_max: f64,
        visitor: &mut V,
    ) -> Option<ConservativeRay> {
        // A ray that ends before it starts.
        if t_max < 0.0 {
            return None;
        }
        match ConservativeRay::new(&self.frame, ray) {
            Ok(conservative_ray) => Some(conservative_ray),
            Err(RayRejection::Missed) => None,
            Err(RayRejection::Indeterminate) => {
                self.visit_all(visitor);
                None
            }
        }
    }

    /// The traversal by a conservative ray.
    #[inline(always)]
    fn start<S: Simd, V: TriangleVisitor>(
        &self,
        simd: S,
        conservative_ray: ConservativeRay,
        t_max: f64,
    ) -> Traversal<'_, S> {
        Traversal {
            nodes: self.nodes.rows(),
            rows: self.triangles.rows(),
            unit: self.unit,
            boxes: BoxLanes::new(simd, &conservative_ray),
            triangles: TriangleLanes::new(simd, &conservative_ray),
            t_certain: if V::IS_CERTAIN {
                conservative_ray.t_certain(t_max)
            } else {
                0.0
            },
            conservative_ray,
        }
    }

    /// Has all triangles visited, while they may count.
    #[cold]
    #[inline(never)]
    fn visit_all(&self, visitor: &mut impl TriangleVisitor) {
        let unit = self.unit;
        let nodes = self.nodes.rows().iter();
        let links = nodes.flat_map(|node| node[LINKS..].iter().map(|link| link.to_bits()));
        let links = links.chain([self.root]);
        let leaves = links
            .filter(|link| link & LEAF != 0 && *link != NONE)
            .map(|link| leaf_at(self.triangles.rows(), link));
        for (leaf, lane) in leaves.flat_map(|leaf| (0..leaf.count()).map(move |lane| (leaf, lane)))
        {
            let item = leaf.item(lane);
            let t_max = visitor.visit(Candidate {
                item,
                leaf,
                lane,
                unit,
                is_fused: false,
            });
            if t_max < 0.0 {
                return;
            }
        }
    }
}

impl<S: Simd> Traversal<'_, S> {
    /// Visits nodes and leaves from a link on, nearer ones roughly first.
    ///
    /// What changes from step to step are variables, which are kept in registers: in fields beside
    /// the stack they were in memory, and each step waited for what the one before had written.
    #[inline(always)]
    fn run<V: TriangleVisitor>(&self, simd: S, visitor: &mut V, mut t_far: f32, mut link: u32) {
        let mut open = TraversalStack::new();
        loop {
            if link & LEAF == 0 {
                let node = &self.nodes[link as usize];
                let (hit_children, enter) = self.boxes.meet(simd, node, t_far);
                if hit_children != 0 {
                    link = nearest(&mut open, hit_children, &enter, node);
                    continue;
                }
            } else {
                match self.visit_leaf(simd, visitor, link, t_far) {
                    Some(end) => t_far = end,
                    None => return,
                }
            }
            // The last one left for later that may still count.
            link = loop {
                match open.pop() {
                    Some((near, next)) if near <= t_far => break next,
                    Some(_) => {}
                    None => return,
                }
            };
        }
    }

    /// Has the triangles of a leaf visited that the ray may hit, and returns the new far bound;
    /// `None` if the traversal ends.
    #[inline(always)]
    fn visit_leaf<V: TriangleVisitor>(
        &self,
        simd: S,
        visitor: &mut V,
        link: u32,
        t_far: f32,
    ) -> Option<f32> {
        let leaf = leaf_at(self.rows, link);
        let all = 0b1111 >> (3 - (link & 3));
        // Test the triangles of the leaf against the ray.
        let hit_mask = match (V::CULLS, V::IS_CERTAIN) {
            (false, _) => HitMask {
                maybe: all,
                certain: 0,
            },
            (true, false) => self.triangles.intersect4::<false>(simd, leaf, [t_far, 0.0]),
            (true, true) => {
                let limits = [t_far, self.t_certain];
                self.triangles.intersect4::<true>(simd, leaf, limits)
            }
        };
        // A certain hit may end the traversal.
        for lane in lanes_of(hit_mask.certain & all) {
            if visitor.accepts_certain(leaf.item(lane)) {
                return None;
            }
        }
        // Report the candidates, and shorten the ray.
        let mut t_max = None;
        for lane in lanes_of(hit_mask.maybe & all) {
            let item = leaf.item(lane);
            let unit = self.unit;
            let end = visitor.visit(Candidate {
                item,
                leaf,
                lane,
                unit,
                is_fused: fuses(simd),
            });
            if end < 0.0 {
                return None;
            }
            t_max = Some(end);
        }
        Some(t_max.map_or(t_far, |t_max| self.conservative_ray.t_far(t_max)))
    }
}

/// The lanes of some bits.
#[inline(always)]
fn lanes_of(mut bits: u32) -> impl Iterator<Item = usize> {
    std::iter::from_fn(move || {
        let lane = bits.trailing_zeros() as usize;
        let is_there = bits != 0;
        bits &= bits.wrapping_sub(1);
        is_there.then_some(lane & (WIDTH - 1))
    })
}

/// The nearest of the hit children; the others are pushed.
#[inline(always)]
fn nearest(
    open: &mut TraversalStack,
    mut hit_children: u32,
    enter: &[f32; WIDTH],
    node: &WideNode,
) -> u32 {
    let child = |hit_children: u32| {
        let lane = hit_children.trailing_zeros() as usize & (WIDTH - 1);
        (enter[lane], node[LINKS + lane].to_bits())
    };
    let mut first = child(hit_children);
    hit_children &= hit_children - 1;
    while hit_children != 0 {
        let mut other = child(hit_children);
        if other.0 < first.0 {
            (first, other) = (other, first);
        }
        open.push(other);
        hit_children &= hit_children - 1;
    }
    first.1
}
