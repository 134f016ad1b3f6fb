//! The laws that hold for every scene of `scenes/`: forms of the IR, threads, crops and powers of
//! two change no byte.

#![expect(
    clippy::print_stdout,
    clippy::unwrap_used,
    reason = "a test stops at the first surprise, and says what it skips"
)]

mod scale;
mod small;

use rtc::codec::{self, Form};
use rtc::diag::Sink;
use rtc::ir::{self, Lowered, Origins, Scene};
use rtc::math::ldexp;
use rtc::pipeline::{self, Options};
use rtc::plan::{Plan, Rules};
use rtc::render::{Crop, Geometry, Job, Seeds, Shear, Tiles, World, camera_ray, image_point};
use rtc::source::SourceMap;
use scale::scaled;
use small::{WHOLE, bits, film, paths, scenes_in, small};
use std::path::Path;

#[test]
fn the_ir_in_any_form_makes_the_same_picture() {
    for path in paths() {
        let scene = small(&path);
        let picture = bits(&film(&scene, &WHOLE, 0));
        for form in [Form::Text, Form::Binary] {
            let (mut map, mut sink) = (SourceMap::default(), Sink::default());
            let file = map.add("scene", codec::encode(form, &scene).unwrap());
            let decoded = pipeline::load(file, &mut map, &Options::default(), &mut sink)
                .unwrap()
                .scene;
            assert_eq!(decoded, scene, "{form:?} of {}", path.display());
            assert!(
                bits(&film(&decoded, &WHOLE, 0)) == picture,
                "{form:?} of {}",
                path.display()
            );
        }
    }
}

#[test]
fn threads_change_no_bit() {
    for path in paths() {
        let scene = small(&path);
        let one = film(&scene, &WHOLE, 1);
        for threads in [2, 7] {
            let many = film(&scene, &WHOLE, threads);
            assert!(
                bits(&many) == bits(&one),
                "{threads} threads: {}",
                path.display()
            );
            assert_eq!(
                many.counts,
                one.counts,
                "{threads} threads: {}",
                path.display()
            );
        }
    }
}

#[test]
fn a_crop_is_a_part_of_the_whole() {
    let crop = Crop {
        x: 11,
        y: 7,
        width: 20,
        height: 50,
    };
    for path in paths() {
        let scene = small(&path);
        let whole = film(&scene, &WHOLE, 0).image;
        let part = film(
            &scene,
            &Job {
                crop: Some(crop),
                ..WHOLE
            },
            0,
        )
        .image;
        assert_eq!((part.width, part.height), (20, 33));
        let rows = whole.pixels.chunks(whole.width as usize).skip(7);
        let wanted = rows
            .flat_map(|row| &row[11..31])
            .copied()
            .collect::<Vec<_>>();
        assert!(part.pixels == wanted, "{}", path.display());
    }
}

/// Tiles are parts of the whole; black elsewhere.
#[test]
fn tiles_are_parts_of_the_whole() {
    let scene = small(&paths()[0]);
    let whole = film(&scene, &WHOLE, 0).image;
    let tiles = Tiles {
        seed: 5,
        last: u64::MAX / 2,
    };
    let part = film(
        &scene,
        &Job {
            tiles: Some(tiles),
            ..WHOLE
        },
        0,
    );
    let mut inside = 0;
    for (i, (ours, wanted)) in (0_u32..).zip(part.image.pixels.iter().zip(&whole.pixels)) {
        let is_inside = tiles.contain([i % whole.width, i / whole.width]);
        inside += u32::from(is_inside);
        assert_eq!(*ours, if is_inside { *wanted } else { [0.0; 3] });
    }
    assert!(
        inside > 0 && inside < whole.width * whole.height,
        "{inside} pixels"
    );
    assert_eq!(
        part.counts.camera,
        u64::from(inside) * 4,
        "other pixels take no ray"
    );
}

/// A seed changes the noise, not what the picture shows.
#[test]
fn seeds_change_the_noise_alone() {
    let path = paths()
        .into_iter()
        .find(|path| path.ends_with("bokeh.yaml"))
        .unwrap();
    let mut scene = small(&path);
    let seeded = |scene: &Scene, lens| {
        film(
            scene,
            &Job {
                seeds: Seeds {
                    pixel: lens,
                    lens,
                    path: lens,
                },
                ..WHOLE
            },
            0,
        )
        .image
    };
    assert!(
        seeded(&scene, 1) != seeded(&scene, 2),
        "another seed is another picture"
    );
    let distance = |a: &rtc::image::Image, b: &rtc::image::Image| {
        let squares = a
            .pixels
            .iter()
            .flatten()
            .zip(b.pixels.iter().flatten())
            .map(|(a, b)| (a - b) * (a - b));
        (squares.sum::<f64>() / (3 * a.pixels.len()) as f64).sqrt()
    };
    scene.camera.lens.samples = 256;
    let truth = seeded(&scene, 7);
    scene.camera.lens.samples = 1;
    let mut mean = seeded(&scene, 8);
    let noise = distance(&mean, &truth);
    let seeds = 64;
    for seed in 1..seeds {
        for (sum, more) in mean.pixels.iter_mut().zip(seeded(&scene, 8 + seed).pixels) {
            *sum = [0, 1, 2].map(|c| sum[c] + more[c]);
        }
    }
    mean.pixels
        .iter_mut()
        .flatten()
        .for_each(|sum| *sum /= seeds as f64);
    assert!(
        distance(&mean, &truth) < 0.25 * noise,
        "64 pictures of 1 point are one of 64: {noise}"
    );
}

/// Scenes, each with the powers of two it is scaled by: all from −40 to 40 occur, `RTC_ALL_POWERS`
/// tries all on each; and −180 and 140, at which powers of a length leave the range of f64.
fn powers(scenes: usize, index: usize) -> impl Iterator<Item = i32> {
    let all = std::env::var_os("RTC_ALL_POWERS").is_some();
    let (scenes, index) = (
        i32::try_from(scenes).unwrap(),
        i32::try_from(index).unwrap(),
    );
    (-40..=40)
        .filter(move |k| all || (k + 40) % scenes == index)
        .chain([-180, 140])
}

/// The scenes of the course, where they are.
fn course() -> Vec<std::path::PathBuf> {
    let paths = scenes_in(&Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared/course/scenes"));
    if paths.is_empty() {
        println!("skipped: the scenes of the course are not here");
    }
    paths
}

/// Kills every fixed epsilon in the program.
#[test]
fn a_scene_times_a_power_of_two_makes_the_same_picture() {
    let mut seen = std::collections::BTreeSet::new();
    for paths in [paths(), course()] {
        for (index, path) in paths.iter().enumerate() {
            let scene = small(path);
            let picture = bits(&film(&scene, &WHOLE, 0));
            for k in powers(paths.len(), index) {
                let other = film(&scaled(&scene, ldexp(1.0, k)), &WHOLE, 0);
                assert!(bits(&other) == picture, "2^{k}: {}", path.display());
                seen.insert(k);
            }
        }
    }
    assert_eq!(seen.len(), 83);
}

/// Whether a camera ray of a pixel, of those in a grid, meets two surfaces at the very same t.
fn has_tie(world: &World, index: usize) -> bool {
    let camera = world.scene.camera();
    let width = camera.width.get() as usize;
    let pixel = [index % width, index / width].map(|k| u32::try_from(k).unwrap());
    let factor = world.scene.settings().supersampling.get();
    let middle = |k: u32| (f64::from(k) + 0.5) / f64::from(factor);
    let places = (0..factor).flat_map(|i| (0..factor).map(move |j| [i, j].map(middle)));
    places
        .map(|place| camera_ray(camera.eye, image_point(camera, pixel, place)))
        .any(|ray| {
            let shear = Shear::new(&ray);
            let roots = world
                .surfaces
                .iter()
                .filter_map(|surface| surface.shape.intersect(&ray, &shear, f64::INFINITY));
            let nearest = world.nearest(&ray).map(|hit| hit.t);
            roots.filter(|(t, _)| Some(*t) == nearest).count() > 1
        })
}

fn world(scene: &Scene) -> World {
    let lowered = Lowered {
        scene: scene.clone(),
        origins: Origins::default(),
    };
    let valid = pipeline::prove(&lowered, &Options::default(), &mut Sink::default()).unwrap();
    World::prepare(&valid, &Plan::new(&valid, Rules::NONE))
}

/// The order of surfaces is no part of a scene's meaning, but where several are met at the very
/// same t.
#[test]
fn the_order_of_surfaces_does_not_matter() {
    for path in paths().iter().chain(&course()) {
        let mut scene = small(path);
        let picture = film(&scene, &WHOLE, 0).image.pixels;
        let ties = world(&scene);
        let count = scene.surfaces.len();
        let orders: [fn(&mut [ir::Surface]); 2] =
            [|all| all.reverse(), |all| all.rotate_left(all.len() / 2)];
        for order in orders {
            order(&mut scene.surfaces);
            let other = film(&scene, &WHOLE, 0).image.pixels;
            let differs = |index: &usize| {
                picture[*index].map(f64::to_bits) != other[*index].map(f64::to_bits)
            };
            let unexplained = (0..picture.len())
                .filter(differs)
                .find(|index| !has_tie(&ties, *index));
            assert_eq!(
                unexplained,
                None,
                "a pixel of {}, {count} surfaces",
                path.display()
            );
        }
    }
}

/// Stopping gives no film at all.
#[test]
fn a_render_that_is_stopped_leaves_nothing() {
    let (mut sink, options) = (Sink::default(), Options::default());
    let lowered = Lowered {
        scene: small(&paths()[0]),
        origins: Origins::default(),
    };
    let valid = pipeline::prove(&lowered, &options, &mut sink).unwrap();
    assert!(
        pipeline::render(&valid, &Plan::new(&valid, Rules::ALL), &WHOLE, 2, &|_| {
            false
        })
        .unwrap()
        .is_none()
    );
}
