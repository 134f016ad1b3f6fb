//! Checks a made-up scene of as many spheres as asked for and plans its picture; prints the size of
//! its text, the peak of memory above it, and the time of the plan. `benches/check-cost.sh` runs it
//! under callgrind.

#![expect(
    clippy::unwrap_used,
    unsafe_code,
    clippy::disallowed_methods,
    reason = "a measurement stops at the first surprise and has a clock; an allocator is unsafe"
)]
use rtc::internals::diag::DiagnosticSink;
use rtc::internals::pipeline;
use rtc::internals::plan::{Plan, RuleSet};
use rtc::internals::source::SourceMap;
use rtc::internals::valid::ValidScene;
use std::alloc::{GlobalAlloc, Layout, System};
use std::fmt::Write as _;
use std::sync::atomic::{AtomicUsize, Ordering::Relaxed};
use std::time::Instant;

struct Watching;

static LIVE: AtomicUsize = AtomicUsize::new(0);
static PEAK: AtomicUsize = AtomicUsize::new(0);

// SAFETY: everything is passed on to the system's allocator as it came.
unsafe impl GlobalAlloc for Watching {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        PEAK.fetch_max(
            LIVE.fetch_add(layout.size(), Relaxed) + layout.size(),
            Relaxed,
        );
        // SAFETY: the caller's promise is passed on.
        unsafe { System.alloc(layout) }
    }

    unsafe fn realloc(&self, pointer: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        LIVE.fetch_sub(layout.size(), Relaxed);
        PEAK.fetch_max(LIVE.fetch_add(size, Relaxed) + size, Relaxed);
        // SAFETY: the caller's promise is passed on.
        unsafe { System.realloc(pointer, layout, size) }
    }

    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        LIVE.fetch_sub(layout.size(), Relaxed);
        // SAFETY: the caller's promise is passed on.
        unsafe { System.dealloc(pointer, layout) }
    }
}

#[global_allocator]
static ALLOCATOR: Watching = Watching;

/// Spheres on a winding line, in the layout of the course's files, about 180 bytes each.
fn text(spheres: u32) -> String {
    let mut text =
        "Eye: [200, 200, 1000]\nLights:\n- position: [-200, 600, 1500]\n  color: [1, 1, 1]\nObjects:\n".to_owned();
    for number in 0..spheres {
        let step = |period: u32| f64::from(number % period) * 1.25;
        writeln!(
            text,
            "- type: sphere\n  position: [{:.7}, {:.7}, {:.7}]\n  radius: {:.4}\n  material:\n    color: [{:.4}, 0.5000, 0.2500]\n    \
             ka: 0.2\n    kd: 0.7\n    ks: 0.5\n    n: 64",
            step(401) + 0.125,
            step(397) - 0.125,
            -step(5003),
            step(16) + 0.5,
            step(7) / 10.0,
        )
        .unwrap();
    }
    text
}

#[inline(never)]
fn text_to_proof(bytes: Vec<u8>) -> Option<ValidScene> {
    let mut map = SourceMap::default();
    let file = map.add("spheres", bytes);
    let mut sink = DiagnosticSink::default();
    let options = pipeline::Options::default();
    let lowered = pipeline::load(file, &mut map, &options, &mut sink);
    lowered.and_then(|lowered| pipeline::validate(&lowered, &options, &mut sink))
}

#[inline(never)]
fn proof_to_plan(scene: &ValidScene) -> Plan {
    Plan::new(scene, RuleSet::ALL)
}

#[expect(clippy::print_stdout, reason = "it prints what it measured")]
fn main() {
    let spheres = std::env::args()
        .nth(1)
        .map_or(5_000, |number| number.parse().unwrap());
    let mut bytes = text(spheres).into_bytes();
    bytes.shrink_to_fit();
    let size = bytes.len();
    PEAK.store(LIVE.load(Relaxed), Relaxed);
    let before = LIVE.load(Relaxed);
    let scene = text_to_proof(bytes).expect("the scene is sound");
    println!(
        "{spheres} spheres, {size} bytes of text: {} bytes above it at the peak",
        PEAK.load(Relaxed) - before
    );
    let start = Instant::now();
    let kept = proof_to_plan(&scene)
        .surfaces
        .iter()
        .filter(|kept| **kept)
        .count();
    println!(
        "planned in {:.1} ms, {kept} spheres kept",
        1e3 * start.elapsed().as_secs_f64()
    );
}
