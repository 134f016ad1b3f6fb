//! The stopping criterion of a progressive render, and the samples of its next round.

use super::metrics::LEVELS;
use super::noise::{Noise, SampleAllocation, doubled_if};
use rtc_render::{ProgressiveFilm, Replicates};

/// A target is abandoned at this multiple of the samples that its noise needs: where few pixels
/// have most of the noise, a valid bound would need many more.
const ABANDON_FACTOR: f64 = 4.0;

/// The minimum number of samples per replicate to accept a target without a bound, if light much
/// brighter than white may be undersampled.
const MIN_UNBOUNDED: u32 = 64;

/// What a render lacks for its target.
enum MissingSamples {
    Nothing,
    /// The noise must fall below this mean square.
    Samples(f64),
    /// All pixels need more samples: some bright light may be undersampled.
    RareLight,
}

impl MissingSamples {
    fn of(film: &ProgressiveFilm, noise: &Noise, tail: f64, error: f64) -> Self {
        let bound = noise.bound(tail, Some(error));
        let enough = error * error / (LEVELS * LEVELS * ABANDON_FACTOR);
        let is_open = bound.undersampled.is_some_and(|white| white > 1.0);
        if bound.error > error && noise.square > enough {
            return Self::Samples(noise.remaining(tail, error).max(enough));
        }
        let shown = film.pixels().map(|pixel| pixel.counts()[0]).min();
        match is_open && shown.is_some_and(|count| count < MIN_UNBOUNDED) {
            true => Self::RareLight,
            false => Self::Nothing,
        }
    }
}

/// The samples of all pixels after the next round, with at most `max_samples` additional samples;
/// `None` if the goal, in grey levels, is reached or nothing fits.
pub(super) fn next_round(
    film: &ProgressiveFilm,
    noise: &Noise,
    tail: f64,
    goal: Option<f64>,
    max_samples: f64,
) -> Option<Vec<[u32; 2]>> {
    /// The factors on the target noise if a round would change nothing, or would not fit.
    const LOWER: f64 = 0.8;
    const RAISE: f64 = 1.5;
    // Find the noise to reach.
    let missing = goal.map(|error| MissingSamples::of(film, noise, tail, error));
    let mut square = match missing {
        Some(MissingSamples::Nothing) => return None,
        Some(MissingSamples::RareLight) => return doubled(film, max_samples),
        _ if noise.square == 0.0 => return None,
        Some(MissingSamples::Samples(square)) => square,
        None => noise.square / 4.0,
    };
    // Allocate samples; lower the noise until something changes.
    let allocation = SampleAllocation::of(film, noise);
    let samples = film.samples() as f64;
    let round = |square: f64| {
        let requested = allocation.requested(film, square);
        let all = requested
            .iter()
            .map(|[shown, pilot]| 2.0 * f64::from(*shown) + f64::from(*pilot));
        let more = all.sum::<f64>() - samples;
        (requested, more)
    };
    let (mut requested, mut more) = round(square);
    while more == 0.0 {
        if goal.is_some() {
            // The pilots missed what the replicates differ by.
            return doubled(film, max_samples);
        }
        if square < f64::MIN_POSITIVE {
            return None;
        }
        square *= LOWER;
        (requested, more) = round(square);
    }
    // Raise the noise until the round fits.
    while more > max_samples {
        square *= RAISE;
        (requested, more) = round(square);
    }
    (more > 0.0).then_some(requested)
}

/// Doubles the samples of all pixels, if that takes at most `max_samples` samples.
fn doubled(film: &ProgressiveFilm, max_samples: f64) -> Option<Vec<[u32; 2]>> {
    let twice = |pixel: &Replicates| pixel.counts().map(|count| doubled_if(count, true));
    let requested: Vec<_> = film.pixels().map(twice).collect();
    let grows = film
        .pixels()
        .zip(&requested)
        .any(|(pixel, requested)| pixel.counts() != *requested);
    (grows && film.samples() as f64 <= max_samples).then_some(requested)
}
