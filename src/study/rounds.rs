//! The stopping criterion of a progressive render, and the samples of its next round.

use super::metrics::LEVELS;
use super::noise::{FilmNoise, SampleAllocation, doubled_if};
use rtc_render::{ProgressiveFilm, Replicates};

/// The largest multiple of the samples that its noise needs that a render takes for a valid bound.
const MAX_SAFETY: f64 = 3.0;

/// Where few pixels have most of the noise, a valid bound would need more. Then a render ends at
/// this multiple; a last round may double it.
const ABANDON_FACTOR: f64 = 1.5;

/// The minimum number of samples per replicate to accept a target without a bound, if light much
/// brighter than white may be undersampled.
const MIN_UNBOUNDED: u32 = 64;

/// The number of samples per replicate up to which all pixels are refined so that the bound counts
/// undersampled light. Where that many would not do, [`MIN_UNBOUNDED`] are taken.
const MAX_UNBOUNDED: u32 = 1 << 14;

/// Of those, so many are taken in any case, and by then rare light shows in the noise. More are
/// taken only where a valid bound on the noise needs them as well: a bound on what may be
/// undersampled is not worth many times the picture.
const CHEAP_UNBOUNDED: u32 = 1 << 10;

/// Where all pixels get samples, a replicate has at least this many for each one of its pilot.
const PILOT_SHARE: u32 = 8;

/// The lack of a render relative to its target.
enum MissingSamples {
    Nothing,
    /// The noise must fall below this mean square.
    Samples(f64),
    /// All pixels need this many samples per replicate: some bright light may be undersampled.
    RareLight(u32),
}

impl MissingSamples {
    /// Where bright light may be undersampled, all pixels come first: pilots that have not hit it
    /// would skip some of them.
    fn of(film: &ProgressiveFilm, noise: &FilmNoise, tail: f64, error: f64) -> Self {
        let bound = noise.bound(tail, Some(error));
        let is_open = bound.undersampled.is_some_and(|white| white > 1.0);
        let source = noise.undersampled.source;
        let shown = film.pixels().map(|pixel| pixel.counts()[0]).min();
        let share = noise.square * MAX_SAFETY * LEVELS * LEVELS / (error * error);
        let needed = shown.map_or(0.0, |count| f64::from(count) * share);
        let closing = source.closing(error, MAX_UNBOUNDED);
        let most = closing.map_or(MIN_UNBOUNDED, |most| match f64::from(most) <= needed {
            true => most,
            false => most.min(CHEAP_UNBOUNDED),
        });
        if is_open && shown.is_some_and(|count| count < most) {
            return Self::RareLight(most);
        }
        let multiple = match noise.safety_factor(tail) <= MAX_SAFETY {
            true => MAX_SAFETY,
            false => ABANDON_FACTOR,
        };
        let enough = error * error / (LEVELS * LEVELS * multiple);
        match bound.error > error && noise.square > enough {
            true => Self::Samples(noise.remaining(tail, error).max(enough)),
            false => Self::Nothing,
        }
    }
}

/// The samples of all pixels after the next round, with at most `max_samples` additional samples;
/// `None` if the goal, in grey levels, is reached or nothing fits.
pub(super) fn next_round(
    film: &ProgressiveFilm,
    noise: &FilmNoise,
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
        Some(MissingSamples::RareLight(most)) if film.samples() as f64 <= max_samples => {
            return doubled(film, most, max_samples);
        }
        _ if noise.square == 0.0 => return None,
        Some(MissingSamples::Samples(square)) => square,
        // In the second case the time ends first.
        None | Some(MissingSamples::RareLight(_)) => noise.square / 4.0,
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
            // The pilots did not find the difference of the replicates.
            return doubled(film, u32::MAX, max_samples);
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

/// Doubles the samples of all pixels with fewer than `most` per replicate, if that takes at most
/// `max_samples` samples.
fn doubled(film: &ProgressiveFilm, most: u32, max_samples: f64) -> Option<Vec<[u32; 2]>> {
    let twice = |pixel: &Replicates| {
        let [shown, pilot] = pixel.counts();
        let shown = doubled_if(shown, shown < most);
        [shown, doubled_if(pilot, PILOT_SHARE * pilot <= shown)]
    };
    let requested: Vec<_> = film.pixels().map(twice).collect();
    let grows = film
        .pixels()
        .zip(&requested)
        .any(|(pixel, requested)| pixel.counts() != *requested);
    (grows && film.samples() as f64 <= max_samples).then_some(requested)
}
