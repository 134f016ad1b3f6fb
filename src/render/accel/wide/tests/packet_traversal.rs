//! Packet traversal visits every triangle that one of its rays hits.

use super::*;

/// Eight rays from one point towards one target.
fn side_by_side(family: usize, all: &[Triangle], index: u64) -> [(Ray, f64, Sure); 8] {
    let mut ray = aimed(family, all, index);
    if FAMILIES[family].0 == "along the axes" {
        // To the target in one length, as in all families.
        ray.direction *= 4.0;
    }
    let key = Key::new([13, 5], index);
    let spread = [0.0, 1e-3, 0.1][(index / 2) as usize % 3] * ray.direction.length();
    [0, 3, 6, 9, 12, 15, 18, 21].map(|k| {
        let aside = Vec3::new(key.uniform(k), key.uniform(k + 1), key.uniform(k + 2)) - 0.5;
        let direction = ray.direction + aside * spread;
        (Ray { direction, ..ray }, 2.0, Sure::default())
    })
}

#[test]
fn rays_together_visit_whatever_they_hit_at_all_levels_the_same() {
    for (family, (name, ..)) in FAMILIES.into_iter().enumerate() {
        let all = triangles(family);
        let corners = |item: u32| *all[item as usize].vertices();
        let levels = SimdLevel::NAMES.into_iter().filter_map(SimdLevel::named);
        let built = |level| Wide::build(Builders::All, level, all.len(), 0.0, corners).unwrap();
        let wides: Vec<_> = levels.map(built).collect();
        let intersect4 = |index: u64| {
            let [mut hits, mut wrong] = [0, 0];
            let mut expected: Option<Vec<Visits>> = None;
            for wide in &wides {
                let mut rays = side_by_side(family, &all, index);
                wide.traverse_packets(&mut rays);
                for (ray, t_max, found) in &rays {
                    let watertight = WatertightRay::new(ray);
                    for (item, triangle) in (0..).zip(&all) {
                        let t = triangle.intersect(ray, &watertight);
                        let is_hit = t.is_some_and(|t| t < *t_max);
                        let is_missing = is_hit && !found.maybe.contains(&item);
                        let is_false = !is_hit && found.certain.contains(&item);
                        hits += u64::from(is_hit);
                        wrong += u64::from(is_missing || is_false);
                    }
                }
                let visits = rays
                    .map(|(_, _, found)| (found.maybe, found.certain))
                    .to_vec();
                wrong += u64::from(*expected.get_or_insert_with(|| visits.clone()) != visits);
            }
            [hits, wrong]
        };
        let add = |a: [u64; 2], b: [u64; 2]| [a[0] + b[0], a[1] + b[1]];
        let rays = ray_count(600);
        let [hits, wrong] = (0..rays)
            .into_par_iter()
            .map(intersect4)
            .reduce(|| [0; 2], add);
        assert!(hits > rays && wrong == 0, "{name}: {wrong} of {hits}");
    }
}

/// A ray among seven that miss the cube, that have ended, or that go another way.
#[test]
fn rays_that_do_not_go_along_find_what_they_find_alone() {
    let all = triangles(0);
    let wide = built(&all);
    for index in 0..300 {
        let mut rays = side_by_side(0, &all, index);
        for (k, (ray, t_max, _)) in rays.iter_mut().enumerate() {
            match (k as u64 + index) % 7 {
                0 => ray.origin += Vec3::splat(1e3),
                1 => *t_max = -1.0,
                2 if index % 2 == 0 => ray.direction = -ray.direction,
                3 if index % 3 == 0 => ray.direction = Vec3::ZERO,
                _ => {}
            }
        }
        let alone = rays.each_ref().map(|(ray, t_max, _)| {
            let mut found = Sure::default();
            wide.traverse(ray, *t_max, &mut found);
            found.maybe.sort_unstable();
            found.maybe
        });
        wide.traverse_packets(&mut rays);
        for ((ray, t_max, found), alone) in rays.iter_mut().zip(alone) {
            found.maybe.sort_unstable();
            let t = |item: u32| all[item as usize].intersect(ray, &WatertightRay::new(ray));
            let is_hit = |item: &u32| t(*item).is_some_and(|t| t < *t_max);
            let hits = |items: Vec<u32>| items.into_iter().filter(is_hit).collect::<Vec<_>>();
            assert_eq!(
                hits(std::mem::take(&mut found.maybe)),
                hits(alone),
                "{ray:?}"
            );
        }
    }
}
