//! The laws that hold for every scene of `scenes/`: forms of the IR, threads, crops and powers of
//! two change no byte.

#![expect(clippy::unwrap_used, reason = "a test stops at the first surprise")]

use crate::small;
mod parts;

use crate::repo::{files, root};

use crate::scene_laws::{
    is_the_same_in_any_order, is_the_same_laid_out, makes_the_same_picture_times, powers,
};
use rtc::internals::codec::{self, Encoding};
use rtc::internals::diag::DiagnosticSink;
use rtc::internals::ir::{LoweredScene, Scene, SourceSpans};
use rtc::internals::pipeline::{self, Input, Options, Renderer};
use rtc::internals::plan::{Plan, RuleSet};
use rtc::internals::render::{Crop, RenderSelection, SamplingSeeds, SimdLevel, Tiles};
use rtc::internals::source::SourceMap;
use small::{WHOLE, bits, film, paths, small};
use std::collections::BTreeSet;

#[test]
fn the_ir_in_any_form_makes_the_same_picture() {
    for path in paths() {
        let scene = small(&path);
        let picture = bits(&film(&scene, &WHOLE, 0));
        for encoding in [Encoding::Json, Encoding::Binary] {
            let (mut map, mut sink) = (SourceMap::default(), DiagnosticSink::default());
            let file = map.add("scene", codec::encode(encoding, &scene).unwrap());
            let decoded = pipeline::load(file, &mut map, &Options::default(), &mut sink)
                .unwrap()
                .scene;
            assert_eq!(decoded, scene, "{encoding:?} of {}", path.display());
            assert!(
                bits(&film(&decoded, &WHOLE, 0)) == picture,
                "{encoding:?} of {}",
                path.display()
            );
        }
    }
}

/// The scenes of the repo, and those of its tests, sound or not.
#[test]
fn laid_out_is_the_same_scene() {
    let mut count = 0;
    for path in ["scenes", "tests"]
        .map(|folder| files(&root(folder), &["yaml"]))
        .concat()
    {
        is_the_same_laid_out(&path);
        count += 1;
    }
    assert!(count > 200, "{count}");
}

#[test]
fn the_scenes_of_the_repo_are_laid_out() {
    for path in paths() {
        let mut input = Input::file(&path, Options::default());
        let is_laid_out = input.format_text().as_deref() == Ok(input.text().unwrap());
        assert!(is_laid_out, "{}", path.display());
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

/// With nine samples a pixel: eight in lanes and one alone, where Whitted goes by lanes.
#[test]
fn levels_of_vector_instructions_change_no_bit() {
    let rings = root("benches/peers/rings.yaml");
    let names = SimdLevel::NAMES.into_iter();
    let levels: Vec<_> = names.filter_map(SimdLevel::named).collect();
    assert!(levels.len() > 1, "{levels:?}");
    for path in paths().into_iter().chain([rings]) {
        let mut scene = small(&path);
        scene.settings.supersampling = 3;
        let valid = small::validated(&scene);
        let plan = Plan::new(&valid, RuleSet::ALL);
        let films: Vec<_> = levels
            .iter()
            .map(|level| {
                let renderer = Renderer::at_level(&valid, &plan, 2, *level).unwrap();
                renderer.render(&WHOLE, &|_| true).unwrap()
            })
            .collect();
        for (film, level) in films.iter().zip(&levels) {
            let (level, path) = (level.name(), path.display());
            assert!(bits(film) == bits(&films[0]), "{level}: {path}");
            assert_eq!(film.counts, films[0].counts, "{level}: {path}");
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
            &RenderSelection {
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
        first: 0,
        last: u64::MAX / 2,
    };
    let part = film(
        &scene,
        &RenderSelection {
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
            &RenderSelection {
                seeds: SamplingSeeds {
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
    let distance = |a: &rtc::internals::image::Image, b: &rtc::internals::image::Image| {
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

#[test]
fn a_scene_times_a_power_of_two_makes_the_same_picture() {
    let mut seen = BTreeSet::new();
    let paths = paths();
    for (index, path) in paths.iter().enumerate() {
        makes_the_same_picture_times(path, powers(paths.len(), index));
        seen.extend(powers(paths.len(), index));
    }
    assert_eq!(seen.len(), 83);
}

#[test]
fn the_order_of_surfaces_does_not_matter() {
    paths()
        .iter()
        .for_each(|path| is_the_same_in_any_order(path));
}

/// Stopping gives no film at all.
#[test]
fn a_render_that_is_stopped_leaves_nothing() {
    let (mut sink, options) = (DiagnosticSink::default(), Options::default());
    let lowered = LoweredScene {
        scene: small(&paths()[0]),
        source_spans: SourceSpans::default(),
    };
    let valid = pipeline::validate(&lowered, &options, &mut sink).unwrap();
    assert!(
        pipeline::render(&valid, &Plan::new(&valid, RuleSet::ALL), &WHOLE, 2, &|_| {
            false
        })
        .unwrap()
        .is_none()
    );
}
