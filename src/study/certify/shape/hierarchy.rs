//! A hierarchy of balls over surfaces: of two halves each, by the middles along the widest axis.

use super::{Ball, CertifiedRay};
use crate::certify::number::CertifiedNumber;
use rtc_math::{Vec3, to_u32};

/// The most surfaces of a leaf.
const LEAF: usize = 4;

/// A ball around the surfaces of a part of the list.
struct BallNode {
    ball: Ball,
    /// Where the list of its surfaces begins and ends.
    items: [u32; 2],
    /// The node of the second half; the first one follows this node. 0 for a leaf.
    second: u32,
}

/// The hierarchy.
pub(super) struct BallHierarchy {
    nodes: Vec<BallNode>,
    /// The surfaces, so that those of a node follow each other.
    order: Vec<u32>,
}

impl BallHierarchy {
    /// A hierarchy over balls, each with the index of its surface.
    pub(super) fn new(mut balls: Vec<(u32, Ball)>) -> Self {
        let mut nodes = Vec::with_capacity(2 * balls.len() / LEAF + 1);
        if !balls.is_empty() {
            build(&mut balls, 0, &mut nodes);
        }
        let order = balls.into_iter().map(|(index, _)| index).collect();
        Self { nodes, order }
    }

    /// Visits the surfaces whose balls a ray may meet no later than a `t`, which the visitor
    /// returns.
    #[inline]
    pub(super) fn visit<N: CertifiedNumber>(
        &self,
        ray: &CertifiedRay<N>,
        mut t_max: f64,
        mut visit: impl FnMut(usize) -> f64,
    ) {
        /// The list is halved at each level, and has fewer than 2³² members.
        const DEEPEST: usize = 64;
        let mut pending = [0; DEEPEST];
        let mut count = usize::from(!self.nodes.is_empty());
        while count > 0 {
            count -= 1;
            let index = pending[count];
            let node = &self.nodes[index as usize];
            if ray.range_in(&node.ball).is_none_or(|[low, _]| low > t_max) {
                continue;
            }
            if node.second > 0 {
                pending[count] = node.second;
                pending[count + 1] = index + 1;
                count += 2;
                continue;
            }
            let [first, end] = node.items.map(|item| item as usize);
            for item in &self.order[first..end] {
                t_max = visit(*item as usize);
            }
        }
    }
}

/// Adds the nodes over balls, which begin at an index of the whole list.
fn build(balls: &mut [(u32, Ball)], first: usize, nodes: &mut Vec<BallNode>) {
    let low = |(_, ball): &(u32, Ball)| ball.center - Vec3::splat(ball.radius);
    let high = |(_, ball): &(u32, Ball)| ball.center + Vec3::splat(ball.radius);
    let min = balls.iter().map(low).fold(Vec3::INFINITY, Vec3::min);
    let max = balls.iter().map(high).fold(Vec3::NEG_INFINITY, Vec3::max);
    let center = 0.5 * min + 0.5 * max;
    let reach = |(_, ball): &(u32, Ball)| (ball.center - center).length() + ball.radius;
    let radius = balls.iter().map(reach).fold(0.0, f64::max);
    // More than the rounding of the reach.
    let radius = radius * (1.0 + 1e-12);
    let index = nodes.len();
    nodes.push(BallNode {
        ball: Ball { center, radius },
        items: [first, first + balls.len()].map(to_u32),
        second: 0,
    });
    if balls.len() <= LEAF {
        return;
    }
    let size = max - min;
    let axis = (0..3).fold(
        0,
        |widest, k| if size[k] > size[widest] { k } else { widest },
    );
    let middle = balls.len() / 2;
    balls.select_nth_unstable_by(middle, |(_, a), (_, b)| {
        a.center[axis].total_cmp(&b.center[axis])
    });
    let (before, after) = balls.split_at_mut(middle);
    build(before, first, nodes);
    nodes[index].second = to_u32(nodes.len());
    build(after, first + middle, nodes);
}
