//! Cases that are decisions: which code a fault gets, and what must never happen.

use super::random::Random;
use super::scenes::{check, plane, scene, sphere, triangle, validated, white, world};
use super::truth::{Report, all, id};
use rtc::internals::diag::codes;
use rtc::internals::ir::{self, Light, Material, MaterialId, Phong, PointLight};
use rtc::internals::math::{CameraBasisError, Vec3, camera_basis, fallback_up};
use rtc::internals::plan::{Plan, RuleSet};
use rtc::internals::render::{Film, Ray, RenderSelection, Values, render};

fn film(scene: &ir::Scene) -> Film {
    let job = RenderSelection {
        values: Values::Linear,
        ..RenderSelection::default()
    };
    let scene = validated(scene);
    render(&scene, &Plan::new(&scene, RuleSet::ALL), &job, &|_| true).unwrap()
}

fn light(position: [f64; 3], color: [f64; 3]) -> Light {
    Light::Point(PointLight {
        position,
        color,
        radius: 0.0,
    })
}

/// Every case of the files is of a kind that a test runs; decisions have a test each, below.
#[test]
fn every_case_is_of_a_known_kind() {
    const KINDS: [&str; 11] = [
        "aperture",
        "camera_basis",
        "chain",
        "intersect",
        "mesh_any",
        "mesh_leak",
        "mirror_box",
        "occluded",
        "onb",
        "phong_pow",
        "refract",
    ];
    let mut report = Report::default();
    for case in &all() {
        let kind = case["kind"].as_str().unwrap();
        if !KINDS.contains(&kind) {
            report.line(id(case), kind == "policy", kind);
        }
    }
    report.finish();
}

/// cam-02, cam-05, cam-06.
#[test]
fn vectors_that_give_no_camera_are_told_apart() {
    let basis = |eye, center, up| camera_basis(eye, center, up).unwrap_err();
    let point = Vec3::new(1.0, 2.0, 3.0);
    assert_eq!(basis(point, point, Vec3::Y), CameraBasisError::ZeroGaze);
    assert_eq!(
        basis(Vec3::Z, Vec3::ZERO, Vec3::ZERO),
        CameraBasisError::ZeroUp
    );
    assert_eq!(
        basis(Vec3::Z * 10.0, Vec3::ZERO, Vec3::Z),
        CameraBasisError::Parallel
    );
    let up = fallback_up(Vec3::Z * -10.0, Vec3::Z);
    assert_eq!(
        camera_basis(Vec3::Z * 10.0, Vec3::ZERO, up),
        Ok((Vec3::X, Vec3::Y))
    );
}

/// sph-19.
#[test]
fn radii_that_are_none_are_refused() {
    for (radius, code) in [
        (0.0, &codes::RADIUS),
        (-1.0, &codes::RADIUS),
        (f64::NAN, &codes::NOT_FINITE),
        (f64::INFINITY, &codes::NOT_FINITE),
    ] {
        assert_eq!(
            check(&scene([sphere([0.0; 3], radius)])).unwrap_err(),
            [code.id],
            "radius {radius}"
        );
    }
}

/// apt-08.
#[test]
fn apertures_that_are_none_are_refused() {
    let cases = [
        (0, 1.0, &codes::ZERO_COUNT),
        (1, -1.0, &codes::NEGATIVE),
        (1, f64::NAN, &codes::NOT_FINITE),
    ];
    for (samples, radius, code) in cases {
        let mut scene = scene([]);
        scene.camera.lens = ir::Lens { radius, samples };
        assert_eq!(check(&scene).unwrap_err(), [code.id]);
    }
}

/// phg-08.
#[test]
fn exponents_that_are_none_are_refused() {
    let cases = [
        (-1.0, &codes::NEGATIVE_EXPONENT),
        (f64::NAN, &codes::NOT_FINITE),
        (f64::INFINITY, &codes::NOT_FINITE),
    ];
    for (n, code) in cases {
        let mut scene = scene([]);
        let phong = scene.materials[0].phong_mut().unwrap();
        phong.n = n;
        assert_eq!(check(&scene).unwrap_err(), [code.id], "n = {n}");
    }
}

/// rec-03: two parallel mirrors with ks = 0.5 and an ambient term of 1 sum to Σ ks^i, i = 0 …
/// depth.
#[test]
fn parallel_mirrors_sum_their_bounces() {
    let mirror = Material::Phong(Phong {
        ka: 1.0,
        kd: 0.0,
        ks: 0.5,
        n: 1e6,
        ..phong()
    });
    let mut scene = scene([
        plane([0.0, 0.0, -1.0], [0.0, 0.0, 1.0]),
        plane([0.0, 0.0, 20.0], [0.0, 0.0, -1.0]),
    ]);
    scene.materials = vec![mirror];
    scene.settings.max_depth = 50;
    scene.lights = vec![light([0.0, 0.0, -5.0], [1.0; 3])];
    let sum = (0..=50).map(|i| 0.5_f64.powi(i)).sum::<f64>();
    let film = film(&scene);
    assert!(
        (film.image.pixels[0][0] - sum).abs() < 1e-14,
        "{:?} instead of {sum}",
        film.image.pixels[0]
    );
    assert_eq!(film.counts.secondary(), 50);
}

/// rec-04: a hundred thousand bounces in a mirror box end, escape nowhere, and stay finite.
#[test]
fn a_hundred_thousand_bounces_end() {
    let walls = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    let mut scene = scene(
        walls
            .into_iter()
            .flat_map(|n| [plane(n, n), plane(n.map(|c| -c), n)]),
    );
    scene.materials = vec![Material::Phong(Phong {
        ka: 1e-9,
        kd: 0.0,
        ks: 1.0,
        ..phong()
    })];
    scene.camera.eye = [0.1, -0.2, 0.3];
    scene.camera.center = [1.1, 0.418, 0.714];
    (scene.camera.right, scene.camera.up) = ([0.0, 0.0, 0.1], [0.0, 0.1, 0.0]);
    scene.settings.max_depth = 100_000;
    scene.lights = vec![light([0.0; 3], [1.0; 3])];
    let film = film(&scene);
    assert_eq!(film.counts.secondary(), 100_000);
    assert!(film.image.pixels[0].iter().all(|value| value.is_finite()));
}

/// shd-06: a light exactly at the point that is shaded adds its ambient term only.
#[test]
fn a_light_at_the_point_itself_adds_ambient_only() {
    for shadows in [false, true] {
        let mut scene = scene([plane([0.0; 3], [0.0, 0.0, 1.0])]);
        scene.settings.shadows = shadows;
        scene.materials = vec![Material::Phong(Phong {
            ka: 0.25,
            kd: 0.5,
            ks: 1.0,
            n: 0.0,
            ..phong()
        })];
        scene.lights = vec![light([0.0; 3], [1.0; 3])];
        assert_eq!(
            film(&scene).image.pixels[0],
            [0.25; 3],
            "shadows: {shadows}"
        );
    }
}

/// shd-07: of two coincident spheres the first is seen, and neither darkens the other.
#[test]
fn of_coincident_spheres_the_first_is_seen_and_lit() {
    let mut scene = scene([sphere([0.0; 3], 1.0), sphere([0.0; 3], 1.0)]);
    scene.materials = [[1.0, 0.0, 0.0], [0.0, 0.0, 1.0]]
        .map(|color| Material::Phong(Phong { color, ..phong() }))
        .to_vec();
    scene.surfaces[1].material = MaterialId(1);
    scene.lights = vec![light([0.0, 0.0, 10.0], [1.0; 3])];
    scene.camera.eye = [0.0, 0.0, 5.0];
    (scene.camera.right, scene.camera.up) = ([0.01, 0.0, 0.0], [0.0, 0.01, 0.0]);
    scene.camera.size = [64, 64];
    for pixel in film(&scene).image.pixels {
        assert!(
            pixel[2] == 0.0 && (pixel[0] > 0.0 || pixel == [0.0; 3]),
            "{pixel:?}"
        );
    }
}

fn phong() -> Phong {
    let Material::Phong(phong) = white() else {
        unreachable!()
    };
    phong
}

/// bvh-05: triangles with one centroid build a hierarchy that ends, and each can be hit.
#[test]
fn triangles_with_one_centroid_are_all_found() {
    let size = |k: u32| 1.0 + f64::from(k);
    let shapes = (0..20_000).map(|k| {
        let (r, z) = (size(k), f64::from(k) * 1e-4);
        triangle([[-r, -r, z], [r, -r, z], [0.0, 2.0 * r, z]])
    });
    let world = world(shapes);
    for k in [0_u32, 1, 77, 9_999, 19_999] {
        let ray = Ray {
            origin: Vec3::new(0.0, 2.0 * size(k) - 1.0, -1.0),
            direction: Vec3::Z,
        };
        let hit = world.closest_hit(&ray).unwrap();
        assert_eq!(hit.surface.index(), k as usize);
    }
}

/// bvh-02 and bvh-03 for triangles: a vertex that is not finite is refused by name.
#[test]
fn vertices_that_are_not_finite_are_refused() {
    for value in [f64::NAN, f64::INFINITY] {
        let bad = triangle([[0.0; 3], [1.0, 0.0, 0.0], [0.0, value, 0.0]]);
        assert_eq!(check(&scene([bad])).unwrap_err(), [codes::NOT_FINITE.id]);
    }
}

/// bvh-06: rays that are none hit nothing.
#[test]
fn rays_that_are_none_miss() {
    let mut random = Random::new(6);
    let shapes = (0..100).map(|_| sphere(random.cube().to_array(), 0.3));
    let world = world(shapes.chain([
        plane([0.0; 3], [0.0, 1.0, 0.0]),
        triangle([[0.0; 3], [1.0; 3], [0.0, 1.0, 0.0]]),
    ]));
    for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        for axis in 0..3 {
            let mut broken = Vec3::new(0.1, 0.2, 0.3);
            broken[axis] = bad;
            assert_eq!(
                world.closest_hit(&Ray {
                    origin: broken,
                    direction: Vec3::Z
                }),
                None
            );
            assert_eq!(
                world.closest_hit(&Ray {
                    origin: Vec3::ONE,
                    direction: broken
                }),
                None
            );
        }
    }
    assert_eq!(
        world.closest_hit(&Ray {
            origin: Vec3::ONE,
            direction: Vec3::ZERO
        }),
        None
    );
}

/// bvh-07: worlds of nothing and of one.
#[test]
fn worlds_of_none_and_of_one() {
    let ray = Ray {
        origin: Vec3::Z * 5.0,
        direction: -Vec3::Z,
    };
    assert_eq!(world([]).closest_hit(&ray), None);
    assert_eq!(
        world([sphere([0.0; 3], 1.0)]).closest_hit(&ray).unwrap().t,
        4.0
    );
}
