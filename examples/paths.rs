//! How fast paths are traced: `paths FILE [SAMPLES]` renders an asset, or the set-up of a reference, in 512 × 512 pixels
//! with paths of 8 bounces on one thread.
//!
//! One row of Markdown comes out: triangles, camera samples per CPU-second, the relative squared error that is left (from
//! a second picture with other random numbers), CPU-seconds from the start of the process to the first picture, and the
//! peak of memory until then.

#![expect(
    clippy::unwrap_used,
    clippy::print_stdout,
    clippy::disallowed_methods,
    reason = "a measurement stops at the first surprise, and asks the system what it took"
)]

mod setup;

use cpu_time::ProcessTime;
use rtc::diag::Sink;
use rtc::ir::{Mode, Scene, Stage};
use rtc::pipeline;
use rtc::plan::{Plan, Rules};
use rtc::render::{Film, Job, Seeds, Values};
use rtc::valid::{Shape, Surface, ValidScene};
use std::path::Path;

/// Pixels along each side.
const SIDE: u32 = 512;

const BOUNCES: u32 = 8;

fn main() {
    let mut arguments = std::env::args().skip(1);
    let path = arguments.next().expect("usage: paths FILE [SAMPLES]");
    let samples = arguments.next().map_or(64, |samples| samples.parse().unwrap());
    let path = Path::new(&path);
    let proof = {
        let mut lowered = if path.extension().is_some_and(|extension| extension == "json") {
            setup::load_set_up(path, samples)
        } else {
            let mut lowered = setup::load(path);
            pipeline::stage(&mut lowered, &Stage::default(), &mut Sink::default());
            lowered
        };
        resize(&mut lowered.scene, samples);
        setup::prove(&lowered)
    };
    let start = ProcessTime::now();
    let film = render(&proof, 0);
    let (seconds, whole) = (start.elapsed().as_secs_f64(), ProcessTime::now().as_duration().as_secs_f64());
    let peak = peak().map_or("–".to_owned(), |megabytes| format!("{megabytes:.0}"));
    let (rate, error) = (film.counts.camera as f64 / seconds / 1e6, relative_error(&film, &render(&proof, 1)));
    let (name, triangles) = (path.file_stem().unwrap().to_string_lossy(), triangles(&proof));
    println!("| {name} | {triangles} | {samples} | {rate:.2} | {error:.5} | {whole:.1} | {peak} |");
}

/// The same view in pixels and paths of the number wanted.
fn resize(scene: &mut Scene, samples: u32) {
    let shrink = f64::from(scene.camera.size[1]) / f64::from(SIDE);
    scene.camera.right = scene.camera.right.map(|x| x * shrink);
    scene.camera.up = scene.camera.up.map(|x| x * shrink);
    scene.camera.size = [SIDE; 2];
    scene.settings.max_depth = BOUNCES;
    if let Mode::Path(paths) = &mut scene.settings.mode {
        paths.samples = samples;
    }
}

fn render(proof: &ValidScene, seed: u64) -> Film {
    let seeds = Seeds { pixel: seed, lens: seed, path: seed };
    let job = Job { values: Values::Linear, seeds, ..Job::default() };
    pipeline::render(proof, &Plan::new(proof, Rules::ALL), &job, 1, &|_| true).unwrap().unwrap()
}

/// The mean of `(a − b)²/2 / (mean² + 0.01)`: what of it is noise.
fn relative_error(a: &Film, b: &Film) -> f64 {
    let channels = || a.image.pixels.iter().flatten().zip(b.image.pixels.iter().flatten());
    let error = |(a, b): (&f64, &f64)| {
        let mean = (a + b) / 2.0;
        (a - b) * (a - b) / 2.0 / (mean * mean + 0.01)
    };
    channels().map(error).sum::<f64>() / channels().count() as f64
}

fn triangles(proof: &ValidScene) -> usize {
    let of = |surface: &Surface| {
        if let Shape::Instance(instance) = &surface.shape { proof.meshes()[instance.mesh].triangles.len() } else { 1 }
    };
    proof.surfaces().iter().map(of).sum()
}

/// The most memory the process has held so far, in megabytes, where the system tells.
fn peak() -> Option<f64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"))?;
    Some(line.trim().strip_suffix(" kB")?.parse::<f64>().ok()? / 1024.0)
}
