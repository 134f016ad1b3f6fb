//! Renders 50 made-up scenes to an error, a few times each, and prints how many pictures keep what
//! they promise: lines of scene, seed, promised and true error in grey levels, samples a pixel.
//! `benches/honest.sh` runs it.

#![expect(clippy::print_stdout, reason = "it prints what it measured")]

#[path = "../tests/honest/scenes.rs"]
mod scenes;

const SCENES: u64 = 50;
const SEEDS: u64 = 3;
const SIZE: [u32; 2] = [48, 36];

fn main() {
    let target = std::env::args()
        .nth(1)
        .and_then(|target| target.parse().ok())
        .unwrap_or(2.0);
    let (mut kept, mut under, mut sum) = (0, 0, 0.0);
    for number in 0..SCENES {
        let scene = scenes::scene(number, SIZE);
        let references = scenes::references(&scene, target);
        for seed in 1..=SEEDS {
            let reached = scenes::render(&scene, target, seed);
            let error = scenes::error(&reached, &references);
            println!(
                "{number} {seed} {:.3} {error:.3} {:.1}",
                reached.error, reached.samples.mean
            );
            kept += u32::from(error <= reached.error);
            under += u32::from(error <= target);
            sum += error / reached.error;
        }
    }
    let all = SCENES * SEEDS;
    println!(
        "{kept} of {all} within the error said, {under} within {target}; true over said {:.3}",
        sum / all as f64
    );
}
