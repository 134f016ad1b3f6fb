//! What a growing picture lacks for its goal, and the samples of its next round.

use super::metrics::LEVELS;
use super::noise::{Noise, SampleAllocation, doubled_if};
use rtc_render::{ProgressiveFilm, Replicates};

/// A target is given up with so many times the samples that its noise needs: where few pixels have
/// most of the noise, a bound that holds would take many more.
const MOST_SAMPLES: f64 = 4.0;

/// The samples that each replicate has at least before a target is met without a bound, while no
/// sample may have met light that is much brighter than white.
const LEAST_UNBOUNDED: u32 = 64;

/// What is missing for a goal, in grey levels.
enum Missing {
    Nothing,
    /// Less noise than this mean square.
    Samples(f64),
    /// More samples everywhere: no sample may have met some bright light.
    RareLight,
}

impl Missing {
    fn of(film: &ProgressiveFilm, noise: &Noise, tail: f64, error: f64) -> Self {
        let bound = noise.bound(tail, Some(error));
        let enough = error * error / (LEVELS * LEVELS * MOST_SAMPLES);
        let is_open = bound.undersampled.is_some_and(|white| white > 1.0);
        if bound.error > error && noise.square > enough {
            return Self::Samples(noise.remaining(tail, error).max(enough));
        }
        let shown = film.pixels().map(|pixel| pixel.counts()[0]).min();
        match is_open && shown.is_some_and(|count| count < LEAST_UNBOUNDED) {
            true => Self::RareLight,
            false => Self::Nothing,
        }
    }
}

/// The length of all replicates after the next round, of at most so many samples more; `None` if
/// the goal, in grey levels, is reached or nothing fits.
pub(super) fn next_round(
    film: &ProgressiveFilm,
    noise: &Noise,
    tail: f64,
    goal: Option<f64>,
    most: f64,
) -> Option<Vec<[u32; 2]>> {
    /// The step in noise if a round would change nothing, or would not fit.
    const LESS: f64 = 0.8;
    const MORE: f64 = 1.5;
    let missing = goal.map(|error| Missing::of(film, noise, tail, error));
    let mut square = match missing {
        Some(Missing::Nothing) => return None,
        Some(Missing::RareLight) => return doubled(film, most),
        _ if noise.square == 0.0 => return None,
        Some(Missing::Samples(square)) => square,
        None => noise.square / 4.0,
    };
    let allocation = SampleAllocation::of(film, noise);
    let samples = film.samples() as f64;
    let round = |square: f64| {
        let wanted = allocation.wanted(film, square);
        let all = wanted
            .iter()
            .map(|[shown, pilot]| 2.0 * f64::from(*shown) + f64::from(*pilot));
        let more = all.sum::<f64>() - samples;
        (wanted, more)
    };
    let (mut wanted, mut more) = round(square);
    while more == 0.0 {
        if goal.is_some() {
            // The pilots have not met what the replicates differ by.
            return doubled(film, most);
        }
        if square < f64::MIN_POSITIVE {
            return None;
        }
        square *= LESS;
        (wanted, more) = round(square);
    }
    while more > most {
        square *= MORE;
        (wanted, more) = round(square);
    }
    (more > 0.0).then_some(wanted)
}

/// Twice the samples in all pixels, if no more than so many are too many.
fn doubled(film: &ProgressiveFilm, most: f64) -> Option<Vec<[u32; 2]>> {
    let twice = |pixel: &Replicates| pixel.counts().map(|count| doubled_if(count, true));
    let wanted: Vec<_> = film.pixels().map(twice).collect();
    let grows = film
        .pixels()
        .zip(&wanted)
        .any(|(pixel, wanted)| pixel.counts() != *wanted);
    (grows && film.samples() as f64 <= most).then_some(wanted)
}
