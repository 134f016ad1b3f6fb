//! The error estimate of a denoised picture is accurate, and its bound is kept.

use super::on;
use super::paths::balls;
use super::scenes::{order, references, world, world_at};
use rtc::internals::color::Tone;
use rtc::internals::image::Image;
use rtc::internals::ir::{Scene, StereoView};
use rtc::internals::render::{AnyWorld, RenderSelection, SamplingSeeds, SimdLevel};
use rtc::internals::study::{LEVELS, ProbedError, RenderGoal, RenderRequest, probe};
use std::ops::Range;

const SAMPLES: u32 = 16;

/// A denoised picture of a seed in linear values, and its estimated error.
fn denoised(world: &AnyWorld, order: &RenderRequest, seed: u64) -> (Image, ProbedError) {
    let job = RenderSelection {
        seeds: SamplingSeeds {
            pixel: seed,
            lens: seed,
            path: seed,
        },
        ..RenderSelection::default()
    };
    let picture = world.denoised(SAMPLES, &job, &|_| true, &|| ()).unwrap();
    // Probes with other seeds than the picture.
    let order = RenderRequest {
        seed: 1000 * seed,
        ..*order
    };
    let (film, probed) = probe(world, &order, picture, SAMPLES, &|_| true).unwrap();
    (film.image, probed)
}

/// The mean square error of a picture, as displayed: the noise of two references cancels.
fn square(image: &Image, [a, b]: &[Image; 2]) -> f64 {
    let pixels = image.pixels.iter().zip(&a.pixels).zip(&b.pixels);
    let products = pixels.flat_map(|((pixel, a), b)| {
        let shown = Tone::Srgb.display(*pixel);
        [0, 1, 2].map(|c: usize| (shown[c] - a[c]) * (shown[c] - b[c]))
    });
    products.sum::<f64>() / (3 * image.pixels.len()) as f64 * LEVELS * LEVELS
}

/// A scene of motion, and one for two eyes.
fn unusual() -> [Scene; 2] {
    let (mut moving, mut anaglyph) = (balls(), balls());
    moving.settings.shutter = [0.0, 1.0];
    moving.surfaces[1].velocity = [1.0, 0.0, 0.0].into();
    anaglyph.settings.stereo = 0.3;
    anaglyph.settings.stereo_view = StereoView::Anaglyph;
    [moving, anaglyph]
}

/// Denoises a scene with so many seeds; the bound must hold for at least some of them, and the
/// estimate must be within these factors of the true error.
fn assert_told(scene: &Scene, (seeds, least): (u64, u32), factors: Range<f64>) {
    let (world, order) = (world(scene), order(scene, RenderGoal::default(), 0));
    let references = references(scene, 2.0);
    let (mut kept, mut sums, mut said) = (0, [0.0; 3], Vec::new());
    for seed in 1..=seeds {
        let (image, probed) = denoised(&world, &order, seed);
        let reference = square(&image, &references);
        kept += u32::from(reference <= probed.error * probed.error);
        let squares = [
            reference,
            probed.estimate * probed.estimate,
            probed.error * probed.error,
        ];
        sums.iter_mut()
            .zip(squares)
            .for_each(|(sum, square)| *sum += square);
        said.push(squares.map(f64::sqrt));
    }
    assert!(kept >= least, "{kept} of {seeds}: {said:.2?}");
    let [probed, bound] = [1, 2].map(|k| (sums[k] / sums[0]).sqrt());
    assert!(
        factors.contains(&probed),
        "{probed} of the true error: {said:.2?}"
    );
    assert!(
        bound < 2.0 * factors.end / 1.25,
        "a bound of {bound} times the error says little: {said:.2?}"
    );
}

/// If the bound holds with probability 0.9, fewer than 15 of 20 pictures keep it once in 400 runs.
#[test]
fn the_error_told_is_the_true_one_and_the_bound_is_kept() {
    assert_told(&balls(), (20, 15), 0.8..1.25);
}

/// Fewer than 4 of 6 keep it once in 60 runs.
#[test]
fn the_error_told_of_motion_and_of_anaglyphs_is_the_true_one() {
    for scene in unusual() {
        assert_told(&scene, (6, 4), 0.7..1.5);
    }
}

#[test]
fn threads_change_no_bit_of_what_is_told() {
    let scene = balls();
    let (world, order) = (world(&scene), order(&scene, RenderGoal::default(), 0));
    let [one, three] = [1, 3].map(|threads| on(threads, || denoised(&world, &order, 3)));
    assert_eq!(one, three);
}

#[test]
fn levels_and_threads_change_no_bit_of_motion_and_of_anaglyphs() {
    for scene in unusual() {
        let order = order(&scene, RenderGoal::default(), 0);
        let levels = SimdLevel::NAMES.into_iter().filter_map(SimdLevel::named);
        let told = (1..).zip(levels).map(|(threads, level)| {
            let world = world_at(&scene, level);
            on(threads, || denoised(&world, &order, 3))
        });
        let told: Vec<_> = told.collect();
        assert!(told.len() > 1 && told.windows(2).all(|pair| pair[0] == pair[1]));
    }
}
