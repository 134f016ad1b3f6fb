//! A time budget is kept, however short it is. The clock is advanced by rays.

use super::patterns::grid;
use super::scenes::{error, order, references, scene, world};
use super::{SIZE, on};
use rtc::internals::ir::Scene;
use rtc::internals::study::{RenderCallbacks, RenderGoal, TargetResult, approach};
use std::sync::atomic::{AtomicU64, Ordering::Relaxed};
use std::time::Duration;

/// With a clock that a ray advances by a microsecond, and that starts at `start` microseconds.
fn with_clock(scene: &Scene, goal: RenderGoal, start: u64) -> TargetResult {
    let rays = AtomicU64::new(start);
    let watch = RenderCallbacks {
        on_pixel: &|step| {
            rays.fetch_add(step.rays, Relaxed);
            true
        },
        is_stopped: &|| false,
        elapsed: &|| Duration::from_micros(rays.load(Relaxed)),
        round: &|_| {},
    };
    on(1, || {
        approach(&mut world(scene), scene, &order(scene, goal, 0), &watch).unwrap()
    })
}

fn within(scene: &Scene, millis: u64) -> TargetResult {
    let goal = RenderGoal {
        error: None,
        time: Some(Duration::from_millis(millis)),
    };
    with_clock(scene, goal, 0)
}

#[test]
fn a_time_is_kept_and_more_of_it_is_less_error() {
    let scene = scene(1, SIZE);
    let (short, long) = (within(&scene, 100), within(&scene, 1000));
    assert!(
        long.error < 0.5 * short.error,
        "{} and {}",
        short.error,
        long.error
    );
    let rays = [short.counts.rays(), long.counts.rays()];
    assert!(
        rays[0] <= 100_000 && (500_000..=1_000_000).contains(&rays[1]),
        "{rays:?}"
    );
}

/// The completed tiles of an interrupted round count.
#[test]
fn the_error_said_is_kept_wherever_the_time_ends() {
    let scene = scene(5, SIZE);
    let references = references(&scene, 2.0);
    let times = (1..=12).map(|part| 17 * part);
    let kept = times.filter(|millis| {
        let reached = within(&scene, *millis);
        assert!(reached.error.is_finite() && reached.coarse.is_none());
        error(&reached, &references) <= reached.error
    });
    assert!(kept.count() >= 10);
}

#[test]
fn an_error_reached_before_the_time_ends_the_render() {
    let goal = RenderGoal {
        error: Some(5.0),
        time: Some(Duration::from_secs(1000)),
    };
    let both = with_clock(&scene(1, SIZE), goal, 0);
    assert!(
        both.error <= 5.0 && both.counts.rays() < 1_000_000,
        "{both:?}"
    );
}

/// Without time for a sample in each pixel, all pixels of a block have the value of one.
#[test]
fn a_crude_picture_is_better_than_none() {
    let pattern = grid(32, 0.5, 0.25);
    let goal = RenderGoal {
        error: None,
        time: Some(Duration::from_millis(1)),
    };
    let late = with_clock(&pattern.scene, goal, 5000);
    let coarse = late.coarse.unwrap();
    assert!(coarse.block == 8 && late.error.is_infinite());
    assert_eq!(late.samples.most, 2);
    // 16 of 1024 pixels took 32 camera rays, which all hit a quad or all miss.
    assert_eq!(late.counts.camera, 32);
    let whole = coarse.complete_after.as_micros();
    assert!(
        (5000 + 1024..5000 + 64 * 2 * 64).contains(&whole),
        "{whole}"
    );
    for (index, pixel) in late.image.pixels.iter().enumerate() {
        let (x, y) = (index % 32, index / 32);
        assert_eq!(*pixel, late.image.pixels[(y - y % 8) * 32 + x - x % 8]);
    }

    let some = with_clock(&pattern.scene, goal, 500);
    assert!(
        matches!(some.coarse.map(|coarse| coarse.block), Some(2 | 4)),
        "{:?}",
        some.coarse
    );
}
