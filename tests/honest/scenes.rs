//! Generated scenes with all sources of noise, and the true error of a render to a target.

use rtc::internals::color::Tone;
use rtc::internals::diag::DiagnosticSink;
use rtc::internals::image::Image;
use rtc::internals::ir::{LoweredScene, Scene, SourceSpans};
use rtc::internals::pipeline::{self, Options};
use rtc::internals::plan::{Plan, RuleSet};
use rtc::internals::render::{AnyWorld, Background, Crop, SimdLevel, Values};
use rtc::internals::source::SourceMap;
use rtc::internals::study::{
    LEVELS, RenderCallbacks, RenderGoal, RenderRequest, SplitMix64, TargetResult, approach,
};
use std::fmt::Write as _;
use std::path::Path;
use std::time::Duration;

/// The scene of a number: spheres and boxes on a floor; the bits of the number select a lens, area
/// lights, glossy spheres, textures and many small objects.
pub(crate) fn scene(number: u64, size: [u32; 2]) -> Scene {
    lowered(&format!("scene {number}"), text(number, size))
}

/// The scene of a valid text.
pub(crate) fn lowered(name: &str, text: String) -> Scene {
    let (mut map, mut sink) = (SourceMap::default(), DiagnosticSink::default());
    // Textures are those of the scenes of the repo.
    let path = Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("scenes")
        .join("made-up.yaml");
    let file = map.add_from(&path, text.into_bytes());
    let lowered = pipeline::load(file, &mut map, &Options::default(), &mut sink);
    let lowered = lowered.unwrap_or_else(|| panic!("{name}: {:?}", sink.kept()));
    pipeline::validate(&lowered, &Options::default(), &mut sink)
        .unwrap_or_else(|| panic!("{:?}", sink.kept()));
    lowered.scene
}

/// Whether a scene has the feature of a bit of its number.
fn has(number: u64, bit: u64) -> bool {
    number >> bit & 1 == 1
}

fn text(number: u64, [width, height]: [u32; 2]) -> String {
    let mut rng = SplitMix64::new(number);
    let mut within =
        |from: f64, to: f64| from + (to - from) * rng.below(1 << 20) as f64 / f64::from(1 << 20);
    let mut text = format!(
        "Camera: {{eye: [{:.3}, 4, 12], center: [0, 1, 0], up: [0, {}, 0], viewSize: [{width}, \
         {height}]",
        within(-4.0, 4.0),
        5.0 / f64::from(height)
    );
    text += &if has(number, 0) {
        format!(
            ", apertureRadius: {:.3}, apertureSamples: 4}}\n",
            within(0.1, 0.5)
        )
    } else {
        "}\n".to_owned()
    };
    text += "Shadows: true\nMaxRecursionDepth: 2\nLightSamples: 8\nLights:\n";
    for x in [-6.0, 5.0] {
        let radius = if has(number, 1) {
            within(0.3, 1.5)
        } else {
            0.0
        };
        let shade = within(0.3, 0.7);
        let _ = writeln!(
            text,
            "- {{position: [{x}, 7, 5], color: [{shade:.3}, 0.5, 0.5], radius: {radius:.3}}}"
        );
    }
    text += "Objects:\n- {type: plane, position: [0, 0, 0], normal: [0, 1, 0], material: {color: \
     [0.7, 0.7, 0.7], ka: 0.2, kd: 0.7, ks: 0.1, n: 8}}\n";
    let small = if has(number, 4) { 120 } else { 0 };
    for index in 0..8 + small {
        text += &ball(number, index, &mut within);
    }
    text
}

/// A ball of a scene, as a line of its text: the first 8 are large.
fn ball(number: u64, index: u64, within: &mut impl FnMut(f64, f64) -> f64) -> String {
    let radius = if index < 8 {
        within(0.4, 1.2)
    } else {
        within(0.01, 0.06)
    };
    let place = [
        within(-5.0, 5.0),
        radius + if index < 8 { 0.0 } else { within(0.0, 2.0) },
        within(-4.0, 3.0),
    ];
    let color = match has(number, 3) && index.is_multiple_of(3) {
        true => "texture: tiles.png".to_owned(),
        false => format!(
            "color: [{:.3}, {:.3}, {:.3}]",
            within(0.0, 1.0),
            within(0.0, 1.0),
            within(0.0, 1.0)
        ),
    };
    let glossy = if has(number, 2) && index.is_multiple_of(2) {
        ", glossySamples: 4"
    } else {
        ""
    };
    let (ks, n) = (within(0.0, 0.8), within(4.0, 200.0));
    format!(
        "- {{type: sphere, position: [{:.4}, {:.4}, {:.4}], radius: {radius:.4}, angle: 30, \
         material: {{{color}, ka: 0.2, kd: 0.5, ks: {ks:.3}, n: {n:.0}{glossy}}}}}\n",
        place[0], place[1], place[2]
    )
}

/// Renders to an error with a seed, without a clock.
pub(crate) fn render(scene: &Scene, error: f64, seed: u64) -> TargetResult {
    let goal = RenderGoal {
        error: Some(error),
        time: None,
    };
    let watch = RenderCallbacks {
        on_pixel: &|_| true,
        is_stopped: &|| false,
        elapsed: &|| Duration::ZERO,
        round: &|_| {},
    };
    approach(&mut world(scene), scene, &order(scene, goal, seed), &watch).expect("nobody says stop")
}

/// The world of a valid scene.
pub(crate) fn world(scene: &Scene) -> AnyWorld {
    world_at(scene, SimdLevel::best())
}

/// As [`world`], for these instructions.
pub(crate) fn world_at(scene: &Scene, level: SimdLevel) -> AnyWorld {
    let lowered = LoweredScene {
        scene: scene.clone(),
        source_spans: SourceSpans::default(),
    };
    let validated = pipeline::validate(
        &lowered,
        &Options::default(),
        &mut DiagnosticSink::default(),
    )
    .expect("the scene is sound");
    AnyWorld::prepare_at(&validated, &Plan::new(&validated, RuleSet::ALL), level)
}

/// All of the picture.
pub(crate) fn order(scene: &Scene, goal: RenderGoal, seed: u64) -> RenderRequest {
    let [width, height] = scene.camera.size;
    let crop = Crop {
        x: 0,
        y: 0,
        width,
        height,
    };
    RenderRequest {
        display: (Tone::Srgb, 1.0),
        goal,
        crop,
        background: Background::Environment,
        values: Values::Display,
        keep_lights: false,
        seed,
    }
}

/// Two references with other seeds, each with at most a quarter of the error.
pub(crate) fn references(scene: &Scene, error: f64) -> [Image; 2] {
    [0x5EED, 0xFEED].map(|seed| render(scene, error / 4.0, seed).image)
}

/// The error of a picture in grey levels: the noise of two independent references cancels in the
/// product.
pub(crate) fn error(reached: &TargetResult, references: &[Image; 2]) -> f64 {
    distance(&reached.image, references)
}

/// As [`error`], of an image of display values.
pub(crate) fn distance(image: &Image, [a, b]: &[Image; 2]) -> f64 {
    let pixels = image.pixels.iter().zip(&a.pixels).zip(&b.pixels);
    let products = pixels.flat_map(|((x, a), b)| {
        [0, 1, 2].map(|channel: usize| (x[channel] - a[channel]) * (x[channel] - b[channel]))
    });
    (products.sum::<f64>() / (3.0 * a.pixels.len() as f64))
        .max(0.0)
        .sqrt()
        * LEVELS
}
