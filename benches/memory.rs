//! The memory of this machine: `memory` prints one line of JSON for arrays of several sizes, from
//! within the first cache to far beyond the last: the bandwidth of a triad, a(i) = b(i) + s·c(i), in
//! GB/s with its three streams counted; the latency of loads that each wait for the one before, in
//! ns; and a cycle of the core, in ns. One thread; best of several rounds.

#![expect(
    clippy::print_stdout,
    clippy::disallowed_methods,
    reason = "a measurement has a clock, and prints"
)]

use serde_json::json;
use std::hint::black_box;
use std::time::Instant;

/// Bytes touched in all.
const SIZES: [usize; 5] = [24 << 10, 384 << 10, 6 << 20, 24 << 20, 384 << 20];

const ROUNDS: usize = 5;

/// Bytes that a round of a triad moves at least.
const MOVED: usize = 1 << 29;

/// Loads of a round, one after the other.
const LOADS: usize = 1 << 21;

/// Products of a round, each with a sum without carry and after the one before, and the cycles of
/// both on all cores of the last ten years.
const PRODUCTS: usize = 1 << 26;
const CYCLES: usize = 4;

/// Words of a line of the cache.
const LINE: usize = 16;

fn main() {
    let cycle = cycle();
    for bytes in SIZES {
        let (bandwidth, latency) = (triad(bytes), chase(bytes));
        let row = json!({
            "bytes": bytes,
            "triad_gb_per_s": bandwidth / 1e9,
            "latency_ns": 1e9 * latency,
            "cycle_ns": 1e9 * cycle,
        });
        println!("{row}");
    }
}

/// The least time of some rounds, in seconds.
fn best(mut round: impl FnMut()) -> f64 {
    let times = (0..ROUNDS).map(|_| {
        let start = Instant::now();
        round();
        start.elapsed().as_secs_f64()
    });
    times.fold(f64::INFINITY, f64::min)
}

/// Bytes a second that go through three arrays of so many bytes in all.
fn triad(bytes: usize) -> f64 {
    let length = bytes / (3 * size_of::<f64>());
    let (mut a, b, c) = (vec![0.0; length], vec![1.0; length], vec![2.0; length]);
    let repeats = MOVED.div_ceil(bytes);
    let seconds = best(|| {
        for _ in 0..repeats {
            for ((a, b), c) in a.iter_mut().zip(&b).zip(&c) {
                *a = *b + 3.0 * *c;
            }
            black_box(&mut a);
        }
    });
    (repeats * 3 * length * size_of::<f64>()) as f64 / seconds
}

/// Seconds a load takes that depends on the one before, each in another line of so many bytes.
fn chase(bytes: usize) -> f64 {
    let lines = bytes / (LINE * size_of::<u32>());
    // Sattolo's algorithm: one cycle through all lines.
    let mut order: Vec<_> = (0..lines).collect();
    let mut state = 1_u64;
    for last in (1..lines).rev() {
        state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1);
        order.swap(last, (state >> 33) as usize % last);
    }
    let mut next = vec![0_u32; lines * LINE];
    for (line, follower) in order.into_iter().enumerate() {
        next[line * LINE] = u32::try_from(follower * LINE).unwrap_or(0);
    }
    let mut at = 0;
    best(|| {
        for _ in 0..LOADS {
            at = next[at as usize];
        }
        black_box(at);
    }) / LOADS as f64
}

/// Seconds of a cycle.
fn cycle() -> f64 {
    let mut product = black_box(3_u64);
    let factor = black_box(5_u64);
    let seconds = best(|| {
        for _ in 0..PRODUCTS {
            product = product.wrapping_mul(factor) ^ factor;
        }
        black_box(product);
    });
    seconds / (PRODUCTS * CYCLES) as f64
}
