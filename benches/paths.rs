//! How fast paths are traced: `paths FILE [SAMPLES [SECONDS]]` renders an asset, or the set-up of a
//! reference, in 512 × 512 pixels with paths of 8 bounces on one thread.
//!
//! One row of Markdown comes out: triangles, camera samples per CPU-second, CPU-seconds from the
//! start of the process to the picture, the peak of memory until then; and, if `SECONDS` are given,
//! the error a picture of 256 × 256 pixels has after so much CPU time, measured against one of 16
//! times the samples and other random numbers.

#![expect(
    clippy::unwrap_used,
    clippy::print_stdout,
    clippy::disallowed_methods,
    reason = "a measurement stops at the first surprise, and asks the system what it took"
)]

mod setup;

use cpu_time::ProcessTime;
use rtc::diag::Sink;
use rtc::ir::{Lowered, Mode, Scene};
use rtc::passes::Stage;
use rtc::pipeline;
use rtc::plan::{Plan, Rules};
use rtc::render::{Film, Job, Seeds, Values};
use rtc::valid::{Proof, Shape, Surface};
use std::path::Path;

/// Pixels along each side, where the speed is measured and where the error is.
const SIDES: [u32; 2] = [512, 256];

/// Samples of the picture an error is measured against, to those of the other: their noise is so
/// much less.
const LONGER: u32 = 16;

const BOUNCES: u32 = 8;

fn main() {
    let mut arguments = std::env::args().skip(1);
    let path = arguments.next().expect("usage: paths FILE [SAMPLES]");
    let samples = arguments
        .next()
        .map_or(64, |samples| samples.parse().unwrap());
    let path = Path::new(&path);
    let seconds = arguments
        .next()
        .map(|seconds| seconds.parse::<f64>().unwrap());
    let mut lowered = if path
        .extension()
        .is_some_and(|extension| extension == "json")
    {
        setup::load_set_up(path, samples)
    } else {
        let mut lowered = setup::load(path);
        pipeline::stage(&mut lowered, &Stage::default(), true, &mut Sink::default());
        lowered
    };
    resize(&mut lowered.scene, SIDES[0], samples);
    let proof = setup::prove(&lowered);
    let start = ProcessTime::now();
    let film = render(&proof, 0);
    let (took, whole) = (
        start.elapsed().as_secs_f64(),
        ProcessTime::now().as_duration().as_secs_f64(),
    );
    let peak = peak().map_or("–".to_owned(), |megabytes| format!("{megabytes:.0}"));
    let (rate, name) = (
        film.counts.camera as f64 / took,
        path.file_stem().unwrap().to_string_lossy(),
    );
    let error = seconds.map_or("–".to_owned(), |seconds| {
        format!("{:.5}", error_after(rate * seconds, &mut lowered))
    });
    let (triangles, rate) = (triangles(&proof), rate / 1e6);
    println!("| {name} | {triangles} | {samples} | {rate:.2} | {whole:.1} | {peak} | {error} |");
}

/// The error of a picture of so many samples in all.
fn error_after(samples: f64, lowered: &mut Lowered) -> f64 {
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "a few thousand at most"
    )]
    let samples = (samples / f64::from(SIDES[1] * SIDES[1])).round().max(1.0) as u32;
    resize(&mut lowered.scene, SIDES[1], samples);
    let film = render(&setup::prove(lowered), 0);
    resize(&mut lowered.scene, SIDES[1], LONGER * samples);
    relative_error(&film, &render(&setup::prove(lowered), 1))
}

/// The same view in pixels and paths of the number wanted.
fn resize(scene: &mut Scene, side: u32, samples: u32) {
    let shrink = f64::from(scene.camera.size[1]) / f64::from(side);
    scene.camera.right = scene.camera.right.map(|x| x * shrink);
    scene.camera.up = scene.camera.up.map(|x| x * shrink);
    scene.camera.size = [side; 2];
    scene.settings.max_depth = BOUNCES;
    if let Mode::Path(paths) = &mut scene.settings.mode {
        paths.samples = samples;
    }
}

fn render(proof: &Proof, seed: u64) -> Film {
    let seeds = Seeds {
        pixel: seed,
        lens: seed,
        path: seed,
    };
    let job = Job {
        values: Values::Linear,
        seeds,
        ..Job::default()
    };
    pipeline::render(proof, &Plan::new(proof, Rules::ALL), &job, 1, &|_| true)
        .unwrap()
        .unwrap()
}

/// The mean of `(a − b)² / (b² + 0.01)`.
fn relative_error(film: &Film, truth: &Film) -> f64 {
    let channels = || {
        film.image
            .pixels
            .iter()
            .flatten()
            .zip(truth.image.pixels.iter().flatten())
    };
    channels()
        .map(|(a, b)| (a - b) * (a - b) / (b * b + 0.01))
        .sum::<f64>()
        / channels().count() as f64
}

fn triangles(proof: &Proof) -> usize {
    let of = |surface: &Surface| {
        if let Shape::Instance(instance) = &surface.shape {
            proof.meshes()[instance.mesh].triangles.len()
        } else {
            1
        }
    };
    proof.surfaces().iter().map(of).sum()
}

/// The most memory the process has held so far, in megabytes, where the system tells.
fn peak() -> Option<f64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status
        .lines()
        .find_map(|line| line.strip_prefix("VmHWM:"))?;
    Some(line.trim().strip_suffix(" kB")?.parse::<f64>().ok()? / 1024.0)
}
