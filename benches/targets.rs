//! How many samples `--target-error` takes, beside those that the target needs: the smallest power
//! of two of equal samples in all pixels at which the true error is within the target. Prints a
//! table in Markdown. Arguments: the samples a pixel of a reference, the targets with commas
//! between, the height in pixels, and scenes. `benches/targets.sh` runs it.

#![expect(clippy::print_stdout, reason = "it prints what it measured")]

#[path = "../tests/honest/scenes.rs"]
#[expect(dead_code, reason = "generated scenes are of honest.rs")]
mod scenes;

use rtc::internals::diag::DiagnosticSink;
use rtc::internals::image::Image;
use rtc::internals::ir::{Pattern, Scene};
use rtc::internals::pipeline::{self, Options};
use rtc::internals::render::{AnyWorld, ProgressiveFilm, Values};
use rtc::internals::source::{Loader, SourceMap};
use rtc::internals::study::RenderGoal;
use std::path::Path;

/// The renders of each number of samples, and to each target.
const SEEDS: u64 = 8;

fn load(path: &Path, height: u32) -> Scene {
    let (mut map, mut sink) = (SourceMap::default(), DiagnosticSink::default());
    let file = Loader
        .file(path, &mut map)
        .unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    let lowered = pipeline::load(file, &mut map, &Options::default(), &mut sink);
    let mut scene = lowered.unwrap_or_else(|| panic!("{:?}", sink.kept())).scene;
    let [wide, high] = scene.camera.size;
    if high > height {
        scene.camera.fit([(wide * height).div_ceil(high), height]);
    }
    scene
}

/// A picture of a number of samples in each replicate of all pixels.
fn uniform(world: &AnyWorld, scene: &Scene, count: u32, seed: u64) -> Image {
    let order = scenes::order(scene, RenderGoal::default(), seed);
    let mut film = ProgressiveFilm::new(order.crop, seed);
    (film.background, film.display) = (order.background, order.display);
    assert!(world.grow(&mut film, &|_| [count, 2], &|_| true));
    film.image(Values::Display)
}

/// The root mean square of numbers.
fn rms(numbers: impl Iterator<Item = f64>) -> f64 {
    let (sum, count) = numbers.fold((0.0, 0.0), |(sum, count), x| (sum + x * x, count + 1.0));
    f64::sqrt(sum / count)
}

/// The rows of a scene.
fn measure(path: &Path, targets: &[f64], height: u32, most: u32) {
    let mut scene = load(path, height);
    scene.settings.pattern = Pattern::Jitter;
    let asked = scene.settings.light_samples;
    for target in targets {
        scene.settings.light_samples = asked;
        let reached: Vec<_> = (1..=SEEDS)
            .map(|seed| scenes::render(&scene, *target, seed))
            .collect();
        scene.settings.light_samples = reached[0].light_samples;
        let world = scenes::world(&scene);
        let references = [0x5EED, 0xFEED].map(|seed| uniform(&world, &scene, most / 2, seed));
        let error_of = |count: u32| {
            let images = (1..=SEEDS).map(|seed| uniform(&world, &scene, count, seed));
            rms(images.map(|image| scenes::distance(&image, &references)))
        };
        let mut counts = std::iter::successors(Some(1), |count| Some(2 * count));
        let needed = counts.find(|count| *count >= most / 8 || error_of(*count) <= *target);
        let needed = 2.0 * f64::from(needed.unwrap_or(most));
        let taken: Vec<_> = reached.iter().map(|result| result.samples.mean).collect();
        let mean = taken.iter().sum::<f64>() / taken.len() as f64;
        let error = rms(reached
            .iter()
            .map(|result| scenes::error(result, &references)));
        let bounded = reached
            .iter()
            .filter(|result| result.undersampled.is_none() && result.error <= *target)
            .count();
        println!(
            "| {}, to {target} | {needed} | {mean:.0} | {:.1} | {:.1} | {error:.2} | {bounded} of \
             {SEEDS} |",
            path.file_stem().unwrap_or_default().to_string_lossy(),
            mean / needed,
            taken.iter().copied().fold(0.0, f64::max) / needed,
        );
    }
}

fn main() {
    let mut words = std::env::args().skip(1).filter(|word| word != "--bench");
    let mut next = || words.next().expect("four arguments or more");
    let most: u32 = next().parse().expect("a number of samples");
    let targets: Vec<f64> = next()
        .split(',')
        .map(|word| word.parse().expect("a target"))
        .collect();
    let height: u32 = next().parse().expect("a height");
    println!(
        "| scene | samples needed | taken | times | most times | true error | within the target, \
         told |"
    );
    println!("| --- | ---: | ---: | ---: | ---: | ---: | ---: |");
    for path in words {
        measure(Path::new(&path), &targets, height, most);
    }
}
