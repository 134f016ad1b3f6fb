//! Renders the set-up of a reference picture and says how far the two are apart: `compare
//! REFERENCE.json [SAMPLES]`.
//!
//! The set-up names the asset, the camera and the lights; `REFERENCE.exr` beside it is the picture,
//! linear. One line of JSON comes out: ratios of the means, the relative mean square error, and
//! errors of the means of blocks of 8 × 8 pixels.

#![expect(
    clippy::unwrap_used,
    clippy::print_stdout,
    clippy::disallowed_methods,
    reason = "a measurement stops at the first surprise, and reads what it compares with"
)]

mod setup;

use cpu_time::ProcessTime;
use exr::prelude::{ReadChannels as _, ReadLayers as _, read};
use rtc::internals::math::Vec3;
use rtc::internals::pipeline;
use rtc::internals::plan::{Plan, RuleSet};
use rtc::internals::render::{Film, RenderSelection, Values};
use serde_json::Value;
use std::path::Path;

/// The side of a block in pixels.
const BLOCK: usize = 8;

fn main() {
    let mut arguments = std::env::args().skip(1);
    let path = arguments
        .next()
        .expect("usage: compare REFERENCE.json [SAMPLES]");
    let samples = arguments
        .next()
        .map_or(256, |samples| samples.parse().unwrap());
    let path = Path::new(&path);
    let lowered = setup::load_set_up(path, samples);
    let proof = setup::validate(&lowered);
    let plan = Plan::new(&proof, RuleSet::ALL);
    let job = RenderSelection {
        values: Values::Linear,
        ..RenderSelection::default()
    };
    let start = ProcessTime::now();
    let film = pipeline::render(&proof, &plan, &job, 1, &|_| true)
        .unwrap()
        .unwrap();
    let seconds = start.elapsed().as_secs_f64();
    let reference = reference(&path.with_extension("exr"));
    println!("{}", report(&film, &reference, seconds));
}

/// The pixels of an EXR.
fn reference(path: &Path) -> Vec<[f64; 3]> {
    let image = read()
        .no_deep_data()
        .largest_resolution_level()
        .rgb_channels(
            |size, _| (size.width(), vec![[0.0; 3]; size.area()]),
            |(width, pixels): &mut (usize, Vec<[f64; 3]>), at, (r, g, b): (f32, f32, f32)| {
                pixels[at.y() * *width + at.x()] = [r, g, b].map(f64::from);
            },
        )
        .first_valid_layer()
        .all_attributes()
        .from_file(path)
        .unwrap();
    image.layer_data.channel_data.pixels.1
}

/// The means of blocks, row by row.
fn blocks(pixels: &[[f64; 3]], width: usize) -> Vec<Vec3> {
    let columns = width / BLOCK;
    let mut sums = vec![Vec3::ZERO; columns * (pixels.len() / width / BLOCK)];
    for (index, pixel) in pixels.iter().enumerate() {
        let (x, y) = (index % width / BLOCK, index / width / BLOCK);
        sums[y * columns + x] += Vec3::from_array(*pixel) / (BLOCK * BLOCK) as f64;
    }
    sums
}

fn report(film: &Film, reference: &[[f64; 3]], seconds: f64) -> Value {
    let width = film.image.width as usize;
    let mean = |pixels: &[[f64; 3]]| {
        pixels.iter().map(|p| Vec3::from_array(*p)).sum::<Vec3>() / pixels.len() as f64
    };
    let ratio = mean(&film.image.pixels) / mean(reference);
    let (ours, theirs) = (blocks(&film.image.pixels, width), blocks(reference, width));
    let error = |(a, b): (&Vec3, &Vec3)| ((*a - *b).abs() / (*b + 0.01)).max_element();
    let mut errors = ours
        .iter()
        .zip(&theirs)
        .map(error)
        .enumerate()
        .collect::<Vec<_>>();
    errors.sort_by(|a, b| a.1.total_cmp(&b.1));
    let at = |share: f64| errors[(share * (errors.len() - 1) as f64).round() as usize].1;
    let square = |(a, b): (&[f64; 3], &[f64; 3])| {
        (0..3)
            .map(|k| (a[k] - b[k]).powi(2) / (b[k] * b[k] + 0.01))
            .sum::<f64>()
    };
    let squares: f64 = film.image.pixels.iter().zip(reference).map(square).sum();
    let columns = width / BLOCK;
    let worst = errors.last().unwrap().0;
    serde_json::json!({
        "mean_ratio": ratio.to_array(),
        "mean_off": (ratio - 1.0).abs().max_element(),
        "rel_mse": squares / (3 * reference.len()) as f64,
        "block_median": at(0.5),
        "block_p95": at(0.95),
        "block_max": at(1.0),
        "worst_block_xy": [worst % columns * BLOCK, worst / columns * BLOCK],
        "camera_rays": film.counts.camera,
        "rays": film.counts.rays(),
        "cpu_seconds": seconds,
        "camera_rays_per_cpu_second": film.counts.camera as f64 / seconds,
    })
}
