//! Rays through one asset, one after another: `rays ASSET SET… [COUNT]` builds its hierarchy, then
//! traces the first COUNT rays of each SET, or all of them. A set is a file of little-endian f32,
//! six per ray: origin and direction.
//!
//! One line of JSON comes out of the build and of each kind of work: CPU-seconds, rays, hits, and
//! the sum of the first distances, so that others can be checked against it. All of one thread. For
//! callgrind, `closest_hits` and `any_hits` are the work, a batch a call.

#![expect(
    clippy::unwrap_used,
    clippy::print_stdout,
    clippy::disallowed_methods,
    reason = "a measurement stops at the first surprise, reads what it measures, and prints"
)]

#[path = "setup/simd.rs"]
mod simd;

use cpu_time::ProcessTime;
use rtc::internals::diag::DiagnosticSink;
use rtc::internals::math::Vec3;
use rtc::internals::pipeline::{self, Options};
use rtc::internals::plan::{Plan, RuleSet};
use rtc::internals::render::{Hit, Ray, World};
use rtc::internals::source::{Loader, SourceMap};
use serde_json::json;
use std::path::Path;

/// Rays between two looks at the clock.
const BATCH: usize = 1 << 14;

fn main() {
    // One thread, this one, so that its time is all there is.
    let _pool = rayon::ThreadPoolBuilder::new()
        .num_threads(1)
        .use_current_thread()
        .build_global();
    let mut arguments: Vec<_> = std::env::args().skip(1).collect();
    let count = arguments.last().and_then(|last| last.parse().ok());
    if count.is_some() {
        arguments.pop();
    }
    let [asset, sets @ ..] = &arguments[..] else {
        panic!("usage: rays ASSET SET… [COUNT]");
    };
    let world = world(asset);
    for set in sets {
        let name = Path::new(set).file_stem().unwrap().to_str().unwrap();
        let rays = read(set, count.unwrap_or(usize::MAX));
        closest(&world, name, &rays);
        occlusion(&world, name, &rays);
    }
}

/// The world of an asset; the time of the build is that from the proof to the world.
fn world(asset: &str) -> World {
    let (mut map, mut sink, options) = (
        SourceMap::default(),
        DiagnosticSink::default(),
        Options::default(),
    );
    let file = Loader.file(Path::new(asset), &mut map).unwrap();
    let lowered = pipeline::load(file, &mut map, &options, &mut sink).unwrap();
    let proof = pipeline::validate(&lowered, &options, &mut sink).unwrap();
    let plan = Plan::new(&proof, RuleSet::NONE);
    let start = ProcessTime::now();
    let world = World::prepare_at(&proof, &plan, simd::level());
    let seconds = start.elapsed().as_secs_f64();
    println!(
        "{}",
        json!({"work": "build", "cpu_s": seconds, "simd": simd::level().name()})
    );
    world
}

/// The first rays of a set.
fn read(set: &str, count: usize) -> Vec<Ray> {
    let bytes = std::fs::read(set).unwrap();
    let (numbers, _) = bytes.as_chunks::<4>();
    let numbers: Vec<_> = numbers
        .iter()
        .map(|number| f64::from(f32::from_le_bytes(*number)))
        .collect();
    let (rays, _) = numbers.as_chunks::<6>();
    let ray = |[x, y, z, dx, dy, dz]: &[f64; 6]| Ray {
        origin: Vec3::new(*x, *y, *z),
        direction: Vec3::new(*dx, *dy, *dz),
    };
    rays.iter().take(count).map(ray).collect()
}

fn closest(world: &World, set: &str, rays: &[Ray]) {
    let (mut hits, mut count, mut sum) = (Vec::with_capacity(BATCH), 0, 0.0);
    let mut seconds = 0.0;
    for batch in rays.chunks(BATCH) {
        let start = ProcessTime::now();
        closest_hits(world, batch, &mut hits);
        seconds += start.elapsed().as_secs_f64();
        count += hits.iter().flatten().count();
        sum += hits.iter().flatten().map(|hit| hit.t).sum::<f64>();
    }
    let work = format!("{set} closest");
    println!(
        "{}",
        json!({"work": work, "cpu_s": seconds, "rays": rays.len(), "hits": count, "sum_t": sum})
    );
}

fn occlusion(world: &World, set: &str, rays: &[Ray]) {
    let (mut hits, mut count, mut seconds) = (Vec::with_capacity(BATCH), 0, 0.0);
    for batch in rays.chunks(BATCH) {
        let start = ProcessTime::now();
        any_hits(world, batch, &mut hits);
        seconds += start.elapsed().as_secs_f64();
        count += hits.iter().filter(|hit| **hit).count();
    }
    let work = format!("{set} any");
    println!(
        "{}",
        json!({"work": work, "cpu_s": seconds, "rays": rays.len(), "hits": count})
    );
}

/// The closest hit of each ray.
#[inline(never)]
fn closest_hits(world: &World, batch: &[Ray], hits: &mut Vec<Option<Hit>>) {
    hits.clear();
    hits.extend(batch.iter().map(|ray| world.closest_hit(ray)));
}

/// Whether each ray hits anything.
#[inline(never)]
fn any_hits(world: &World, batch: &[Ray], hits: &mut Vec<bool>) {
    hits.clear();
    hits.extend(batch.iter().map(|ray| world.any_hit(ray, f64::INFINITY)));
}
