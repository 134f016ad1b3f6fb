//! BVH traversal for packets of eight coherent rays: each node is fetched once per packet.

use super::traverse::{Visitor, lanes_of};
use super::{Candidate, LEAF, TraversalStack, Wide, leaf_at};
use crate::accel::conservative_ray::{ConservativeRay, RayRejection};
use crate::accel::lanes::{LINKS, WIDTH};
use crate::accel::packet::{Packet, RAYS};
use crate::accel::simd::at_level;
use crate::ray::Ray;
use fearless_simd::Simd;

/// The `t_far` of a finished ray.
const ENDED: f32 = f32::NEG_INFINITY;

/// Where a packet is in the BVH.
struct PacketTraversal<'traverse, 'rays, S: Simd, V> {
    wide: &'traverse Wide,
    packet: Packet<S>,
    conservative_rays: [ConservativeRay; RAYS],
    rays: &'rays mut [(Ray, f64, V); RAYS],
    /// `t_far` and `t_certain` of the conservative rays.
    limits: [[f32; RAYS]; 2],
    /// The greatest of the limits.
    t_far: f32,
    open: TraversalStack,
}

impl Wide {
    /// As [`Wide::traverse`] for each of some rays, with the `t_max` and the visitor of each.
    /// Fastest where rays side by side visit the same nodes.
    pub(crate) fn traverse_packets<V: Visitor>(&self, rays: &mut [(Ray, f64, V)]) {
        at_level!(self.simd, simd => self.traverse_all_packets(simd, rays));
    }

    #[inline(always)]
    fn traverse_all_packets<S: Simd, V: Visitor>(&self, simd: S, rays: &mut [(Ray, f64, V)]) {
        let (packets, rest) = rays.as_chunks_mut::<RAYS>();
        for packet in packets {
            self.traverse_packet(simd, packet);
        }
        for (ray, t_max, visitor) in rest {
            self.traverse_one(simd, ray, *t_max, visitor);
        }
    }

    #[inline(always)]
    fn traverse_packet<S: Simd, V: Visitor>(&self, simd: S, rays: &mut [(Ray, f64, V); RAYS]) {
        let mut conservative_rays = [None; RAYS];
        for lane in 0..RAYS {
            let (ray, t_max, visitor) = &mut rays[lane];
            conservative_rays[lane] = self.conservative_ray(ray, *t_max, visitor);
        }
        let Some(any) = conservative_rays.iter().flatten().next().copied() else {
            return;
        };
        // A ray without a conservative ray copies another one, and is finished.
        let mut full = [any; RAYS];
        let mut limits = [[ENDED; RAYS]; 2];
        for lane in 0..RAYS {
            if let Some(conservative_ray) = conservative_rays[lane] {
                full[lane] = conservative_ray;
                limits[0][lane] = conservative_ray.t_far(rays[lane].1);
                limits[1][lane] = conservative_ray.t_certain(rays[lane].1);
            }
        }
        let Some(packet) = Packet::new(simd, &full) else {
            for (conservative_ray, (_, t_max, visitor)) in conservative_rays.into_iter().zip(rays) {
                if let Some(conservative_ray) = conservative_ray {
                    self.traverse_from(simd, conservative_ray, *t_max, visitor);
                }
            }
            return;
        };
        let mut packet_traversal = PacketTraversal {
            wide: self,
            packet,
            conservative_rays: full,
            rays,
            limits,
            t_far: greatest(&limits[0]),
            open: TraversalStack::new(),
        };
        packet_traversal.traverse(simd);
    }

    /// The conservative ray of a ray; `None` if it misses, or where arithmetic cannot decide and
    /// all triangles have been visited.
    #[inline(always)]
    pub(super) fn conservative_ray<V: Visitor>(
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
}

#[inline(always)]
fn greatest(limits: &[f32; RAYS]) -> f32 {
    let mut greatest = ENDED;
    for t_far in limits {
        greatest = greatest.max(*t_far);
    }
    greatest
}

impl<S: Simd, V: Visitor> PacketTraversal<'_, '_, S, V> {
    #[inline(always)]
    fn traverse(&mut self, simd: S) {
        let mut link = self.wide.root;
        loop {
            let next = if link & LEAF == 0 {
                self.nearest_child(simd, link)
            } else {
                self.visit_leaf(simd, link);
                None
            };
            let Some(next) = next.or_else(|| self.last_left()) else {
                return;
            };
            link = next;
        }
    }

    /// The last one left for later that may still count.
    #[inline(always)]
    fn last_left(&mut self) -> Option<u32> {
        while let Some((near, next)) = self.open.pop() {
            if near <= self.t_far {
                return Some(next);
            }
        }
        None
    }

    /// The nearest of the children of a node that the rays may hit; the others are pushed. A leaf
    /// counts only if some ray hits it individually.
    #[inline(always)]
    fn nearest_child(&mut self, simd: S, link: u32) -> Option<u32> {
        let node = &self.wide.nodes.rows()[link as usize];
        let (mut hit_children, enter) = self.packet.meet(simd, node, self.t_far);
        let mut nearest = None;
        while hit_children != 0 {
            let lane = hit_children.trailing_zeros() as usize & (WIDTH - 1);
            hit_children &= hit_children - 1;
            let child = (enter[lane], node[LINKS + lane].to_bits());
            let is_leaf = child.1 & LEAF != 0;
            if is_leaf && !self.packet.is_hit(simd, node, lane, &self.limits[0]) {
                continue;
            }
            match nearest {
                None => nearest = Some(child),
                Some(before) if child.0 < before.0 => {
                    self.open.push(before);
                    nearest = Some(child);
                }
                Some(_) => self.open.push(child),
            }
        }
        nearest.map(|(_, link)| link)
    }

    #[inline(always)]
    fn visit_leaf(&mut self, simd: S, link: u32) {
        let leaf = leaf_at(self.wide.triangles.rows(), link);
        for lane in 0..leaf.count() {
            // Test one triangle against all rays of the packet.
            let hit_mask = if V::IS_CERTAIN {
                self.packet
                    .intersect4::<true>(simd, leaf, lane, &self.limits)
            } else {
                self.packet
                    .intersect4::<false>(simd, leaf, lane, &self.limits)
            };
            if hit_mask.maybe == 0 {
                continue;
            }
            let candidate = Candidate {
                item: leaf.item(lane),
                leaf,
                lane,
                unit: self.wide.unit,
            };
            // Report the candidate to each ray that may hit it, and update its end.
            for ray in lanes_of(hit_mask.maybe) {
                let (_, _, visitor) = &mut self.rays[ray];
                let is_certain = hit_mask.certain & 1 << ray != 0;
                let is_over = is_certain && visitor.accepts_certain(candidate.item);
                let end = if is_over {
                    -1.0
                } else {
                    visitor.visit(candidate)
                };
                self.limits[0][ray] = if end < 0.0 {
                    ENDED
                } else {
                    self.conservative_rays[ray].t_far(end)
                };
            }
            self.t_far = greatest(&self.limits[0]);
        }
    }
}
