//! Traversal visits every triangle that is hit, and few others.

mod copies;
mod stored;

use super::*;
use crate::ray::Ray;
use crate::sampler::PathVertexKey;
use crate::shape::triangle::{Triangle, WatertightRay};
use rayon::prelude::*;

/// Triangles in each BVH.
const COUNT: u32 = 96;

/// The generators of triangles and rays: scale and position, distance of the eye, and special
/// cases.
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
        let key = PathVertexKey::new([u32::try_from(family).unwrap(), 7], index);
        let frame =
            |k: u64| Vec3::new(key.uniform(k), key.uniform(k + 1), key.uniform(k + 2)) * 2.0 - 1.0;
        let (a, width) = (frame(0), if name == "slivers" { 1e-7 } else { 0.3 });
        let corners = [a, a + frame(3) * 0.3, a + frame(3) * 0.1 + frame(6) * width];
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
    let key = PathVertexKey::new([u32::try_from(family).unwrap(), 11], index);
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

/// The number of rays, or the requested one.
fn ray_count(usual: u64) -> u64 {
    let requested = std::env::var("RTC_RAYS").ok();
    requested
        .and_then(|count| count.parse().ok())
        .unwrap_or(usual)
}

fn built(all: &[Triangle]) -> WideBvh {
    let corners = |item: u32| *all[item as usize].vertices();
    WideBvh::build(BvhBuilders::All, SimdLevel::best(), all.len(), 0.0, corners).unwrap()
}

/// Visits all triangles whose boxes are hit.
struct Boxed<F>(F);

impl<F: FnMut(u32) -> f64> TriangleVisitor for Boxed<F> {
    const CULLS: bool = false;

    fn visit(&mut self, candidate: Candidate<'_>) -> f64 {
        self.0(candidate.item)
    }
}

/// Visits triangles that may be hit, and records the certain hits.
#[derive(Default)]
struct Sure {
    maybe: Vec<u32>,
    certain: Vec<u32>,
}

impl TriangleVisitor for Sure {
    const IS_CERTAIN: bool = true;

    fn visit(&mut self, candidate: Candidate<'_>) -> f64 {
        self.maybe.push(candidate.item);
        2.0
    }

    fn accepts_certain(&mut self, item: u32) -> bool {
        self.certain.push(item);
        false
    }
}

#[test]
fn what_is_hit_for_sure_is_hit_before_the_end_of_the_ray() {
    for (family, (name, ..)) in FAMILIES.into_iter().enumerate() {
        let all = triangles(family);
        let wide = built(&all);
        let intersect4 = |index: u64| {
            let ray = aimed(family, &all, index);
            // The ray ends where it was aimed at, a little before, and beyond.
            let aim = if name == "along the axes" { 4.0 } else { 1.0 };
            let t_max = aim * [1.0, 0.999_999, 2.0][(index / 7) as usize % 3];
            let mut found = Sure::default();
            wide.traverse(&ray, t_max, &mut found);
            let is_hit = |item: &&u32| {
                let t = all[**item as usize].intersect(&ray, &WatertightRay::new(&ray));
                t.is_some_and(|t| t < t_max)
            };
            let wrong = found.certain.iter().filter(|item| !is_hit(item)).count() as u64;
            let hits = found.maybe.iter().filter(is_hit).count() as u64;
            [hits, found.certain.len() as u64, wrong]
        };
        let add = |a: [u64; 3], b: [u64; 3]| [a[0] + b[0], a[1] + b[1], a[2] + b[2]];
        let [hits, certain_hits, wrong] = (0..ray_count(60_000))
            .into_par_iter()
            .map(intersect4)
            .reduce(|| [0; 3], add);
        println!("| sure of | {name} | {certain_hits} of {hits} | {wrong} wrong |");
        assert_eq!(wrong, 0, "{name}");
        assert!(
            name == "slivers" || 3 * certain_hits > hits,
            "{name}: {certain_hits} of {hits}"
        );
    }
}

/// The visits of a ray, in order, and its certain hits.
type Visits = (Vec<u32>, Vec<u32>);

#[test]
fn all_levels_visit_the_same_in_the_same_order() {
    let all = triangles(0);
    let rays: Vec<Ray> = (0..3000).map(|index| aimed(0, &all, index)).collect();
    let mut expected: Option<Vec<Visits>> = None;
    for level in SimdLevel::NAMES.into_iter().filter_map(SimdLevel::named) {
        let corners = |item: u32| *all[item as usize].vertices();
        let wide = WideBvh::build(BvhBuilders::All, level, all.len(), 0.0, corners).unwrap();
        let alone = |ray: &Ray| {
            let mut found = Sure::default();
            wide.traverse(ray, 2.0, &mut found);
            (found.maybe, found.certain)
        };
        let alone: Vec<_> = rays.iter().map(alone).collect();
        let expected = expected.get_or_insert_with(|| alone.clone());
        assert_eq!(*expected, alone, "{}", level.name());
    }
}

/// 32-bit corners are in the leaves exactly; others are read elsewhere.
#[test]
fn corners_are_exact_or_not_there() {
    let single = |item: u32| {
        let key = PathVertexKey::new([1, 9], item.into());
        let number = |k: u64| f64::from((key.uniform(k) * 100.0 - 30.0) as f32);
        [0, 3, 6].map(|k| Vec3::new(number(k), number(k + 1), number(k + 2)))
    };
    let double = |item: u32| single(item).map(|corner| corner + Vec3::splat(0.1));
    let far = |item: u32| single(item).map(|corner| corner + Vec3::splat(1_048_576.0));
    let visited = |corners: &(dyn Fn(u32) -> [Vec3; 3] + Sync)| {
        let wide = WideBvh::build(BvhBuilders::All, SimdLevel::best(), 900, 0.0, corners).unwrap();
        let direction = corners(5)[0];
        let ray = Ray {
            origin: Vec3::ZERO,
            direction,
        };
        let mut all = Vec::new();
        wide.traverse(&ray, f64::INFINITY, &mut |candidate: Candidate<'_>| {
            all.push((candidate.item, candidate.corners()));
            f64::INFINITY
        });
        assert!(all.iter().any(|(item, _)| *item == 5));
        all
    };
    for (item, corners) in visited(&single) {
        assert_eq!(corners, Some(single(item)));
    }
    assert!(
        visited(&double)
            .iter()
            .all(|(_, corners)| corners.is_none())
    );
    assert!(visited(&far).iter().all(|(_, corners)| corners.is_none()));
}

#[test]
fn whatever_is_hit_is_visited_and_little_else() {
    let rays = ray_count(20_000);
    for (family, (name, ..)) in FAMILIES.into_iter().enumerate() {
        let all = triangles(family);
        let wide = built(&all);
        let intersect4 = |index: u64| {
            let ray = aimed(family, &all, index);
            let watertight = WatertightRay::new(&ray);
            let (mut hits, mut missed, mut visits) = (0, 0, 0);
            for (item, triangle) in (0..).zip(&all) {
                let Some(t) = triangle.intersect(&ray, &watertight) else {
                    continue;
                };
                let (mut culled, mut boxed) = (false, false);
                // Even with that hit as the end of the ray.
                wide.traverse(&ray, t, &mut |other: Candidate<'_>| {
                    (culled, visits) = (culled || other.item == item, visits + 1);
                    t
                });
                wide.traverse(
                    &ray,
                    t,
                    &mut Boxed(|other| {
                        boxed |= other == item;
                        t
                    }),
                );
                (hits, missed) = (hits + 1, missed + u64::from(!culled) + u64::from(!boxed));
            }
            [hits, missed, visits]
        };
        let add = |a: [u64; 3], b: [u64; 3]| [a[0] + b[0], a[1] + b[1], a[2] + b[2]];
        let [hits, missed, visits] = (0..rays)
            .into_par_iter()
            .map(intersect4)
            .reduce(|| [0; 3], add);
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
    let wide = built(&all);
    let visited = |ray: Ray, answer: f64| {
        let mut visited = Vec::new();
        let visit = |item| {
            visited.push(item);
            answer
        };
        wide.traverse(&ray, f64::INFINITY, &mut Boxed(visit));
        visited.sort_unstable();
        visited
    };
    let ray = aimed(0, &all, 0);
    assert_eq!(visited(ray, -1.0).len(), 1);
    let mut once = visited(ray, f64::INFINITY);
    once.dedup();
    assert_eq!(once, visited(ray, f64::INFINITY));
    // Cases that the arithmetic cannot decide are not decided here.
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
    assert!(
        WideBvh::build(
            BvhBuilders::All,
            SimdLevel::best(),
            0,
            0.0,
            |_| [Vec3::ZERO; 3]
        )
        .is_none()
    );
}

/// A mesh builds its BVH for the first ray that needs it, while others wait: a thread that helped
/// meanwhile could be handed a ray that waits for the same mesh.
#[test]
fn a_hierarchy_built_amid_the_work_of_all_threads_ends() {
    let corners = |item: u32| {
        let key = PathVertexKey::new([3, 17], item.into());
        [0, 3, 6].map(|k| Vec3::new(key.uniform(k), key.uniform(k + 1), key.uniform(k + 2)))
    };
    let one = WideBvh::build(BvhBuilders::One, SimdLevel::best(), 40_000, 0.0, corners).unwrap();
    let all = WideBvh::build(BvhBuilders::All, SimdLevel::best(), 40_000, 0.0, corners).unwrap();
    assert_eq!(one.root, all.root);
    assert!(
        one.nodes
            .rows()
            .as_flattened()
            .iter()
            .map(|x| x.to_bits())
            .eq(all.nodes.rows().as_flattened().iter().map(|x| x.to_bits()))
    );
    let shared = std::sync::OnceLock::new();
    let requested = (0..64).into_par_iter().filter(|_| {
        let build = || WideBvh::build(BvhBuilders::One, SimdLevel::best(), 20_000, 0.0, corners);
        shared.get_or_init(build).is_some()
    });
    assert_eq!(requested.count(), 64);
}

/// A triangle takes its row of 40 bytes, and its share of the nodes.
#[test]
fn a_triangle_of_a_surface_takes_few_bytes() {
    const SIDE: u32 = 100;
    let corners = |item: u32| {
        let (row, column, half) = (item / 2 / SIDE, item / 2 % SIDE, item % 2);
        let corner = |across: u32, down: u32| {
            let (x, y) = (f64::from(column + across), f64::from(row + down));
            Vec3::new(x, y, f64::from((column + across) * (row + down) % 7) * 0.1)
        };
        [corner(half, half), corner(1, 0), corner(0, 1)]
    };
    let count = 2 * (SIDE * SIDE) as usize;
    let wide = WideBvh::build(BvhBuilders::One, SimdLevel::best(), count, 0.0, corners).unwrap();
    let bytes = size_of_val(wide.triangles.rows()) + size_of_val(wide.nodes.rows());
    let each = bytes as f64 / count as f64;
    println!("{each:.1} bytes a triangle");
    assert!(each < 60.0, "{each}");
}
