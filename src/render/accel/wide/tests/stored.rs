//! Stored topologies: those of a BVH give the same BVH, forged ones hide no triangle.

use super::*;
use rtc_math::mix;

/// A topology with lists of its own.
#[derive(Clone)]
struct Lists {
    items: Vec<u32>,
    links: Vec<[u32; WIDTH]>,
}

impl Lists {
    fn of(all: &[Triangle]) -> Self {
        let (items, links) = built(all).topology(all.len()).unwrap();
        Self { items, links }
    }

    fn read(&self, all: &[Triangle]) -> Option<WideBvh> {
        let topology = BvhTopology {
            items: &self.items,
            links: &self.links,
        };
        let corners = |item: u32| *all[item as usize].vertices();
        WideBvh::of_topology(topology, SimdLevel::best(), all.len(), 0.0, corners)
    }
}

#[test]
fn a_stored_bvh_is_the_one_that_was_built() {
    for (family, (name, ..)) in FAMILIES.into_iter().enumerate() {
        let all = triangles(family);
        let (first, again) = (built(&all), Lists::of(&all).read(&all).unwrap());
        let nodes = |wide: &WideBvh| format!("{:?}", wide.nodes.rows()).replace("-0.0", "0.0");
        assert_eq!(nodes(&first), nodes(&again), "{name}");
        assert_eq!(
            bytemuck::cast_slice::<_, u32>(first.triangles.rows().as_flattened()),
            bytemuck::cast_slice::<_, u32>(again.triangles.rows().as_flattened()),
            "{name}"
        );
        let rest = |wide: &WideBvh| format!("{} {:?} {:?}", wide.root, wide.unit, wide.frame);
        assert_eq!(rest(&first), rest(&again), "{name}");
    }
    // A single leaf, and triangles that were left out, are not stored.
    let all = triangles(0);
    assert!(built(&all[..3]).topology(3).is_none());
    let copies: Vec<_> = [&all[..], &[all[0]; 9]].concat();
    assert!(built(&copies).topology(copies.len()).is_none());
}

/// Whether rays find all triangles that they hit.
fn hides_none(wide: &WideBvh, all: &[Triangle], seed: u64) -> bool {
    (0..12).all(|index| {
        let ray = aimed(0, all, mix(seed) % 10_000 + index);
        let mut found = Vec::new();
        wide.traverse(&ray, f64::INFINITY, &mut |candidate: Candidate<'_>| {
            found.push(candidate.item);
            f64::INFINITY
        });
        (0_u32..).zip(all).all(|(item, triangle)| {
            let hit = triangle.intersect(&ray, &WatertightRay::new(&ray));
            hit.is_none() || found.contains(&item)
        })
    })
}

/// Changes of one to three numbers, and of lengths: refused, or all triangles are found.
#[test]
fn a_forged_topology_is_refused_or_hides_nothing() {
    let all = triangles(0);
    let sound = Lists::of(&all);
    let (mut refused, mut taken) = (0, 0);
    for seed in 0..6000_u64 {
        let mut forged = sound.clone();
        let mut next = seed << 8;
        let mut random = |below: usize| {
            next += 1;
            (mix(next) % below as u64) as usize
        };
        for _ in 0..1 + seed % 3 {
            let (nodes, items) = (forged.links.len(), forged.items.len());
            let node = random(nodes);
            match random(8) {
                0 => forged.links[node][random(WIDTH)] = random(nodes + 2) as u32,
                1 => forged.links[node][random(WIDTH)] = mix(seed) as u32,
                2 => forged.links[node][random(WIDTH)] = LEAF | random(4 * items + 8) as u32,
                3 => forged.links[node][random(WIDTH)] = NONE,
                4 => forged.links[node].swap(random(WIDTH), random(WIDTH)),
                5 => forged.items.swap(random(items), random(items)),
                6 => forged.items[random(items)] = random(items + 2) as u32,
                _ => forged.links.extend([[NONE; WIDTH]]),
            }
        }
        match forged.read(&all) {
            None => refused += 1,
            Some(wide) => {
                taken += 1;
                assert!(hides_none(&wide, &all, seed), "{seed}");
            }
        }
    }
    assert!(refused > 2000 && taken > 500, "{refused} {taken}");
    // Lists that end early, and none.
    for short in 0..sound.links.len() {
        let links = sound.links[..short].to_vec();
        let items = sound.items.clone();
        assert!(Lists { items, links }.read(&all).is_none());
    }
    let items = sound.items[1..].to_vec();
    let links = sound.links.clone();
    assert!(Lists { items, links }.read(&all).is_none());
}

/// As deep as a stack holds, and one level deeper.
#[test]
fn a_topology_deeper_than_the_stack_is_refused() {
    let all = triangles(0);
    // Each level has three leaves and a node, the last one eight leaves, all of one triangle.
    let leaf = |row: usize| LEAF | (row as u32) << 2;
    let mut levels = Vec::new();
    for depth in [MAX_DEPTH - 1, MAX_DEPTH] {
        let count = 3 * depth + 8;
        let part = &all[..count];
        let mut links: Vec<[u32; WIDTH]> = (0..depth)
            .map(|node| {
                let mut links = [NONE; WIDTH];
                (0..3).for_each(|lane| links[lane] = leaf(3 * node + lane));
                links[3] = node as u32 + 1;
                links
            })
            .collect();
        links.push(std::array::from_fn(|lane| leaf(3 * depth + lane)));
        let items = (0..count as u32).collect();
        levels.push(
            Lists { items, links }
                .read(part)
                .map(|wide| hides_none(&wide, part, 1)),
        );
    }
    assert_eq!(levels, [Some(true), None]);
}
