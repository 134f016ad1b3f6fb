//! Many triangles: rays through shared edges hit, and the hierarchy finds what brute force finds,
//! bit for bit.

use super::mesh::Mesh;
use super::random::Random;
use super::scenes::{sphere, triangle, world};
use super::truth::{Report, cases, id, number, relative_error, vector};
use rtc::internals::math::Vec3;
use rtc::internals::render::{Hit, Intersect, Ray, WatertightRay, World};
use serde_json::Value;

#[test]
fn rays_through_shared_edges_hit() {
    let mut report = Report::default();
    for case in cases("mesh_any") {
        let corner = |k: &Value| {
            vector(&case["input"]["vertices"][k.as_str().unwrap().parse::<usize>().unwrap()])
        };
        let corners = |t: &Value| [0, 1, 2].map(|k| corner(&t[k]).to_array());
        let triangles = case["input"]["triangles"].as_array().unwrap();
        let world = world(triangles.iter().map(|t| triangle(corners(t))));
        for (k, ray) in case["input"]["rays"].as_array().unwrap().iter().enumerate() {
            let hit = world.closest_hit(&Ray {
                origin: vector(&ray["o"]),
                direction: vector(&ray["d"]),
            });
            let first = case["expect"]
                .get("prim")
                .and_then(|prim| prim[k].as_str()?.parse::<usize>().ok());
            let error = hit.map_or(f64::INFINITY, |hit| {
                relative_error(hit.t, &case["expect"]["t"][k])
            });
            let right_one =
                first.is_none_or(|first| hit.is_some_and(|hit| hit.surface.index() == first));
            let passed = error <= number(&case["tol"]["t_u"]) && right_one;
            report.line(
                &format!("{}.{k}", id(&case)),
                passed,
                &format!("t {error:.2} u"),
            );
        }
    }
    report.finish();
}

fn brute_force(world: &World, ray: &Ray) -> Option<Hit> {
    let watertight = WatertightRay::new(ray);
    let hits = world.surfaces.entries().filter_map(|(surface, s)| {
        s.shape
            .intersect(ray, &watertight, f64::INFINITY)
            .map(|(t, prim_id)| Hit {
                t,
                surface,
                prim_id,
            })
    });
    hits.reduce(|best, hit| if hit.t < best.t { hit } else { best })
}

#[test]
fn the_hierarchy_finds_what_brute_force_finds() {
    let mut random = Random::new(4242);
    let icosphere = Mesh::icosphere(2).world();
    let slivers = world((0..300).map(|_| {
        let (a, b) = (random.cube(), random.cube());
        triangle([a, b, (a + b) / 2.0 + random.cube() * 1e-9].map(|v| v.to_array()))
    }));
    let grid = world(
        (0..16)
            .flat_map(|x| {
                (0..16).map(move |z| (f64::from(x) / 8.0 - 1.0, f64::from(z) / 8.0 - 1.0))
            })
            .map(|(x, z)| triangle([[x, 0.0, z], [x + 0.125, 0.0, z], [x, 0.0, z + 0.125]])),
    );
    let sizes = world((0..200).map(|k| {
        let size = if k % 2 == 0 { 1e-6 } else { 1e6 };
        sphere(
            (random.cube() * if k % 2 == 0 { 1.0 } else { 3e6 }).to_array(),
            size * (0.1 + random.uniform()),
        )
    }));
    let few = (0..8)
        .map(|_| [random.cube(), random.cube(), random.cube()].map(|v| v.to_array()))
        .collect::<Vec<_>>();
    let coincident = world((0..12).flat_map(|_| &few).map(|corners| triangle(*corners)));
    for (name, world) in [
        ("icosphere", icosphere),
        ("slivers", slivers),
        ("grid", grid),
        ("sizes", sizes),
        ("coincident", coincident),
    ] {
        for k in 0..20_000 {
            let (origin, mut target) = (random.cube() * 2.0, random.cube());
            if name == "coincident" {
                // Corners lie on their boxes, where a rounded t and the end of a slab differ.
                target = Vec3::from_array(few[random.below(few.len())][k % 3]);
            }
            let mut direction = target - origin;
            if k % 3 == 0 && name != "coincident" {
                direction[k % 2] = 0.0;
            }
            let ray = Ray { origin, direction };
            assert_eq!(
                world.closest_hit(&ray),
                brute_force(&world, &ray),
                "{name}, ray {k}: {ray:?}"
            );
        }
    }
}
