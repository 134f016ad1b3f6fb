//! Triangles that are the same, or have the same boxes.

use super::*;

/// How many triangles of a BVH a ray along −z visits, and the lowest of them.
fn visited(count: u32, corners: impl Fn(u32) -> [Vec3; 3] + Sync) -> (usize, Option<u32>) {
    let wide = WideBvh::build(
        BvhBuilders::All,
        SimdLevel::best(),
        count as usize,
        0.0,
        corners,
    )
    .unwrap();
    let (mut visits, mut lowest) = (0, None);
    let ray = Ray {
        origin: Vec3::new(0.2, 0.2, 1.0),
        direction: Vec3::NEG_Z,
    };
    wide.traverse(&ray, f64::INFINITY, &mut |candidate: Candidate<'_>| {
        visits += 1;
        lowest = Some(lowest.map_or(candidate.item, |own: u32| own.min(candidate.item)));
        f64::INFINITY
    });
    (visits, lowest)
}

/// However many there are, the first of them is visited alone: no other can be seen.
#[test]
fn equal_triangles_are_visited_once() {
    let equal = [Vec3::ZERO, Vec3::X, Vec3::Y];
    for count in [5000, 10_000, 20_000] {
        assert_eq!(visited(count, |_| equal), (1, Some(0)));
        // Among others, from the seventh on, and with zeros of both signs.
        let mixed = |item: u32| match item {
            0..7 => [Vec3::X, Vec3::Y, Vec3::Z].map(|at| at + Vec3::splat(f64::from(item) + 3.0)),
            item if item % 2 == 0 => [-Vec3::ZERO, Vec3::X, Vec3::Y],
            _ => equal,
        };
        assert_eq!(visited(count, mixed), (1, Some(7)));
    }
}

/// Equal boxes give the heuristic no choice; the triangles in them differ.
#[test]
fn equal_boxes_build_a_hierarchy_that_ends() {
    let corners = |item: u32| {
        let inside = f64::from(item + 1) / 6000.0;
        [Vec3::ZERO, Vec3::X, Vec3::new(inside, 1.0, 0.0)]
    };
    let (visits, lowest) = visited(5000, corners);
    assert!(visits > 2500 && lowest.is_some(), "{visits}");
}
