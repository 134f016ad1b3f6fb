//! The plain arithmetics on the scenes of the course: what differs is warned of, and what is equal
//! is not.

use super::scenes::{COURSE, at, course, each, film, read, validated};
use libtest_mimic::Trial;
use rtc::internals::color::quantize8;
use rtc::internals::ir::Scene;
use rtc::internals::plan::{Arithmetic, Plan, PrecisionArtifact, RuleSet, loss};
use rtc::internals::render::{Film, RenderSelection};
use rtc::internals::valid::ValidScene;
use std::path::Path;

pub(crate) fn trials() -> Vec<Trial> {
    let mut trials = each("plain", COURSE, &["yaml"], what_shows_is_warned_of);
    trials.push(course(
        "plain: the day side goes dark in f32 alone",
        "blue-earth.yaml",
        goes_dark_in_f32_alone,
    ));
    trials.push(course(
        "plain: without shadows all arithmetics show the same",
        "scene01.yaml",
        is_the_same_by_any_arithmetic,
    ));
    trials
}

/// A scene at no more than `side` pixels wide or high, one sample each.
fn small(scene: Scene, side: u32) -> ValidScene {
    let [width, height] = scene.camera.size;
    let size = [width, height].map(|pixels| (pixels * side).div_ceil(width.max(height)));
    validated(at(scene, size, 1))
}

fn by(scene: &ValidScene, arithmetic: Arithmetic) -> Film {
    let plan = Plan::with_arithmetic(arithmetic, scene, RuleSet::ALL);
    film(scene, &plan, &RenderSelection::default())
}

/// The share of pixels that differ in 8 bits.
fn difference(a: &Film, b: &Film) -> f64 {
    let pairs = || a.image.pixels.iter().zip(&b.image.pixels);
    pairs()
        .filter(|(a, b)| a.map(quantize8) != b.map(quantize8))
        .count() as f64
        / pairs().count() as f64
}

fn goes_dark_in_f32_alone(scene: Scene) {
    let scene = small(scene, 80);
    let robust = by(&scene, Arithmetic::Robust);
    let darker = |film: &Film| {
        let brightness = |pixel: &[f64; 3]| pixel.iter().sum::<f64>();
        let pairs = robust.image.pixels.iter().zip(&film.image.pixels);
        let day = pairs
            .filter(|(robust, _)| brightness(robust) > 0.3)
            .map(|(a, b)| brightness(b) < 0.6 * brightness(a));
        let dark = day.collect::<Vec<_>>();
        dark.iter().filter(|dark| **dark).count() as f64 / dark.len() as f64
    };
    assert_eq!(darker(&by(&scene, Arithmetic::Plain)), 0.0);
    let share = darker(&by(&scene, Arithmetic::F32));
    assert!((0.3..0.7).contains(&share), "{share}");
    let warning = loss(&scene, Arithmetic::F32).unwrap();
    assert!(
        warning.symptom == PrecisionArtifact::SelfHit && warning.error > 1.0,
        "{warning:?}"
    );
}

fn is_the_same_by_any_arithmetic(scene: Scene) {
    let scene = small(scene, 160);
    let robust = by(&scene, Arithmetic::Robust);
    assert_eq!(difference(&robust, &by(&scene, Arithmetic::Plain)), 0.0);
    let share = difference(&robust, &by(&scene, Arithmetic::F32));
    assert!(share > 0.0 && share < 1e-3, "{share}");
}

fn what_shows_is_warned_of(path: &Path) {
    let scene = small(read(path), 64);
    let robust = by(&scene, Arithmetic::Robust);
    for arithmetic in [Arithmetic::Plain, Arithmetic::F32] {
        let differs = difference(&robust, &by(&scene, arithmetic));
        let warning = loss(&scene, arithmetic);
        let excess = warning.map_or(0.0, |loss| loss.excess);
        println!(
            "{} {arithmetic:<6?} {:8.3} % excess {excess:.1e} {:?}",
            path.display(),
            100.0 * differs,
            warning.map(|w| w.symptom)
        );
        assert!(
            differs <= 0.01 || warning.is_some(),
            "{arithmetic:?}: no warning, {differs} differ"
        );
        assert!(
            differs > 0.0 || warning.is_none(),
            "{arithmetic:?}: {warning:?}, and nothing differs"
        );
    }
}
