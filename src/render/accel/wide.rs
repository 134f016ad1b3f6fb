//! A hierarchy over triangles, four wide: it finds candidates and decides nothing about a hit.
//!
//! A binary hierarchy by the surface area heuristic whose nodes hold their grandchildren, as in
//! Dammertz, Hanika, Keller, "Shallow bounding volume hierarchies" (2008); both boxes and triangles
//! are tested four at a time.

use crate::math::Vec3;
use crate::render::accel::bounds::Bounds;
use crate::render::accel::bvh::{Item, split, to_u32};
use crate::render::accel::lanes::{Beam, Boxes, Corners, Cube, NoBeam};
use crate::render::ray::Ray;
use arrayvec::ArrayVec;

/// Children of a node, and triangles of a leaf.
const WIDTH: usize = 4;

/// Below this depth the heuristic chooses; above it the middle, which needs at most 16 more.
const HEURISTIC_DEPTH: usize = 16;

/// What a walk has left for later, with where the ray enters it: each level leaves at most three
/// children.
type Open = ArrayVec<(f32, u32), { (HEURISTIC_DEPTH + 16) * (WIDTH - 1) + 1 }>;

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
pub(in crate::render) struct Wide {
    cube: Cube,
    nodes: Vec<Node>,
    leaves: Vec<Leaf>,
    root: u32,
}

impl Wide {
    /// Builds the hierarchy of some triangles, each known by its index, and corners that may be
    /// wrong by `blur`; `None` if there is none.
    pub(in crate::render) fn build(
        count: usize,
        blur: f64,
        corners: impl Fn(u32) -> [Vec3; 3],
    ) -> Option<Self> {
        let bounds = |index| Bounds::of(&corners(index)).grown(blur);
        let mut items = (0..to_u32(count))
            .map(|index| Item {
                index,
                bounds: bounds(index),
            })
            .collect::<Vec<_>>();
        if items.is_empty() {
            return None;
        }
        let cube = Cube::around(items.iter().map(|item| item.bounds), blur);
        let mut wide = Self {
            cube,
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
            boxes: self.cube.boxes(&boxes),
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
            corners: self.cube.corners(&triangles),
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
        let beam = match Beam::new(&self.cube, ray) {
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
        let mut open = Open::new();
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
fn nearest(open: &mut Open, mut met: u32, enter: &[f32; WIDTH], links: &[u32; WIDTH]) -> u32 {
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
mod tests {
    use super::*;
    use crate::render::sampler::Key;
    use crate::render::shape::triangle::{Shear, Triangle};
    use rayon::prelude::*;

    /// Triangles in each hierarchy.
    const COUNT: u32 = 96;

    /// How triangles and rays are made: the scale and the place of all, how far the eye is, and
    /// what is special.
    const FAMILIES: [(&str, f64, f64, f64); 8] = [
        ("generic", 1.0, 0.0, 3.0),
        ("tiny", 1e-57, 0.0, 3.0),
        ("huge", 1e57, 0.0, 3.0),
        ("at 1e6", 1.0, 1e6, 3.0),
        ("seen from 1e9", 1.0, 0.0, 1e9),
        ("along the axes", 1.0, 0.0, 3.0),
        ("in one plane", 1.0, 0.0, 3.0),
        ("slivers", 1.0, 0.0, 0.5),
    ];

    fn triangles(family: usize) -> Vec<Triangle> {
        let (name, scale, place, _) = FAMILIES[family];
        let one = |index: u64| {
            let key = Key::new([u32::try_from(family).unwrap(), 7], index);
            let cube = |k: u64| {
                Vec3::new(key.uniform(k), key.uniform(k + 1), key.uniform(k + 2)) * 2.0 - 1.0
            };
            let (a, width) = (cube(0), if name == "slivers" { 1e-7 } else { 0.3 });
            let corners = [a, a + cube(3) * 0.3, a + cube(3) * 0.1 + cube(6) * width];
            let flat = |p: Vec3| {
                if name == "in one plane" {
                    p.with_z(0.25)
                } else {
                    p
                }
            };
            Triangle::new(corners.map(|p| flat(p) * scale + Vec3::splat(place)))
        };
        (0_u64..).filter_map(one).take(COUNT as usize).collect()
    }

    /// A ray at the inside, an edge or a corner of one of the triangles.
    fn aimed(family: usize, triangles: &[Triangle], index: u64) -> Ray {
        let (name, scale, place, distance) = FAMILIES[family];
        let key = Key::new([u32::try_from(family).unwrap(), 11], index);
        let [a, b, c] = *triangles[(index / 3) as usize % triangles.len()].vertices();
        let (u, v) = (key.uniform(0), key.uniform(1));
        let target = [
            a + (b - a) * (u * v) + (c - a) * (u * (1.0 - v)),
            a + (b - a) * u,
            a,
        ][(index % 3) as usize];
        let away = (Vec3::new(key.uniform(2), key.uniform(3), key.uniform(4)) * 2.0 - 1.0)
            * (distance * scale);
        if name == "along the axes" {
            let direction = [Vec3::X, Vec3::NEG_Y, Vec3::Z][(index / 5) as usize % 3];
            return Ray {
                origin: target - direction * 4.0,
                direction,
            };
        }
        let origin = Vec3::splat(place) + away;
        Ray {
            origin,
            direction: target - origin,
        }
    }

    #[test]
    fn whatever_is_hit_is_visited_and_little_else() {
        let rays = std::env::var("RTC_RAYS")
            .ok()
            .and_then(|count| count.parse().ok())
            .unwrap_or(20_000_u64);
        for (family, (name, ..)) in FAMILIES.into_iter().enumerate() {
            let all = triangles(family);
            let wide = Wide::build(all.len(), 0.0, |item| *all[item as usize].vertices()).unwrap();
            let judge = |index: u64| {
                let ray = aimed(family, &all, index);
                let shear = Shear::new(&ray);
                let (mut hits, mut missed, mut visits) = (0, 0, 0);
                for (item, triangle) in (0..).zip(&all) {
                    let Some(t) = triangle.intersect(&ray, &shear) else {
                        continue;
                    };
                    let (mut culled, mut boxed) = (false, false);
                    // Even if nothing beyond that hit counts any more.
                    wide.walk::<true>(&ray, t, |other| {
                        (culled, visits) = (culled || other == item, visits + 1);
                        t
                    });
                    wide.walk::<false>(&ray, t, |other| {
                        boxed |= other == item;
                        t
                    });
                    (hits, missed) = (hits + 1, missed + u64::from(!culled) + u64::from(!boxed));
                }
                [hits, missed, visits]
            };
            let add = |a: [u64; 3], b: [u64; 3]| [a[0] + b[0], a[1] + b[1], a[2] + b[2]];
            let [hits, missed, visits] =
                (0..rays).into_par_iter().map(judge).reduce(|| [0; 3], add);
            println!("| triangles passed over | {name} | {hits} | {missed} | {visits} visits |");
            assert!(hits > rays / 4 && missed == 0, "{name}: {missed} of {hits}");
            assert!(
                name == "slivers" || visits < 16 * hits,
                "{name}: {visits} visits for {hits} hits"
            );
        }
    }

    #[test]
    fn the_walk_ends_where_it_is_told_to_and_visits_each_triangle_once() {
        let all = triangles(0);
        let wide = Wide::build(all.len(), 0.0, |item| *all[item as usize].vertices()).unwrap();
        let visited = |ray: Ray, answer: f64| {
            let mut visited = Vec::new();
            wide.walk::<false>(&ray, f64::INFINITY, |item| {
                visited.push(item);
                answer
            });
            visited.sort_unstable();
            visited
        };
        let ray = aimed(0, &all, 0);
        assert_eq!(visited(ray, -1.0).len(), 1);
        let mut once = visited(ray, f64::INFINITY);
        once.dedup();
        assert_eq!(once, visited(ray, f64::INFINITY));
        // What the arithmetic can't tell is not decided here.
        assert_eq!(
            visited(
                Ray {
                    direction: Vec3::ZERO,
                    ..ray
                },
                1.0
            ),
            (0..COUNT).collect::<Vec<_>>()
        );
        assert_eq!(
            visited(
                Ray {
                    direction: Vec3::ZERO,
                    ..ray
                },
                -1.0
            )
            .len(),
            1
        );
        assert!(Wide::build(0, 0.0, |_| [Vec3::ZERO; 3]).is_none());
    }

    /// Equal boxes leave the heuristic nothing to choose by.
    #[test]
    fn equal_triangles_build_a_hierarchy_that_ends() {
        let corners = [Vec3::ZERO, Vec3::X, Vec3::Y];
        let wide = Wide::build(5000, 0.0, |_| corners).unwrap();
        let (mut visits, ray) = (
            0,
            Ray {
                origin: Vec3::new(0.2, 0.2, 1.0),
                direction: Vec3::NEG_Z,
            },
        );
        wide.walk::<true>(&ray, f64::INFINITY, |_| {
            visits += 1;
            f64::INFINITY
        });
        assert_eq!(visits, 5000);
    }
}
