//! Rendering to a target: rounds of samples where they are needed, until an error is reached.
//!
//! The true picture is the limit of many sub-samples, lens points and points of soft lights, or of
//! many paths, at the scene's own depth and with its own lobes; a light sampled at its centre alone
//! stays so. Rounds are decided by the
//! whole film: a target error alone gives the same picture on any number of threads.

use super::budget::{self, CoarsePicture};
use super::noise::Noise;
use super::parameter::{Parameter, not_applicable};
use super::progressive::{CheckpointSink, Checkpointer, ProgressiveRender};
use super::rounds::next_round;
use super::subject::Stopped;
use super::undersampled::Undersampled;
use rtc_color::Tone;
use rtc_image::Image;
use rtc_ir::{Pattern, Scene};
use rtc_render::{
    AnyWorld, Background, Counts, Crop, Film, Job, OnPixel, ProgressiveFilm, Tiles, Values,
};
use rtc_valid::revalidate;
use std::time::Duration;

/// When to stop; with both, whichever comes first.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Goal {
    /// The root mean square error in grey levels of 8 bits, of display values.
    pub error: Option<f64>,
    /// When the picture is to be ready, by the clock of [`Watch::elapsed`]. There is at least one sample
    /// of each replicate in one pixel of 8 × 8.
    pub time: Option<Duration>,
}

/// What is to be rendered.
#[derive(Clone, Copy, Debug)]
pub struct Order {
    /// When to stop.
    pub goal: Goal,
    /// The part of the picture, within it.
    pub crop: Crop,
    /// The background, where paths are traced.
    pub background: Background,
    /// What the picture holds; errors are those of display values in any case.
    pub values: Values,
    /// How values are shown, and what they are multiplied by before, where paths are traced.
    pub display: (Tone, f64),
    /// Whether soft lights keep their number of points. Otherwise it is chosen.
    pub keep_lights: bool,
    /// Where sampling starts: another seed gives independent noise.
    pub seed: u64,
}

/// The observer of a render in progress.
pub struct Watch<'a> {
    /// Called from all threads after each pixel with the rays it took; false means stop.
    pub on_pixel: &'a OnPixel<'a>,
    /// Whether the user said stop, rather than the time ran out.
    pub is_stopped: &'a (dyn Fn() -> bool + Sync),
    /// The time since the start, from which a time allowed counts.
    pub elapsed: &'a (dyn Fn() -> Duration + Sync),
    /// Called before each round, also while the setting is chosen.
    pub round: &'a (dyn Fn(Progress) + Sync),
}

/// The progress before a round.
#[derive(Clone, Copy, Debug)]
pub struct Progress {
    /// The pixels that the round looks at.
    pub pixels: u64,
    /// The bound on the error so far, in grey levels; none before the first round.
    pub error: Option<f64>,
}

/// The samples of the pixels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Samples {
    /// Of the pixel with the fewest samples.
    pub min: u64,
    /// In the mean.
    pub mean: f64,
    /// Of the pixel with the most samples.
    pub most: u64,
}

/// A picture and its error.
#[derive(Clone, Debug)]
pub struct TargetResult {
    /// The picture.
    pub image: Image,
    /// Of each pixel the fraction of the samples that met a surface.
    pub coverage: Vec<f32>,
    /// Its rays, including those for the choice of the setting, without those of an unfinished round.
    pub counts: Counts,
    /// The root mean square error in grey levels, kept in 90 % of all renders, as `benches/honest.sh`
    /// counts; of what samples met alone, if there is no bound.
    pub error: f64,
    /// If there is no bound: how bright, in multiples of white, light may be that no sample met.
    pub undersampled: Option<f64>,
    /// If the time ended before each pixel had a sample; there is no bound on its error then.
    pub coarse: Option<CoarsePicture>,
    /// Its samples.
    pub samples: Samples,
    /// Points of each soft light at a hit.
    pub light_samples: u32,
}

/// The fraction of pictures that may be worse than promised.
pub(super) const TAIL: f64 = 0.05;

/// The samples of all pixels together in the first round, per replicate: enough also for pictures
/// of few pixels.
const FIRST: usize = 1024;

/// The least samples of a replicate in the first round where paths are traced: sRGB coding of a
/// mean of very few samples does not represent that of many.
const FIRST_PATHS: usize = 8;

/// The least samples of a pilot: their variance is known.
const FIRST_PILOT: u32 = 2;

/// Renders a proven scene in its world until the goal is reached, on the threads of the current
/// pool.
///
/// # Errors
/// If someone said stop.
pub fn approach(
    world: &mut AnyWorld,
    scene: &Scene,
    order: &Order,
    watch: &Watch<'_>,
) -> Result<TargetResult, Stopped> {
    approach_keeping(world, scene, order, watch, None)
}

/// As [`approach`], but what is done is kept on the way, and what was kept before is gone on from.
///
/// # Errors
/// If someone said stop; what is done is kept then.
pub fn approach_keeping(
    world: &mut AnyWorld,
    scene: &Scene,
    order: &Order,
    watch: &Watch<'_>,
    sink: Option<CheckpointSink<'_>>,
) -> Result<TargetResult, Stopped> {
    let mut samples = Parameter::ALL
        .into_iter()
        .filter(|parameter| parameter.samples_pixels());
    if samples.all(|parameter| not_applicable(parameter, scene).is_some()) {
        return render_unsampled(world, order, watch);
    }
    let scene_samples = world.scene().clone();
    let result = match order.goal.time {
        Some(time) => budget::render_within(world, scene, order, watch, time),
        None => in_rounds(world, scene, order, watch, sink.map(Checkpointer::new)),
    };
    world.change(scene_samples);
    result
}

/// As [`approach`], for a scene that is sampled; the world is left in another setting.
fn in_rounds(
    world: &mut AnyWorld,
    scene: &Scene,
    order: &Order,
    watch: &Watch<'_>,
    mut checkpointer: Option<Checkpointer<'_>>,
) -> Result<TargetResult, Stopped> {
    let mut progressive = match checkpointer.as_mut().and_then(Checkpointer::resumed_from) {
        Some(resumed_from) => resumed_from,
        None => {
            let (light_samples, tried) = light_samples(world, scene, order, watch)?;
            let mut progressive = begin(light_samples, order);
            progressive.film.counts = tried;
            progressive.wanted = vec![first_round(scene, order, world); progressive.film.len()];
            progressive
        }
    };
    set_sampling(world, scene, progressive.light_samples);
    let undersampled = order.undersampled(world);
    let mut error = None;
    loop {
        let pixels = progressive.film.len() as u64;
        (watch.round)(Progress { pixels, error });
        if !progressive.refine(world, watch.on_pixel, checkpointer.as_mut()) {
            return Err(Stopped);
        }
        let noise = Noise::of(&progressive.film, &undersampled);
        let tail = tail_of(progressive.rounds + 1);
        let bound = noise.bound(tail, order.goal.error);
        let goal = order.goal.error;
        let Some(wanted) = next_round(&progressive.film, &noise, tail, goal, f64::INFINITY) else {
            checkpointer
                .iter()
                .for_each(|checkpointer| checkpointer.save(&progressive));
            return Ok(progressive.result(bound, order.values));
        };
        (progressive.wanted, error) = (wanted, Some(bound.error));
        progressive.rounds += 1;
    }
}

/// The probability of a larger error than is said after so many rounds. A stop at any round is one
/// of many looks: the tails of all rounds, 1/(r(r + 1)), sum to the one allowed.
pub(super) fn tail_of(rounds: u32) -> f64 {
    let round = f64::from(rounds);
    TAIL / (round * (round + 1.0))
}

/// A picture without samples, of so many points of each soft light.
pub(super) fn begin(light_samples: u32, order: &Order) -> ProgressiveRender {
    ProgressiveRender {
        film: order.film(),
        wanted: Vec::new(),
        rounds: 0,
        light_samples,
        keeps_lights: order.keep_lights,
    }
}

/// The samples of each replicate, and of the pilot, that all pixels are to have before it is decided
/// which have more.
pub(super) fn first_round(scene: &Scene, order: &Order, world: &AnyWorld) -> [u32; 2] {
    let min = if not_applicable(Parameter::Paths, scene).is_none() {
        FIRST_PATHS
    } else {
        1
    };
    let pixels = order.crop.pixels().max(1);
    let first = FIRST.div_ceil(pixels).max(min).next_power_of_two();
    let goal = order.goal.error;
    let least = goal.map_or(1, |error| order.undersampled(world).least(error));
    let first = u32::try_from(first).unwrap_or(1).max(least);
    [first, (first / 2).max(FIRST_PILOT)]
}

impl Order {
    /// A film without samples.
    pub(super) fn film(&self) -> ProgressiveFilm {
        let mut film = ProgressiveFilm::new(self.crop, self.seed);
        (film.background, film.display) = (self.background, self.display);
        film
    }

    /// What samples of a world may show.
    pub(super) fn undersampled(&self, world: &AnyWorld) -> Undersampled {
        let (_, exposure) = self.display;
        Undersampled {
            brightest: (world.brightest() * exposure).max(1.0),
            pixels: self.crop.pixels(),
        }
    }
}

/// The picture of a mode without sampling.
fn render_unsampled(
    world: &AnyWorld,
    order: &Order,
    watch: &Watch<'_>,
) -> Result<TargetResult, Stopped> {
    let job = Job {
        crop: Some(order.crop),
        values: order.values,
        background: order.background,
        ..Job::default()
    };
    let film = world.render(&job, watch.on_pixel).ok_or(Stopped)?;
    let samples = Samples {
        min: 1,
        mean: 1.0,
        most: 1,
    };
    let Film {
        image,
        coverage,
        counts,
    } = film;
    Ok(TargetResult {
        image,
        coverage,
        counts,
        error: 0.0,
        undersampled: None,
        coarse: None,
        samples,
        light_samples: 1,
    })
}

/// Sets random sub-samples in the pixels, and the number of points of soft lights.
pub(super) fn set_sampling(world: &mut AnyWorld, scene: &Scene, light_samples: u32) {
    let mut scene = scene.clone();
    scene.settings.pattern = Pattern::Jitter;
    scene.settings.light_samples = light_samples;
    world.change(revalidate(&scene));
}

/// The best number of points of each soft light, and the rays for finding it. Larger numbers are
/// tried on some tiles as long as noise times rays falls: that product is the cost of a picture of
/// given error.
pub(super) fn light_samples(
    world: &mut AnyWorld,
    scene: &Scene,
    order: &Order,
    watch: &Watch<'_>,
) -> Result<(u32, Counts), Stopped> {
    /// Tiles, and samples of a replicate in them.
    const TILES: usize = 4;
    const LENGTH: u32 = 4;
    let scene_samples = scene.settings.light_samples;
    let (mut best, mut tried) = ((scene_samples, f64::INFINITY), Counts::default());
    if order.keep_lights || scene_samples == 1 || not_applicable(Parameter::Lights, scene).is_some()
    {
        return Ok((scene_samples, tried));
    }
    let Crop {
        x,
        y,
        width,
        height,
    } = order.crop;
    let tiles = |from: u32, length: u32| from / Tiles::SIDE..(from + length).div_ceil(Tiles::SIDE);
    let mut ranks: Vec<_> = tiles(y, height)
        .flat_map(|j| tiles(x, width).map(move |i| Tiles::rank(order.seed, [i, j])))
        .collect();
    ranks.sort_unstable();
    let last = ranks
        .get(TILES - 1)
        .or(ranks.last())
        .copied()
        .unwrap_or(u64::MAX);
    let some = Tiles {
        seed: order.seed,
        first: 0,
        last,
    };
    let pixels = (y..y + height).flat_map(|y| (x..x + width).map(move |x| [x, y]));
    let wanted: Vec<_> = pixels
        .map(|pixel| [if some.contain(pixel) { LENGTH } else { 0 }, 0])
        .collect();
    for count in [2, 4, 8, 16, 32] {
        let mut film = ProgressiveFilm::new(order.crop, order.seed);
        set_sampling(world, scene, count);
        (watch.round)(Progress {
            pixels: film.len() as u64,
            error: None,
        });
        if !world.grow(&mut film, &|index| wanted[index], watch.on_pixel) {
            return Err(Stopped);
        }
        tried = tried.plus(film.counts);
        let cost = Noise::of(&film, &order.undersampled(world)).square * film.counts.rays() as f64;
        if cost >= best.1 {
            break;
        }
        best = (count, cost);
    }
    Ok((best.0, tried))
}
