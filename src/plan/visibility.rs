//! Visibility: the surfaces that camera rays and reflected rays may hit, and the longest chain of
//! reflections.

use super::margin::VisibleSides;
use super::projection::{ScreenProjection, ScreenRect};
use super::rules::{Rule, RuleSet};
use super::surface_bounds::{ShapeClass, SurfaceBounds};
use super::{MAX_PAIRS, SceneFacts};
use rtc_valid::Ambient;

/// The surfaces that rays may hit.
pub(super) struct VisibleSurfaces {
    /// For each surface, whether a camera ray, a reflected or a refracted ray may hit it.
    pub(super) visible: Vec<bool>,
    /// For each surface, the visible sides.
    pub(super) sides: Vec<VisibleSides>,
    /// The number of bounces after the first hit that may contribute.
    pub(super) depth: u32,
    /// Whether there are too many reflective surfaces to test all pairs.
    pub(super) capped: bool,
}

impl VisibleSurfaces {
    /// The visibility of all surfaces, given their screen rectangles, with at most `depth` bounces.
    pub(super) fn new(
        facts: &SceneFacts<'_>,
        projection: &ScreenProjection,
        screen_rects: &[ScreenRect],
        depth: u32,
    ) -> Self {
        // Find the surfaces and sides that camera rays can hit.
        let lens = projection.lens();
        let visible = screen_rects
            .iter()
            .map(|rect| *rect != ScreenRect::Outside)
            .collect::<Vec<_>>();
        let seen = |(bounds, visible): (&SurfaceBounds, &bool)| {
            if *visible {
                bounds.visible_sides(Some(&lens))
            } else {
                VisibleSides::default()
            }
        };
        let sides = facts
            .surface_bounds
            .iter()
            .zip(&visible)
            .map(seen)
            .collect();
        // Add the surfaces that reflected and refracted rays can hit.
        let visibility = Self {
            visible,
            sides,
            depth: 0,
            capped: false,
        };
        if depth == 0 {
            visibility
        } else {
            visibility.bounce(facts, depth)
        }
    }

    /// Adds the surfaces that are visible by reflection or refraction.
    ///
    /// Computes a least fixed point: a ray after k bounces can only hit surfaces that are visible
    /// from a surface hit after k − 1 bounces. By induction, no ray hits a surface outside the set.
    fn bounce(mut self, facts: &SceneFacts<'_>, depth: u32) -> Self {
        // Start with the visible reflective surfaces.
        let count = facts.surface_bounds.len();
        let has_bounce = facts
            .summaries
            .iter()
            .filter(|summary| summary.has_bounce())
            .count();
        let is_reached =
            |mirror: usize| self.visible[mirror] && facts.summaries[mirror].has_bounce();
        let mut pending = (0..count)
            .filter(|surface| is_reached(*surface))
            .collect::<Vec<_>>();
        if pending.is_empty() {
            return self;
        }
        if has_bounce.saturating_mul(count) > MAX_PAIRS {
            return Self {
                visible: vec![true; count],
                sides: vec![VisibleSides::BOTH; count],
                depth,
                capped: true,
            };
        }
        // Propagate visible sides until nothing changes.
        let mut targets = vec![Vec::new(); count];
        while let Some(mirror) = pending.pop() {
            targets[mirror] = facts.shown_by(mirror, self.sides[mirror]);
            for target in &targets[mirror] {
                let sides = facts.surface_bounds[*target]
                    .visible_sides(facts.surface_bounds[mirror].aabb());
                let sides = self.sides[*target].with(sides);
                let is_changed = sides != self.sides[*target];
                (self.visible[*target], self.sides[*target]) = (true, sides);
                if is_changed && facts.summaries[*target].has_bounce() && !pending.contains(target)
                {
                    pending.push(*target);
                }
            }
        }
        // Bound the depth by the longest chain of reflections.
        self.depth = longest_chain(&targets).map_or(depth, |chain| chain.min(depth));
        self
    }
}

impl SceneFacts<'_> {
    /// The surfaces that rays from a reflective surface may hit, if its `sides` are visible.
    fn shown_by(&self, mirror: usize, sides: VisibleSides) -> Vec<usize> {
        // A smooth mirror reflects along one direction.
        let (bounds, summary) = (&self.surface_bounds[mirror], &self.summaries[mirror]);
        let scatters = summary.refracts || (summary.glossy && summary.has_shading_normals());
        let others = |may_show: &dyn Fn(&SurfaceBounds) -> bool| {
            let others = (0..self.surface_bounds.len()).filter(|surface| *surface != mirror);
            others
                .filter(|surface| may_show(&self.surface_bounds[*surface]))
                .collect()
        };
        let one_side = if sides == VisibleSides::BOTH {
            None
        } else {
            Some(sides)
        };
        // A plane shows what is on its reflecting side, a convex shape never itself.
        match (bounds.class, one_side) {
            (ShapeClass::Planar(plane), Some(side))
                if !scatters && self.rules.contains(Rule::MirrorUnreached) =>
            {
                others(&|bounds| {
                    bounds
                        .aabb()
                        .is_none_or(|aabb| plane.sides(aabb) != side.opposite())
                })
            }
            (ShapeClass::Sphere(..) | ShapeClass::Convex, Some(VisibleSides::FRONT))
                if !scatters && self.rules.contains(Rule::MirrorConvex) =>
            {
                others(&|_| true)
            }
            (
                ShapeClass::Planar(_)
                | ShapeClass::Sphere(..)
                | ShapeClass::Convex
                | ShapeClass::Other,
                _,
            ) => (0..self.surface_bounds.len()).collect(),
        }
    }
}

/// The length of the longest path in the graph of reflections; `None` if it has a cycle
/// (depth-first search).
fn longest_chain(targets: &[Vec<usize>]) -> Option<u32> {
    #[derive(Clone, Copy, PartialEq)]
    enum Chain {
        Unknown,
        InProgress,
        Known(u32),
    }
    fn from(mirror: usize, targets: &[Vec<usize>], chains: &mut [Chain]) -> Option<u32> {
        match chains[mirror] {
            Chain::Known(chain) => return Some(chain),
            Chain::InProgress => return None,
            Chain::Unknown => chains[mirror] = Chain::InProgress,
        }
        let mut longest = 0;
        for target in &targets[mirror] {
            longest = longest.max(1 + from(*target, targets, chains)?);
        }
        chains[mirror] = Chain::Known(longest);
        Some(longest)
    }
    let mut chains = vec![Chain::Unknown; targets.len()];
    (0..targets.len()).try_fold(0, |longest, mirror| {
        Some(longest.max(from(mirror, targets, &mut chains)?))
    })
}

/// The number of bounces after which the remaining contribution is below half a level of 8 bits.
///
/// After D bounces a path contributes at most `Σ_{i > D} kⁱ·L`, where k is the largest sum of the
/// weights of the rays from a point, and L the largest direct term of a point.
pub(super) fn truncated_depth(facts: &SceneFacts<'_>, depth: u32, rules: RuleSet) -> u32 {
    if !rules.contains(Rule::Cut) {
        return depth;
    }
    let weight = facts
        .summaries
        .iter()
        .map(|summary| summary.weight)
        .fold(0.0, f64::max);
    let light = facts
        .sources
        .iter()
        .map(|light| light.color.max_element())
        .sum::<f64>();
    // An ambient term that is added once counts as that of a light of its colour.
    let light = match facts.scene.settings().ambient {
        Ambient::PerLight => light,
        Ambient::Once(color) => light.max(color.max_element()),
    };
    let max_direct = facts
        .summaries
        .iter()
        .map(|summary| summary.max_direct)
        .fold(0.0, f64::max)
        * light;
    let mut rest = max_direct * weight / (1.0 - weight);
    let mut bounces = 0;
    while bounces < depth && !(weight < 1.0 && rest < 0.5 / 255.0) {
        rest *= weight;
        bounces += 1;
    }
    bounces
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_longest_chain_of_mirrors_is_found_and_a_cycle_has_none() {
        assert_eq!(longest_chain(&[vec![], vec![]]), Some(0));
        assert_eq!(
            longest_chain(&[vec![1, 2], vec![2], vec![3], vec![]]),
            Some(3)
        );
        assert_eq!(longest_chain(&[vec![1], vec![0]]), None);
        assert_eq!(longest_chain(&[vec![0]]), None);
    }
}
