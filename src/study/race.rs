//! Renders timed against each other: in rounds, each in a new random order, so that a slow phase of
//! the machine affects all. Times are processor times of one thread, so other load has little
//! effect.

use super::bench::Time;
use super::setting::Setting;
use super::statistics::{Estimate, Rng, median};
use super::subject::{RenderedTiles, Stopped, Subject};

/// A runner.
pub(super) struct Runner<'a> {
    pub(super) subject: Subject<'a>,
    pub(super) setting: Setting,
}

/// The result of a runner.
pub(super) struct TimedRun {
    pub(super) shot: RenderedTiles,
    /// Seconds for the whole picture.
    pub(super) seconds: Estimate,
    /// Seconds over those of the first runner.
    pub(super) ratio: Estimate,
    /// Whether some of its renders were done before the study was interrupted.
    pub(super) is_resumed: bool,
}

/// The results of all runners.
pub(super) struct Race {
    pub(super) runs: Vec<TimedRun>,
    /// Wall time over processor time of all renders: above 1 others used the machine.
    pub(super) wall_over_cpu: f64,
}

const FEWEST_ROUNDS: u64 = 3;
const MOST_ROUNDS: u64 = 9;

/// The maximum number of renders of a runner in a round. Renders of a few milliseconds are too short to
/// time on a noisy machine.
const MOST_REPEATS: u64 = 8;

/// Times all runners in at least three rounds, those that take few rays in more and several times
/// in each, of about `budget` rays in all.
pub(super) fn race(runners: &[Runner<'_>], budget: u64, rng: &mut Rng) -> Result<Race, Stopped> {
    let mut shots: Vec<Option<RenderedTiles>> = runners.iter().map(|_| None).collect();
    let mut times: Vec<Vec<Option<Time>>> = vec![Vec::new(); runners.len()];
    let mut resumed = vec![false; runners.len()];
    let (mut rounds, mut repeats) = (vec![FEWEST_ROUNDS; runners.len()], vec![1; runners.len()]);
    for round in 0..MOST_ROUNDS {
        let mut order: Vec<_> = (0..runners.len())
            .filter(|index| rounds[*index] > round || *index == 0)
            .collect();
        if round >= FEWEST_ROUNDS && order.len() < 2 {
            break;
        }
        rng.shuffle(&mut order);
        times.iter_mut().for_each(|times| times.push(None));
        for index in order {
            let Runner { subject, setting } = &runners[index];
            let is_first = shots[index].is_none();
            let timed = subject.time(*setting, is_first, |shot| {
                if is_first {
                    let work = subject.preparing() + shot.counts.rays();
                    let fair = budget / runners.len() as u64 / work.max(1);
                    repeats[index] = (fair / MOST_ROUNDS).clamp(1, MOST_REPEATS);
                    rounds[index] = (fair / repeats[index]).clamp(FEWEST_ROUNDS, MOST_ROUNDS);
                }
                repeats[index]
            })?;
            resumed[index] |= timed.is_resumed;
            shots[index].get_or_insert(timed.shot);
            if let Some(place) = times[index].last_mut() {
                *place = Some(timed.time);
            }
        }
    }
    let mut overheads = Overheads::default();
    let wholes: Vec<Vec<Option<f64>>> = runners
        .iter()
        .zip(&times)
        .map(|(runner, times)| overheads.whole_picture(runner, times, rng))
        .collect();
    let runs = shots.into_iter().flatten().zip(&wholes).zip(resumed).map(
        |((shot, seconds), is_resumed)| {
            let ratios: Vec<_> = seconds
                .iter()
                .zip(&wholes[0])
                .filter_map(|(ours, first)| Some((*ours)? / (*first)?))
                .collect();
            let seconds: Vec<_> = seconds.iter().flatten().copied().collect();
            TimedRun {
                shot,
                seconds: median(&seconds, rng),
                ratio: median(&ratios, rng),
                is_resumed,
            }
        },
    );
    let runs = runs.collect();
    let total = |of: fn(&Time) -> f64| times.iter().flatten().flatten().map(of).sum::<f64>();
    Ok(Race {
        runs,
        wall_over_cpu: total(|time| time.wall) / total(|time| time.cpu).max(1e-9),
    })
}

/// The seconds for preparing a scene and for skipping all pixels, of those that were timed: they hardly depend
/// on the setting.
#[derive(Default)]
struct Overheads<'a> {
    known: Vec<(Runner<'a>, [f64; 2])>,
}

impl<'a> Overheads<'a> {
    fn of(&mut self, runner: &Runner<'a>, rng: &mut Rng) -> [f64; 2] {
        const ROUNDS: usize = 5;
        let Runner { subject, setting } = runner;
        let is_alike = |(other, _): &&(Runner<'a>, [f64; 2])| {
            other.subject.is_of_scene_of(subject) && other.setting.precision == setting.precision
        };
        if let Some((_, known)) = self.known.iter().find(is_alike) {
            return *known;
        }
        let rounds = subject.time_overhead(*setting, ROUNDS);
        let overhead = [0, 1].map(|which| {
            let seconds: Vec<_> = rounds.iter().map(|round| round[which]).collect();
            median(&seconds, rng).value
        });
        let runner = Runner {
            subject: subject.clone(),
            setting: *setting,
        };
        self.known.push((runner, overhead));
        overhead
    }

    /// The time for the whole picture, from that of its part: preparing the scene takes the same for
    /// both, and skipping the other pixels does not belong to a picture.
    fn whole_picture(
        &mut self,
        runner: &Runner<'a>,
        times: &[Option<Time>],
        rng: &mut Rng,
    ) -> Vec<Option<f64>> {
        if runner.subject.is_whole() {
            let cpu = |time: &Option<Time>| time.as_ref().map(|time| time.cpu);
            return times.iter().map(cpu).collect();
        }
        let [prepare, pass] = self.of(runner, rng);
        let fraction = runner.subject.fraction();
        let whole = |time: &Time| prepare + (time.cpu - prepare - pass).max(0.0) / fraction;
        times.iter().map(|time| time.as_ref().map(whole)).collect()
    }
}
