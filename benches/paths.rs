//! A picture of a set-up (`.json`) or of a scene by paths, on one thread: `paths FILE SAMPLES SEED
//! OUT` writes its pixels to OUT, row by row, three little-endian f32 each, linear. Another seed is
//! another noise.
//!
//! One line of JSON comes out: triangles, camera samples, seconds of the clock and CPU-seconds of
//! rendering, without what is prepared before; CPU-seconds of the process; its peak of memory in
//! MB.

#![expect(
    clippy::unwrap_used,
    clippy::print_stdout,
    clippy::disallowed_methods,
    reason = "a measurement stops at the first surprise, has a clock, reads and writes"
)]

mod setup;
#[path = "setup/simd.rs"]
mod simd;

use cpu_time::ProcessTime;
use rtc::internals::ir::{LoweredScene, Mode};
use rtc::internals::pipeline::Renderer;
use rtc::internals::plan::{Plan, RuleSet};
use rtc::internals::render::{Film, RenderSelection, SamplingSeeds, Values};
use rtc::internals::valid::{Shape, Surface, ValidScene};
use serde_json::json;
use std::path::Path;
use std::time::Instant;

fn main() {
    let arguments: Vec<_> = std::env::args().skip(1).collect();
    let [path, samples, seed, out] = &arguments[..] else {
        panic!("usage: paths FILE SAMPLES SEED OUT");
    };
    let lowered = load(Path::new(path), samples.parse().unwrap());
    let proof = setup::validate(&lowered);
    let seed = seed.parse().unwrap();
    let job = RenderSelection {
        values: Values::Linear,
        seeds: SamplingSeeds {
            pixel: seed,
            lens: seed,
            path: seed,
        },
        ..RenderSelection::default()
    };
    let plan = Plan::new(&proof, RuleSet::ALL);
    let renderer = Renderer::at_level(&proof, &plan, 1, simd::level()).unwrap();
    let (clock, cpu) = (Instant::now(), ProcessTime::now());
    let film = renderer.render(&job, &|_| true).unwrap();
    let (clock, cpu) = (clock.elapsed(), cpu.elapsed());
    std::fs::write(out, bytes(&film)).unwrap();
    let row = json!({
        "triangles": triangles(&proof),
        "samples": film.counts.camera,
        "render_s": clock.as_secs_f64(),
        "render_cpu_s": cpu.as_secs_f64(),
        "process_cpu_s": ProcessTime::now().as_duration().as_secs_f64(),
        "peak_mb": peak(),
    });
    println!("{row}");
}

/// The scene of a set-up, or of any other file whose paths are traced, with so many paths a pixel.
fn load(path: &Path, samples: u32) -> LoweredScene {
    if path.extension().is_some_and(|ending| ending == "json") {
        return setup::load_set_up(path, samples);
    }
    let mut lowered = setup::load(path);
    if let Mode::Path(paths) = &mut lowered.scene.settings.mode {
        paths.samples = samples;
    }
    lowered
}

#[expect(
    clippy::cast_possible_truncation,
    reason = "as precise as what they are compared with"
)]
fn bytes(film: &Film) -> Vec<u8> {
    let numbers = film.image.pixels.iter().flatten();
    numbers
        .flat_map(|number| (*number as f32).to_le_bytes())
        .collect()
}

fn triangles(proof: &ValidScene) -> usize {
    let of = |surface: &Surface| {
        if let Shape::Instance(instance) = &surface.shape {
            proof.meshes()[instance.mesh].triangles.len()
        } else {
            1
        }
    };
    proof.surfaces().iter().map(of).sum()
}

/// The most memory the process has held so far, in MB, where the system tells.
fn peak() -> Option<f64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status
        .lines()
        .find_map(|line| line.strip_prefix("VmHWM:"))?;
    Some(line.trim().strip_suffix(" kB")?.parse::<f64>().ok()? / 1024.0)
}
