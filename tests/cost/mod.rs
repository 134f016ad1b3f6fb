//! Studies of accuracy and time, with a clock that ticks once per ray, so that the tests do not
//! depend on the machine.

#![expect(clippy::unwrap_used, reason = "a test stops at the first surprise")]

mod error;
mod parameter;
mod report;
mod resume;
mod versus;

use rtc::internals::codec;
use rtc::internals::diag::DiagnosticSink;
use rtc::internals::image::Image;
use rtc::internals::ir::{Mode, Scene};
use rtc::internals::passes::Overrides;
use rtc::internals::pipeline::{self, Options};
use rtc::internals::plan::{Arithmetic, Plan, RuleSet};
use rtc::internals::render::{RenderSelection, RenderStep, Tiles, render};
use rtc::internals::source::SourceMap;
use rtc::internals::study::{
    self, Ablation, DepthEnd, EffectCost, Effort, ErrorSpread, Parameter, PictureErrors, PowerLaw,
    Setting, Stopped, Study, StudyProvenance, StudyRow, StudyRuntime, WorkClock,
};
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{LazyLock, Mutex};
use std::time::Duration;

/// A reflective sphere and a diffuse one above a floor, with shadows.
const BALLS: &str = r#"{
  "irVersion": 1,
  "camera": {"eye": [0, 10, 60], "center": [0, 2, 0], "right": [0.8, 0, 0], "up": [0, 0.8, 0], "size": [48, 32],
    "lens": {"radius": 0, "samples": 1}},
  "settings": {"mode": "phong", "shadows": true, "maxDepth": 1, "supersampling": 2},
  "lights": [{"point": {"position": [30, 50, 40], "color": [1, 1, 1]}}],
  "materials": [
    {"phong": {"color": [1, 0.2, 0.1], "ka": 0.2, "kd": 0.5, "ks": 0.5, "n": 16, "kt": 0, "eta": 1, "glossySamples": 1}},
    {"phong": {"color": [0.5, 0.6, 0.7], "ka": 0.3, "kd": 0.6, "ks": 0, "n": 1, "kt": 0, "eta": 1, "glossySamples": 1}}],
  "surfaces": [
    {"shape": {"sphere": {"center": [-7, 0, 0], "radius": 6}}, "material": 0},
    {"shape": {"sphere": {"center": [7, 0, 3], "radius": 6}}, "material": 0},
    {"shape": {"plane": {"center": [0, -6, 0], "normal": [0, 1, 0]}}, "material": 1}]
}"#;

fn scene(changes: &[(&str, &str)]) -> Scene {
    let mut text = BALLS.to_owned();
    for (old, new) in changes {
        assert!(text.contains(old), "{old}");
        text = text.replace(old, new);
    }
    decoded(text)
}

/// A scene from the text form of its IR.
fn decoded(text: String) -> Scene {
    let (mut map, mut sink) = (SourceMap::default(), DiagnosticSink::default());
    let file = map.add("scene", text.into_bytes());
    codec::decode(codec::Encoding::Json, file, &map, &mut sink)
        .unwrap_or_else(|| panic!("{:?}", sink.kept()))
}

/// A study with a clock that ticks once per ray.
fn study_of(scene: &Scene, rays: u64, threads: usize) -> Study {
    study_by(scene, rays, threads, || 1.0)
}

/// A study with a clock whose ticks per ray change at each reading.
fn study_by(scene: &Scene, rays: u64, threads: usize, pace: impl FnMut() -> f64 + Send) -> Study {
    let about = StudyProvenance {
        scene: "<balls> & \"floor\"".to_owned(),
        ..StudyProvenance::default()
    };
    let study = on_bench(threads, pace, |runtime| {
        study::study(scene, about, Effort(rays), 1, runtime)
    });
    study.unwrap()
}

/// Runs with a runtime that has such a clock.
fn on_bench<T>(
    threads: usize,
    mut pace: impl FnMut() -> f64 + Send,
    work: impl FnOnce(&StudyRuntime<'_>) -> T,
) -> T {
    let traced = AtomicU64::new(0);
    let mut read = (0, 0.0);
    let tick = Mutex::new(move |now: u64| {
        read = (now, read.1 + (now - read.0) as f64 * pace());
        Duration::from_secs_f64(read.1 * 1e-6)
    });
    let clock = || tick.lock().unwrap()(traced.load(Ordering::Relaxed));
    let on_pixel = |step: RenderStep| {
        traced.fetch_add(step.rays, Ordering::Relaxed);
        true
    };
    let clock = WorkClock {
        cpu: &clock,
        wall: &clock,
    };
    work(&StudyRuntime::new(threads, clock, &on_pixel).unwrap())
}

static WHOLE: LazyLock<Study> = LazyLock::new(|| study_of(&scene(&[]), 8_000_000, 0));

/// With depth of field, and so large that only tiles can be rendered.
static PART: LazyLock<Study> = LazyLock::new(|| {
    let wide = [
        ("\"size\": [48, 32]", "\"size\": [160, 112]"),
        ("0.8", "0.24"),
        (
            "{\"radius\": 0, \"samples\": 1}",
            "{\"radius\": 2, \"samples\": 4}",
        ),
    ];
    study_of(&scene(&wide), 24_000_000, 0)
});

/// Whether a row is not significantly worse than another.
fn dominates(a: &StudyRow, b: &StudyRow) -> bool {
    let no_worse = a.errors.rmse <= 1.001 * b.errors.rmse_high && a.rays.all() <= b.rays.all();
    no_worse && (a.errors.rmse, a.rays) != (b.errors.rmse, b.rays)
}

/// Whether the errors of the front's rows decrease.
fn falls(study: &Study) -> bool {
    study
        .rows
        .iter()
        .filter(|row| row.front)
        .is_sorted_by(|a, b| a.errors.rmse > b.errors.rmse)
}

#[test]
fn the_front_falls_and_dominates_all_else() {
    for study in [&*WHOLE, &*PART] {
        let front: Vec<_> = study.rows.iter().filter(|row| row.front).collect();
        assert!(front.len() >= 4 && falls(study), "{}", study::table(study));
        assert!(
            front.is_sorted_by_key(|row| row.seconds.value),
            "{}",
            study::table(study)
        );
        for row in study.rows.iter().filter(|row| !row.front) {
            assert!(
                front.iter().any(|best| dominates(best, row)),
                "{}",
                study::table(study)
            );
        }
    }
}

#[test]
fn time_is_told_as_the_clock_has_it() {
    for row in &WHOLE.rows {
        let ticks = row.rays.all() as f64 * 1e-6;
        assert!(
            (row.seconds.value - ticks).abs() <= 1e-9 && row.seconds.relative() < 1e-9,
            "{row:?}"
        );
    }
    assert_eq!(WHOLE.scene_row().unwrap().ratio.value, 1.0);
    for row in &PART.rows {
        let ticks = row.rays.all() as f64 * 1e-6 / PART.part.fraction;
        assert!(
            (row.seconds.value / ticks - 1.0).abs() < 1e-9,
            "the time is that of the whole picture: {row:?}"
        );
    }
}

#[test]
fn a_study_is_the_same_on_any_number_of_threads() {
    let scene = scene(&[]);
    let [one, three] = [1, 3].map(|threads| study_of(&scene, 1_000_000, threads).json());
    assert!(one == three);
}

#[test]
fn a_study_can_be_stopped() {
    let clock = || Duration::ZERO;
    let runtime = StudyRuntime::new(
        1,
        WorkClock {
            cpu: &clock,
            wall: &clock,
        },
        &|_| false,
    )
    .unwrap();
    assert_eq!(
        study::study(
            &scene(&[]),
            StudyProvenance::default(),
            Effort::QUICK,
            1,
            &runtime
        )
        .unwrap_err(),
        Stopped
    );
}

#[test]
fn a_study_expects_about_the_rays_that_it_takes() {
    let (rays, expected) = (AtomicU64::new(0), AtomicU64::new(0));
    let clock = || Duration::from_micros(rays.load(Ordering::Relaxed));
    let clock = WorkClock {
        cpu: &clock,
        wall: &clock,
    };
    let on_pixel = |step: RenderStep| {
        rays.fetch_add(step.rays, Ordering::Relaxed);
        true
    };
    let on_budget = |rays| expected.store(rays, Ordering::Relaxed);
    let runtime = StudyRuntime::new(1, clock, &on_pixel).unwrap();
    let runtime = runtime.with_budget_report(&on_budget);
    let about = StudyProvenance::default();
    study::study(&scene(&[]), about, Effort(2_000_000), 1, &runtime).unwrap();
    let [rays, expected] = [&rays, &expected].map(|count| count.load(Ordering::Relaxed));
    assert!(
        2 * rays > expected && rays < 2 * expected,
        "{rays} of {expected}"
    );
}
