//! A light tree: it samples one of many lights by the estimated contribution of its cluster, from
//! power, distance and orientation (Conty Estevez, Kulla, "Importance Sampling of Many Lights with
//! Adaptive Tree Splitting", Proc. ACM Comput. Graph. Interact. Tech. 1(2), 2018), without
//! splitting.
//!
//! Every light has a probability above 0 at every point, so the tree changes the variance, not the
//! mean. Probabilities below 2⁻³² are limited by the resolution of the random numbers.

use super::{Light, LightId};
use crate::sampler::remapped;
use rtc_math::{Bounds, IdTable, Vec3};

/// The least factor of orientation: the bound is never trusted to be 0.
const LEAST_FACING: f64 = 1.0 / 16.0;

/// A light that a tree can hold.
#[derive(Clone, Copy, Debug)]
pub(super) struct TreeLight {
    /// Its id among all lights.
    pub(super) light: LightId,
    pub(super) bounds: Bounds,
    /// Its approximate power, above 0.
    pub(super) power: f64,
    /// The unit normal, for a light that shines from both of its sides by the cosine.
    pub(super) normal: Option<Vec3>,
}

/// A binary tree over lights.
pub(super) struct LightTree {
    /// The left child of an inner node follows it.
    nodes: Vec<LightNode>,
    /// The way from the root to each light, from the lowest bit on: 1 is right.
    ways: IdTable<Light, Option<u64>>,
}

struct LightNode {
    center: Vec3,
    /// The square of the radius of a sphere around the bounds.
    radius_squared: f64,
    power: f64,
    /// The cone around the normals.
    cone: Option<NormalCone>,
    below: LightSubtree,
}

enum LightSubtree {
    Light(LightId),
    /// The index of the right child.
    Right(usize),
}

/// A double cone around normals, either way round.
struct NormalCone {
    axis: Vec3,
    /// The cosine and the sine of half its angle.
    cosine: f64,
    sine: f64,
}

impl LightTree {
    /// A tree over some of `count` lights; there is at least one.
    pub(super) fn new(mut emitters: Vec<TreeLight>, count: usize) -> Self {
        let mut tree = Self {
            nodes: Vec::with_capacity(2 * emitters.len()),
            ways: vec![None; count].into(),
        };
        tree.add(&mut emitters, 0, 0);
        tree
    }

    /// Adds the tree over lights, with `path` to its root. Halves have equally many lights, so no
    /// path is longer than 64.
    fn add(&mut self, emitters: &mut [TreeLight], direction: u64, depth: u32) {
        let index = self.nodes.len();
        let mut node = LightNode::around(emitters);
        if let [emitter] = emitters {
            self.ways[emitter.light] = Some(direction);
            node.below = LightSubtree::Light(emitter.light);
            self.nodes.push(node);
            return;
        }
        self.nodes.push(node);
        let (left, right) = halves(emitters);
        self.add(left, direction, depth + 1);
        self.nodes[index].below = LightSubtree::Right(self.nodes.len());
        self.add(right, direction | 1 << depth, depth + 1);
    }

    /// Chooses a light for a point with a number in [0, 1): its id, its probability, and the
    /// number remapped to [0, 1) for the next decision.
    pub(super) fn choose(&self, from: Vec3, mut u: f64) -> (LightId, f64, f64) {
        let (mut index, mut probability) = (0, 1.0);
        loop {
            let right = match self.nodes[index].below {
                LightSubtree::Light(light) => return (light, probability, u),
                LightSubtree::Right(right) => right,
            };
            let left = self.share_of_left(from, index + 1, right);
            let (child, above, share) = if u < left {
                (index + 1, u, left)
            } else {
                (right, u - left, 1.0 - left)
            };
            (index, u) = (child, remapped(above, share));
            probability *= share;
        }
    }

    /// The probability with which [`Self::choose`] chooses a light for a point.
    pub(super) fn probability(&self, light: LightId, from: Vec3) -> f64 {
        let Some(mut direction) = self.ways[light] else {
            return 0.0;
        };
        let (mut index, mut probability) = (0, 1.0);
        while let LightSubtree::Right(right) = self.nodes[index].below {
            let left = self.share_of_left(from, index + 1, right);
            let is_right = direction & 1 == 1;
            probability *= if is_right { 1.0 - left } else { left };
            index = if is_right { right } else { index + 1 };
            direction >>= 1;
        }
        probability
    }

    /// The probability of the left of two children.
    fn share_of_left(&self, from: Vec3, left: usize, right: usize) -> f64 {
        /// Both children keep a probability above 0, however far apart their bounds are.
        const LEAST: f64 = 1.0 / (1 << 20) as f64;
        let [left, right] = [left, right].map(|index| self.nodes[index].importance(from));
        let share = left / (left + right);
        if share.is_nan() {
            0.5
        } else {
            share.clamp(LEAST, 1.0 - LEAST)
        }
    }
}

impl LightNode {
    /// The node of lights, without its descendants.
    fn around(emitters: &[TreeLight]) -> Self {
        let boxes = emitters.iter().map(|emitter| emitter.bounds);
        let bounds = boxes.fold(Bounds::EMPTY, Bounds::union);
        Self {
            center: bounds.center(),
            radius_squared: (bounds.max - bounds.min).length_squared() / 4.0,
            power: emitters.iter().map(|emitter| emitter.power).sum(),
            cone: NormalCone::around(emitters),
            below: LightSubtree::Right(0),
        }
    }

    /// About how much light may come from here to a point.
    fn importance(&self, from: Vec3) -> f64 {
        let to = from - self.center;
        let square = to.length_squared();
        let strength = self.power / square.max(self.radius_squared);
        match &self.cone {
            Some(cone) if square > self.radius_squared => {
                strength * cone.facing(to, square, self.radius_squared)
            }
            _ => strength,
        }
    }
}

impl NormalCone {
    /// The cone around the normals of lights, if all have one.
    fn around(emitters: &[TreeLight]) -> Option<Self> {
        let first = emitters.first()?.normal?;
        let mut sum = Vec3::ZERO;
        for emitter in emitters {
            let normal = emitter.normal?;
            sum += if normal.dot(first) < 0.0 {
                -normal
            } else {
                normal
            };
        }
        let axis = sum.try_normalize()?;
        let normals = emitters.iter().filter_map(|emitter| emitter.normal);
        let cosine = normals.fold(1.0, |least, normal| axis.dot(normal).abs().min(least));
        Some(Self {
            axis,
            cosine,
            sine: (1.0 - cosine * cosine).max(0.0).sqrt(),
        })
    }

    /// A bound of the cosine between a normal and the direction to a point, from anywhere in a
    /// sphere that the point is out of.
    fn facing(&self, to: Vec3, square: f64, radius_squared: f64) -> f64 {
        let axial = (self.axis.dot(to).abs() / square.sqrt()).min(1.0);
        // Take from the angle to the axis that of the cone, and that of the sphere as it is seen.
        let seen = radius_squared / square;
        let angle = [axial, (1.0 - axial * axial).sqrt()];
        let angle = less(angle, [self.cosine, self.sine]);
        less(angle, [(1.0 - seen).sqrt(), seen.sqrt()])[0].max(LEAST_FACING)
    }
}

/// The cosine and the sine of the difference of two angles up to a right one; of 0 if it is
/// negative.
fn less([cosine, sine]: [f64; 2], [other_cosine, other_sine]: [f64; 2]) -> [f64; 2] {
    if cosine >= other_cosine {
        [1.0, 0.0]
    } else {
        [
            cosine * other_cosine + sine * other_sine,
            sine * other_cosine - cosine * other_sine,
        ]
    }
}

/// Lights in two halves, split across the longest side of the box around their middles.
fn halves(emitters: &mut [TreeLight]) -> (&mut [TreeLight], &mut [TreeLight]) {
    let middles = Bounds::of(emitters.iter().map(|emitter| emitter.bounds.center()));
    let size = middles.max - middles.min;
    let place = |emitter: &TreeLight| {
        let middle = emitter.bounds.center();
        if size.x >= size.y && size.x >= size.z {
            middle.x
        } else if size.y >= size.z {
            middle.y
        } else {
            middle.z
        }
    };
    emitters.sort_unstable_by(|a, b| {
        let order = place(a).total_cmp(&place(b));
        order.then(a.light.cmp(&b.light))
    });
    emitters.split_at_mut(emitters.len() / 2)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Lights along two lines, of many powers; every second has a normal, or all have.
    fn street(all_have_normals: bool) -> LightTree {
        let emitter = |light: usize| {
            let at = Vec3::new(
                light as f64,
                (light % 2) as f64 * 7.0,
                0.1 * (light % 5) as f64,
            );
            let normal = Vec3::new(1.0, 0.3 * (light % 7) as f64, -2.0).normalize();
            TreeLight {
                light: LightId::new(light + 3),
                bounds: Bounds::around(at, 0.05 * (light % 3) as f64),
                power: 1.0 + (light * light % 11) as f64,
                normal: (all_have_normals || light.is_multiple_of(2)).then_some(normal),
            }
        };
        LightTree::new((0..101).map(emitter).collect(), 110)
    }

    fn places() -> [Vec3; 4] {
        [
            Vec3::new(50.0, 3.0, 1.0),
            Vec3::new(7.0, 7.0, 0.2),
            Vec3::new(-4000.0, 1.0, 1.0),
            Vec3::new(20.01, 0.0, 0.0),
        ]
    }

    #[test]
    fn lights_come_as_often_as_their_probability_says() {
        const NUMBERS: usize = 1 << 16;
        for (tree, from) in [true, false]
            .into_iter()
            .flat_map(|all| places().map(|from| (street(all), from)))
        {
            let mut counts = vec![0.0; 110];
            for k in 0..NUMBERS {
                let (light, probability, _) = tree.choose(from, (k as f64 + 0.5) / NUMBERS as f64);
                counts[light.index()] += 1.0 / NUMBERS as f64;
                assert!((tree.probability(light, from) - probability).abs() < 1e-15);
            }
            for (light, count) in counts.into_iter().enumerate() {
                let probability = tree.probability(LightId::new(light), from);
                assert!(
                    (count - probability).abs() < 2.0 / NUMBERS as f64,
                    "{light}"
                );
                assert_eq!(probability > 0.0, (3..104).contains(&light), "{light}");
            }
        }
    }

    #[test]
    fn what_is_near_is_chosen_more_often() {
        let tree = street(false);
        let from = Vec3::new(20.01, 0.0, 0.5);
        let probability = |light| tree.probability(LightId::new(light), from);
        assert!(probability(23) > 20.0 * probability(103));
    }

    #[test]
    fn the_bound_of_a_cone_is_at_least_every_cosine() {
        let normals = (0..7).map(|k| Vec3::new(1.0, 0.3 * f64::from(k), -2.0).normalize());
        let emitter = |(light, normal)| TreeLight {
            light: LightId::new(light),
            bounds: Bounds::around(Vec3::new(light as f64, 0.0, 0.0), 0.0),
            power: 1.0,
            normal: Some(if light % 2 == 0 { normal } else { -normal }),
        };
        let emitters = normals.enumerate().map(emitter).collect::<Vec<_>>();
        let node = LightNode::around(&emitters);
        let cone = node.cone.as_ref().unwrap();
        for k in 0..4096_u32 {
            let unit = |shift: u32| f64::from(k.wrapping_mul(2_654_435_761) >> shift & 255) / 128.0;
            let from = Vec3::new(unit(0) - 1.0, unit(8) - 1.0, unit(16) - 1.0) * 20.0;
            let to = from - node.center;
            let square = to.length_squared();
            if square <= node.radius_squared {
                continue;
            }
            let bound = cone.facing(to, square, node.radius_squared);
            for emitter in &emitters {
                let away = (from - emitter.bounds.center()).normalize();
                let cosine = away.dot(emitter.normal.unwrap()).abs();
                assert!(cosine <= bound + 1e-12, "{from}: {cosine} {bound}");
            }
        }
    }
}
