//! Layers beside the colours against closed forms, with both integrators and on any threads.

use super::*;
use rtc::internals::image::PixelLayers;
use rtc::internals::pipeline::Renderer;
use rtc::internals::render::{AnyWorld, Aov, Crop};

const ALL: [Aov; 6] = [
    Aov::Albedo,
    Aov::Normal,
    Aov::Depth,
    Aov::Uv,
    Aov::Instance,
    Aov::Position,
];
const WHOLE: Crop = Crop {
    x: 0,
    y: 0,
    width: 16,
    height: 16,
};

fn of(crop: Crop) -> RenderSelection<'static> {
    RenderSelection {
        crop: Some(crop),
        ..RenderSelection::default()
    }
}

fn layers(scene: &Scene, wanted: &[Aov], crop: Crop, threads: usize) -> PixelLayers {
    let proof = validate(scene);
    Renderer::new(&proof, &Plan::new(&proof, RuleSet::ALL), threads)
        .unwrap()
        .layers(wanted, &of(crop), &|| true)
        .unwrap()
}

/// One layer, pixel by pixel, the channels it lacks as zeros.
fn layer(scene: &Scene, aov: Aov) -> Vec<[f64; 3]> {
    let PixelLayers { names, values } = layers(scene, &[aov], WHOLE, 1);
    let pixel = |pixel: &[f32]| [0, 1, 2].map(|k| pixel.get(k).copied().map_or(0.0, f64::from));
    values.chunks(names.len()).map(pixel).collect()
}

fn near(a: [f64; 3], b: [f64; 3]) -> bool {
    (0..3).all(|k| (a[k] - b[k]).abs() < 1e-5)
}

/// A ball of radius 0.75 in front of a square with texture coordinates, both of an own colour.
fn ball_and_square(samples: u32) -> Scene {
    let mut scene = scene(samples);
    add_square(&mut scene, -1.0, 0.9, lambert([0.25, 0.5, 0.75]));
    add_sphere(&mut scene, [0.0; 3], 0.75, lambert([0.9, 0.1, 0.2]));
    scene.environment = sky(1.0);
    scene
}

/// The same of Phong's materials, with a ray through the middle of each pixel.
fn phong() -> Scene {
    let mut scene = ball_and_square(1);
    scene.settings.mode = Mode::Phong;
    scene.environment = None;
    let colors = [[0.25, 0.5, 0.75], [0.9, 0.1, 0.2]];
    scene.materials = colors
        .map(|color| {
            Material::Phong(Phong {
                color,
                kd: 0.5,
                ka: 0.1,
                ..Phong::MATT
            })
        })
        .into();
    scene
}

#[test]
fn normals_depths_and_places_of_a_sphere_are_those_of_the_closed_form() {
    let scene = phong();
    let [normals, depths, places, albedos, instances] = [
        Aov::Normal,
        Aov::Depth,
        Aov::Position,
        Aov::Albedo,
        Aov::Instance,
    ]
    .map(|aov| layer(&scene, aov));
    let mut balls = 0;
    for index in 0..256 {
        let [x, y] = [index % 16, index / 16].map(|at| (f64::from(at) - 7.5) * 0.125);
        // |(0, 0, 4) + t·(x, −y, −4)| = 0.75.
        let (a, b, c) = (x * x + y * y + 16.0, -16.0, 16.0 - 0.5625);
        let index = index as usize;
        if b * b - a * c < 0.0 {
            continue;
        }
        let t = (-b - f64::sqrt(b * b - a * c)) / a;
        let point = [t * x, -t * y, 4.0 - 4.0 * t];
        assert!(
            near(places[index], point),
            "{index}: {:?} {point:?}",
            places[index]
        );
        assert!(
            near(normals[index], point.map(|v| v / 0.75)),
            "{index}: {:?}",
            normals[index]
        );
        assert!(
            (depths[index][0] - 4.0 * t).abs() < 1e-5,
            "the depth is along the axis, not along the ray"
        );
        assert!(near(albedos[index], [0.45, 0.05, 0.1]) && near(instances[index], [3.0, 0.0, 0.0]));
        balls += 1;
    }
    assert!(balls > 100);
}

#[test]
fn of_paths_the_means_of_all_layers_belong_together() {
    let scene = ball_and_square(16);
    let [normals, depths, places, albedos, instances, uvs] = [
        Aov::Normal,
        Aov::Depth,
        Aov::Position,
        Aov::Albedo,
        Aov::Instance,
        Aov::Uv,
    ]
    .map(|aov| layer(&scene, aov));
    let mut seen = [0; 3];
    for index in 0..256 {
        let place = places[index];
        match instances[index][0] as u32 {
            0 => {
                assert!(depths[index][0] > 3.25 && normals[index][2] >= 0.0);
                seen[0] += 1;
            }
            // Sums over a sphere: the place is 0.75 times the normal, whatever the rays.
            3 if near(albedos[index], [0.9, 0.1, 0.2]) => {
                assert!(near(place, normals[index].map(|n| n * 0.75)), "{place:?}");
                assert!((depths[index][0] - (4.0 - place[2])).abs() < 1e-5);
                seen[1] += 1;
            }
            1 | 2 if near(albedos[index], [0.25, 0.5, 0.75]) => {
                let uv = [(place[0] + 0.9) / 1.8, (place[1] + 0.9) / 1.8, 0.0];
                assert!(
                    near(uvs[index], uv) && near(normals[index], [0.0, 0.0, 1.0]),
                    "{:?} {uv:?}",
                    uvs[index]
                );
                assert!((depths[index][0] - 5.0).abs() < 1e-5);
                seen[2] += 1;
            }
            _ => {}
        }
    }
    assert!(seen.iter().all(|count| *count > 5), "{seen:?}");
}

#[test]
fn where_nothing_is_layers_are_zero_and_depth_is_far() {
    let mut scene = scene(4);
    add_square(&mut scene, 0.0, 0.125, lambert([1.0; 3]));
    let PixelLayers { names, values } = layers(
        &scene,
        &ALL,
        Crop {
            width: 1,
            height: 1,
            ..WHOLE
        },
        1,
    );
    let expected: Vec<f32> = names
        .iter()
        .map(|name| if *name == "depth.Z" { 1e10 } else { 0.0 })
        .collect();
    assert_eq!(values, expected);
}

#[test]
fn a_world_that_shows_another_view_is_as_one_made_for_it() {
    let (scene, mut other) = (ball_and_square(4), ball_and_square(4));
    other.camera.eye = [3.0, 1.0, -2.0];
    other.camera.up = [0.0, 0.125, 0.0625];
    let proofs = [validate(&scene), validate(&other)];
    let seen = |world: &AnyWorld| {
        (
            world.render(&JOB, &|_| true).unwrap().image,
            world.layers(&ALL, &of(WHOLE), &|_| true).unwrap(),
        )
    };
    let [first, second] = proofs
        .each_ref()
        .map(|proof| AnyWorld::prepare(proof, &Plan::new(proof, RuleSet::ALL)));
    let expected = [seen(&first), seen(&second)];
    let mut world = first;
    world.change(proofs[1].clone());
    assert!(seen(&world) == expected[1] && expected[0] != expected[1]);
    world.change(proofs[0].clone());
    assert!(seen(&world) == expected[0]);
}

#[test]
fn layers_are_the_same_on_any_threads_and_in_any_part() {
    for scene in [ball_and_square(4), phong()] {
        let whole = layers(&scene, &ALL, WHOLE, 1);
        assert_eq!(layers(&scene, &ALL, WHOLE, 7), whole);
        let part = layers(
            &scene,
            &ALL,
            Crop {
                x: 5,
                y: 9,
                width: 3,
                height: 2,
            },
            2,
        );
        let width = whole.names.len();
        let row = |y: usize| &whole.values[(y * 16 + 5) * width..][..3 * width];
        assert_eq!(part.values, [row(9), row(10)].concat());
    }
}
