//! A benchmark that compares the times of several cases: in rounds, each in a new random order, so
//! that a slow phase of the machine affects all cases. Times are processor times of one thread, so
//! other load has little effect.

use super::runtime::Time;
use super::setting::Setting;
use super::spread::ReseededRenders;
use super::statistics::{Estimate, SplitMix64, median};
use super::subject::{RenderedTiles, Stopped, StudySubject};
use rtc_image::Image;
use rtc_ir as ir;

/// A case of a benchmark.
pub(super) struct BenchmarkCase<'a> {
    pub(super) subject: StudySubject<'a>,
    pub(super) setting: Setting,
}

/// The result of a case.
pub(super) struct TimedRun {
    pub(super) rendered: RenderedTiles,
    /// Seconds for the whole picture.
    pub(super) seconds: Estimate,
    /// The seconds over those of the first case.
    pub(super) ratio: Estimate,
    /// The mean square error of each render against the reference, if one was given.
    pub(super) squares: Vec<f64>,
    /// Whether some of its renders were done before the study was interrupted.
    pub(super) is_resumed: bool,
}

/// The results of all cases.
pub(super) struct Benchmark {
    pub(super) runs: Vec<TimedRun>,
    /// Wall time over processor time of all renders: above 1 the machine had other load.
    pub(super) wall_over_cpu: f64,
}

const MIN_ROUNDS: u64 = 3;
const MAX_ROUNDS: u64 = 9;

/// The maximum number of renders of a case in a round. A render of a few milliseconds is too short
/// to be timed alone.
const MAX_REPEATS: u64 = 8;

/// Tiles with less than this many times the work of preparing the picture are too few to be timed:
/// their time would be the difference of two that are nearly equal.
const MIN_WORK: u64 = 4;

/// In their place the whole picture is timed, if that takes at most so many times the budget.
const MAX_EXCESS: u64 = 4;

/// Times all cases in at least three rounds, with about `budget` rays in all. Cases with few rays
/// run in more rounds, and several times in each. With a reference, each render of a case after the
/// first has its own seeds.
pub(super) fn benchmark(
    cases: &[BenchmarkCase<'_>],
    budget: u64,
    reference: Option<&[Image]>,
    rng: &mut SplitMix64,
) -> Result<Benchmark, Stopped> {
    // Run the cases in rounds, each in a new random order.
    let mut timings: Vec<_> = cases.iter().map(|_| Timings::default()).collect();
    for round in 0..MAX_ROUNDS {
        let mut order: Vec<_> = (0..cases.len())
            .filter(|index| timings[*index].rounds > round || *index == 0)
            .collect();
        if round >= MIN_ROUNDS && order.len() < 2 {
            break;
        }
        rng.shuffle(&mut order);
        timings
            .iter_mut()
            .for_each(|timings| timings.times.push(None));
        for index in order {
            timings[index].add(&cases[index], budget / cases.len() as u64, reference)?;
        }
    }
    // Extrapolate the times of tiles to the whole picture.
    let mut overheads = Overheads::default();
    let wholes: Vec<Vec<Option<f64>>> = cases
        .iter()
        .zip(&timings)
        .map(|(case, timings)| overheads.whole_picture(case, timings, rng))
        .collect();
    // Compare wall time with processor time.
    let times = timings
        .iter()
        .flat_map(|timings| timings.times.iter().flatten());
    let total = |of: fn(&Time) -> f64| times.clone().map(of).sum::<f64>();
    let wall_over_cpu = total(|time| time.wall) / total(|time| time.cpu).max(1e-9);
    // Summarise each case: median time and median ratio to the first case.
    let run = |(timings, seconds): (Timings, &Vec<Option<f64>>)| {
        let ratios: Vec<_> = seconds
            .iter()
            .zip(&wholes[0])
            .filter_map(|(ours, first)| Some((*ours)? / (*first)?))
            .collect();
        let seconds: Vec<_> = seconds.iter().flatten().copied().collect();
        Some(TimedRun {
            rendered: timings.rendered?,
            seconds: median(&seconds, rng),
            ratio: median(&ratios, rng),
            squares: timings.squares,
            is_resumed: timings.is_resumed,
        })
    };
    Ok(Benchmark {
        runs: timings.into_iter().zip(&wholes).filter_map(run).collect(),
        wall_over_cpu,
    })
}

impl StudySubject<'_> {
    /// The approximate cost of preparing a render, in rays: a triangle costs as much as a ray, and
    /// so do 512 texels of images or, if only tiles are rendered, 8 pixels of the picture.
    fn preparation_rays(&self) -> u64 {
        const TEXELS_PER_RAY: u64 = 512;
        const PIXELS_PER_RAY: u64 = 8;
        let triangles = self
            .scene
            .meshes
            .iter()
            .map(|mesh| mesh.triangles.len() as u64);
        let pixels = |image: &ir::Image| u64::from(image.width) * u64::from(image.height);
        let [width, height] = self.scene.camera.size.map(u64::from);
        let shown = if self.is_whole() {
            0
        } else {
            width * height / PIXELS_PER_RAY
        };
        triangles.sum::<u64>()
            + self.scene.images.iter().map(pixels).sum::<u64>() / TEXELS_PER_RAY
            + shown
    }
}

/// The timings of a case so far.
struct Timings {
    rendered: Option<RenderedTiles>,
    /// The time of each round; `None` where the case did not run.
    times: Vec<Option<Time>>,
    squares: Vec<f64>,
    is_resumed: bool,
    /// The rounds that it runs in, and its renders in each.
    rounds: u64,
    repeats: u64,
    /// Whether whole pictures are timed, not tiles.
    is_of_whole: bool,
}

impl Default for Timings {
    fn default() -> Self {
        Self {
            rendered: None,
            times: Vec::new(),
            squares: Vec::new(),
            is_resumed: false,
            rounds: MIN_ROUNDS,
            repeats: 1,
            is_of_whole: false,
        }
    }
}

impl Timings {
    /// Runs a round; the first one decides how many follow within the budget.
    fn add(
        &mut self,
        case: &BenchmarkCase<'_>,
        budget: u64,
        reference: Option<&[Image]>,
    ) -> Result<(), Stopped> {
        let BenchmarkCase { subject, setting } = case;
        let is_first = self.rendered.is_none();
        let before = self.squares.len() as u64;
        let timed = subject.time(
            *setting,
            is_first,
            ReseededRenders { reference, before },
            |rendered| {
                if is_first {
                    self.choose(subject, rendered.counts.rays(), budget);
                }
                self.repeats
            },
        )?;
        let time = if self.is_of_whole {
            let seeds = ReseededRenders {
                reference: None,
                before,
            };
            subject.whole().time(*setting, false, seeds, |_| 1)?.time
        } else {
            timed.time
        };
        self.is_resumed |= timed.is_resumed;
        self.squares.extend(timed.squares);
        self.rendered.get_or_insert(timed.rendered);
        if let Some(slot) = self.times.last_mut() {
            *slot = Some(time);
        }
        Ok(())
    }

    /// Chooses what is timed and how often, by the rays of a render.
    fn choose(&mut self, subject: &StudySubject<'_>, rays: u64, budget: u64) {
        let preparation = subject.preparation_rays();
        let whole = (rays as f64 / subject.fraction()) as u64 + preparation;
        self.is_of_whole = !subject.is_whole()
            && rays < MIN_WORK * preparation
            && whole * MIN_ROUNDS <= MAX_EXCESS * budget;
        let work = if self.is_of_whole {
            whole
        } else {
            preparation + rays
        };
        let fair = budget / work.max(1);
        self.repeats = match self.is_of_whole {
            true => 1,
            false => (fair / MAX_ROUNDS).clamp(1, MAX_REPEATS),
        };
        self.rounds = (fair / self.repeats).clamp(MIN_ROUNDS, MAX_ROUNDS);
    }
}

/// A cache of the seconds for preparing a scene and for skipping all pixels; they do not depend
/// much on the setting.
#[derive(Default)]
struct Overheads<'a> {
    cached: Vec<(BenchmarkCase<'a>, [f64; 2])>,
}

impl<'a> Overheads<'a> {
    fn of(&mut self, case: &BenchmarkCase<'a>, rng: &mut SplitMix64) -> [f64; 2] {
        const ROUNDS: usize = 5;
        let BenchmarkCase { subject, setting } = case;
        let is_alike = |(other, _): &&(BenchmarkCase<'a>, [f64; 2])| {
            other.subject.is_of_scene_of(subject) && other.setting.precision == setting.precision
        };
        if let Some((_, cached)) = self.cached.iter().find(is_alike) {
            return *cached;
        }
        let rounds = subject.time_overhead(*setting, ROUNDS);
        let overhead = [0, 1].map(|which| {
            let seconds: Vec<_> = rounds.iter().map(|round| round[which]).collect();
            median(&seconds, rng).value
        });
        let case = BenchmarkCase {
            subject: subject.clone(),
            setting: *setting,
        };
        self.cached.push((case, overhead));
        overhead
    }

    /// Extrapolates the times of tiles to the whole picture: preparation takes the same time for
    /// both, and skipping pixels does not belong to a whole picture.
    fn whole_picture(
        &mut self,
        case: &BenchmarkCase<'a>,
        Timings {
            times, is_of_whole, ..
        }: &Timings,
        rng: &mut SplitMix64,
    ) -> Vec<Option<f64>> {
        if case.subject.is_whole() || *is_of_whole {
            let cpu = |time: &Option<Time>| time.as_ref().map(|time| time.cpu);
            return times.iter().map(cpu).collect();
        }
        let [prepare, pass] = self.of(case, rng);
        let fraction = case.subject.fraction();
        let whole = |time: &Time| prepare + (time.cpu - prepare - pass).max(0.0) / fraction;
        times.iter().map(|time| time.as_ref().map(whole)).collect()
    }
}
