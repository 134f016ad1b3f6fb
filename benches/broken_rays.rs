//! Traces rays through a thousand spheres: sound ones, or the same with a component that is no
//! number. Prints how many hit; `benches/broken-rays.sh` counts the instructions of `trace` under
//! callgrind.

#![expect(
    clippy::unwrap_used,
    reason = "a measurement stops at the first surprise"
)]
use rtc::internals::diag::DiagnosticSink;
use rtc::internals::math::Vec3;
use rtc::internals::pipeline::{self, Options};
use rtc::internals::plan::{Plan, RuleSet};
use rtc::internals::render::{Ray, World};
use rtc::internals::source::SourceMap;
use std::fmt::Write as _;

/// Numbers in [−1, 1): a golden ratio sequence for each coordinate.
fn point(k: u32, seed: f64) -> Vec3 {
    let coordinate = |step: f64| (f64::from(k) * step + seed).fract() * 2.0 - 1.0;
    Vec3::new(
        coordinate(0.819_172_513),
        coordinate(0.671_043_606),
        coordinate(0.549_700_477),
    )
}

fn world() -> World {
    let mut text = "Eye: [0, 0, 9]\nLights: []\nObjects:\n".to_owned();
    for k in 0..1000 {
        let Vec3 { x, y, z } = point(k, 0.5);
        writeln!(text, "- {{type: sphere, position: [{x}, {y}, {z}], radius: 0.04, material: {{color: [1, 1, 1], ka: 0, kd: 1, ks: 0, n: 1}}}}")
            .unwrap();
    }
    let (mut map, mut sink, options) = (
        SourceMap::default(),
        DiagnosticSink::default(),
        Options::default(),
    );
    let file = map.add("spheres", text.into_bytes());
    let lowered = pipeline::load(file, &mut map, &options, &mut sink).unwrap();
    let valid = pipeline::validate(&lowered, &options, &mut sink).unwrap();
    World::prepare(&valid, &Plan::new(&valid, RuleSet::NONE))
}

/// Ray k, its components replaced from the list by turns, one at a time or all at once.
fn ray(k: u32, values: &[f64]) -> Ray {
    let origin = point(k, 0.25) * 2.0;
    let mut parts = [origin, point(k, 0.75) - origin].map(|v| v.to_array());
    if let Some(value) = values.get(k as usize / 7 % values.len().max(1)) {
        match k as usize % 7 {
            6 => parts = [[*value; 3]; 2],
            place => parts[place / 3][place % 3] = *value,
        }
    }
    Ray {
        origin: Vec3::from_array(parts[0]),
        direction: Vec3::from_array(parts[1]),
    }
}

#[inline(never)]
fn trace(world: &World, rays: &[Ray]) -> usize {
    rays.iter()
        .filter(|ray| world.closest_hit(ray).is_some())
        .count()
}

#[expect(clippy::print_stdout, reason = "it prints what it counted")]
fn main() {
    let values: &[f64] = match std::env::args().nth(1).as_deref() {
        Some("nan") => &[f64::NAN],
        Some("infinite") => &[f64::INFINITY, f64::NEG_INFINITY],
        _ => &[],
    };
    let rays = (0..7000).map(|k| ray(k, values)).collect::<Vec<_>>();
    println!("{} of {} rays hit", trace(&world(), &rays), rays.len());
}
