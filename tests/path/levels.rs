//! Whatever vector instructions rays are traced with, they find the same.

use super::hierarchy::{numbers, place, waves};
use super::{JOB, lambert, scene, sky, validate};
use rtc::internals::ir::Scene;
use rtc::internals::math::{Vec3, VertexColumn};
use rtc::internals::pipeline::Renderer;
use rtc::internals::plan::{Plan, RuleSet};
use rtc::internals::render::{Hit, Ray, Shape, SimdLevel, World};

const AXES: [[f64; 3]; 3] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];

/// A mesh too large to be kept prepared: its corners of 32 bits are in the leaves if it is not
/// moved. Beside it one that is moved, if asked for, and several of one mesh.
fn sea(is_moved: bool) -> Scene {
    let [x, y, z] = AXES;
    let mut scene = scene(16);
    let mut mesh = waves(130);
    let VertexColumn::Double(positions) = &mesh.positions else {
        panic!("waves are made of 64 bits");
    };
    mesh.positions = VertexColumn::rounded(positions.iter().copied());
    scene.meshes = vec![mesh, waves(20)];
    let origin = if is_moved { [0.1, 0.0, -0.2] } else { [0.0; 3] };
    place(&mut scene, 0, [x, y, z, origin], lambert([0.5; 3]));
    if is_moved {
        place(&mut scene, 1, [y, z, x, [0.3, 0.1, 0.4]], lambert([0.7; 3]));
    }
    scene.environment = sky(1.0);
    scene
}

/// From one point to another.
fn ray(origin: Vec3, target: Vec3) -> Ray {
    Ray {
        origin,
        direction: target - origin,
    }
}

/// Rays from anywhere, then rays of a camera, row by row.
fn rays() -> Vec<Ray> {
    let mut number = numbers(11);
    let mut cube = || Vec3::new(number(), number(), number());
    let from_anywhere = (0..64 * 90).map(|_| ray(cube() * 3.0, cube()));
    let eye = Vec3::new(0.3, 2.0, 2.5);
    let target = |k: i32| Vec3::new(f64::from(k % 64), 0.0, f64::from(k / 64)) / 24.0 - 1.0;
    let of_a_camera = (0..64 * 40).map(|k| ray(eye, target(k).with_y(0.0)));
    from_anywhere.chain(of_a_camera).collect()
}

fn levels() -> impl Iterator<Item = SimdLevel> {
    SimdLevel::NAMES.into_iter().filter_map(SimdLevel::named)
}

/// What each ray meets, and whether anything lies before its target.
type Found = (Vec<Option<Hit>>, Vec<bool>);

fn found(world: &World<Shape>, rays: &[Ray]) -> Found {
    let hits = rays.iter().map(|ray| world.closest_hit(ray)).collect();
    let occluded = |ray: &Ray| world.any_hit(ray, 1.0);
    (hits, rays.iter().map(occluded).collect())
}

#[test]
fn rays_find_the_same_at_all_levels() {
    for is_moved in [false, true] {
        let proof = validate(&sea(is_moved));
        let plan = Plan::new(&proof, RuleSet::NONE);
        let rays = rays();
        let expected = found(&World::prepare_at(&proof, &plan, SimdLevel::best()), &rays);
        let hits = expected.0.iter().flatten().count();
        assert!(hits > 600, "{hits}");
        for level in levels() {
            let world = World::<Shape>::prepare_at(&proof, &plan, level);
            assert!(found(&world, &rays) == expected, "{}", level.name());
        }
        // The nearest hit decides whether anything lies before the target.
        for (hit, occluded) in expected.0.iter().zip(&expected.1) {
            let t = hit.map_or(f64::INFINITY, |hit| hit.t);
            assert!((t - 1.0).abs() < 1e-9 || *occluded == (t < 1.0), "{t}");
        }
    }
}

#[test]
fn pictures_are_the_same_bytes_at_all_levels() {
    let proof = validate(&sea(true));
    let plan = Plan::new(&proof, RuleSet::ALL);
    let films = levels().map(|level| {
        let renderer = Renderer::at_level(&proof, &plan, 2, level).unwrap();
        renderer.render(&JOB, &|_| true).unwrap().image.pixels
    });
    let films: Vec<_> = films.collect();
    assert!(films.len() > 1 && films.windows(2).all(|pair| pair[0] == pair[1]));
}
