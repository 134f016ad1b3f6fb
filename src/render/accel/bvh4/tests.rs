//! Whatever is hit is visited, and little else.

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
        let wide = Bvh4::build(all.len(), 0.0, |item| *all[item as usize].vertices()).unwrap();
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
        let [hits, missed, visits] = (0..rays).into_par_iter().map(judge).reduce(|| [0; 3], add);
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
    let wide = Bvh4::build(all.len(), 0.0, |item| *all[item as usize].vertices()).unwrap();
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
    assert!(Bvh4::build(0, 0.0, |_| [Vec3::ZERO; 3]).is_none());
}

/// Equal boxes leave the heuristic nothing to choose by.
#[test]
fn equal_triangles_build_a_hierarchy_that_ends() {
    let corners = [Vec3::ZERO, Vec3::X, Vec3::Y];
    let wide = Bvh4::build(5000, 0.0, |_| corners).unwrap();
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
