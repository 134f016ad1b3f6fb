//! A target takes about as many samples as it needs, even with outliers.

use super::rare::under;
use super::scenes::{distance, lowered, references, render};
use crate::small::{WHOLE, film};
use rtc::internals::image::Image;
use rtc::internals::ir::{Mode, PathSettings, Scene};
use rtc::internals::render::{RenderSelection, SamplingSeeds, Values};

/// Tiny emitters far out of focus, in a dim environment.
fn lamps(size: [u32; 2]) -> Scene {
    let [width, height] = size;
    let places = [
        [-1.527, 2.085],
        [-0.859, 1.6],
        [2.915, 0.76],
        [1.06, 0.657],
        [-1.12, 2.477],
        [-0.198, 2.468],
        [-1.166, 2.205],
        [1.721, 0.678],
        [-0.348, -2.156],
    ];
    let lamp = |[x, y]: [f64; 2]| {
        let (right, above) = (x + 0.04, y + 0.04);
        format!(
            "- {{type: triangle, v0: [{x}, {y}, -6], v1: [{right}, {y}, -6], v2: [{x}, {above}, \
             -6], material: \
             {{type: standard, baseColor: [0, 0, 0, 1], doubleSided: true, emissive: [80, 60, \
             30]}}}}\n"
        )
    };
    let step = 4.4 / f64::from(height);
    let text = format!(
        "Camera: {{eye: [0, 0, 8], center: [0, 0, 0], up: [0, {step}, 0], viewSize: [{width}, \
         {height}], \
         apertureRadius: 0.35, apertureSamples: 4}}\nRenderMode: path\nMaxRecursionDepth: 2\n\
         Environment: {{color: 0.05}}\nObjects:\n{}\
         - {{type: sphere, position: [0, 0, 0], radius: 1, material: {{type: standard, \
         baseColor: [0.5, 0.5, 0.5, 1], metallic: 0, roughness: 0.5}}}}\n",
        places.map(lamp).concat()
    );
    lowered("lamps", text)
}

/// The samples per pixel that a target needs: errors are proportional to 1/√n.
fn needed(scene: &Scene, target: f64, references: &[Image; 2]) -> f64 {
    const SAMPLES: u32 = 1024;
    const SEEDS: u64 = 8;
    let mut scene = scene.clone();
    let path = PathSettings {
        samples: SAMPLES,
        ..PathSettings::default()
    };
    scene.settings.mode = Mode::Path(path);
    let square = |seed: u64| {
        let job = RenderSelection {
            values: Values::Display,
            seeds: SamplingSeeds {
                pixel: seed,
                lens: seed,
                path: seed,
            },
            ..WHOLE
        };
        distance(&film(&scene, &job, 2).image, references).powi(2)
    };
    let mean = (1..=SEEDS).map(square).sum::<f64>() / SEEDS as f64;
    f64::from(SAMPLES) * mean / (target * target)
}

/// Pictures without a sample on an emitter report no bound.
#[test]
fn rare_light_takes_no_more_than_a_few_times_the_samples_that_a_target_needs() {
    for (size, targets) in [([8, 7], [4.0, 9.0])] {
        let scene = lamps(size);
        let references = references(&scene, 2.0);
        for target in targets {
            let needed = needed(&scene, target, &references);
            let renders = (1..=4).map(|seed| render(&scene, target, seed).samples.mean);
            let taken: Vec<_> = renders.collect();
            let mean = taken.iter().sum::<f64>() / taken.len() as f64;
            let told = format!("{size:?} to {target}: needed {needed:.0}, taken {taken:.0?}");
            // The tolerance covers four pictures and the measured need.
            assert!(mean <= 6.0 * needed.max(160.0), "{told}");
        }
    }
}

#[test]
fn a_render_goes_on_while_much_brighter_light_than_white_may_be_unmet() {
    let reached = render(&under(1e5), 12.0, 1);
    assert!(
        reached.undersampled.is_some() && reached.samples.min >= 128,
        "{:?}",
        reached.samples
    );
}

/// Small lamps that the first samples miss: all pixels are refined until the bound counts them.
#[test]
fn lamps_that_a_bound_can_count_are_not_given_up() {
    let reached = render(&lamps([8, 7]), 8.0, 0);
    let samples = reached.samples;
    assert!(reached.undersampled.is_none(), "{samples:?}");
    assert!(samples.min >= 2048 && samples.mean <= 4096.0, "{samples:?}");
}

/// A bright lamp that moves before mirrors which show it now and then.
fn passing_lamp() -> Scene {
    let wall = "material: {type: standard, baseColor: [0.7, 0.7, 0.7, 1], metallic: 0, \
                roughness: 1, specular: 0, doubleSided: true}}";
    let text = format!(
        "Camera: {{eye: [0, 0, 8], center: [0, 0, 0], up: [0, 0.55, 0], viewSize: [8, 8]}}\n\
         RenderMode: path\nMaxRecursionDepth: 3\nObjects:\n\
         - {{type: quad, position: [-2, -2, -2], up: [0, 0, 4], side: [4, 0, 0], {wall}\n\
         - {{type: quad, position: [-2, -2, -2], up: [0, 4, 0], side: [4, 0, 0], {wall}\n\
         - {{type: quad, position: [2, -2, -2], up: [0, 4, 0], side: [0, 0, 4], {wall}\n\
         - {{type: sphere, position: [-1.2, 1, 0], radius: 0.08, velocity: [2.5, 0, 0], material: \
         {{type: standard, baseColor: [0, 0, 0, 1], emissive: [350, 350, 350]}}}}\n\
         - {{type: sphere, position: [0, -1, 0], radius: 0.8, material: {{type: standard, \
         metallic: 1, roughness: 0.2}}}}\n"
    );
    lowered("passing lamp", text)
}

/// A bound on what may be undersampled is not worth many times the samples of the picture; that
/// there is none is told.
#[test]
fn a_bright_lamp_that_may_be_unmet_takes_no_more_than_a_few_times_what_noise_needs() {
    let scene = passing_lamp();
    let references = references(&scene, 8.0);
    for target in [12.0, 9.0] {
        let needed = needed(&scene, target, &references).max(128.0);
        let reached = render(&scene, target, 1);
        let taken = reached.samples.mean;
        assert!(
            taken <= 6.0 * needed,
            "needed {needed:.0}, taken {taken:.0}"
        );
        assert!(reached.undersampled.is_some_and(|white| white > 100.0));
    }
}

/// No error is larger than white against black, however few pixels have the noise.
#[test]
fn no_bound_exceeds_what_eight_bits_can_differ() {
    for seed in 1..=8 {
        let reached = render(&lamps([16, 16]), 60.0, seed);
        assert!(reached.error <= 255.0 && reached.estimate <= reached.error);
    }
}
