//! Rendering to a target error: rounds of samples where they are needed.
//!
//! The error is measured against the limit of many sub-samples, lens samples and light samples, or
//! of many paths, at the scene's depth and with its lobes; a light with a single sample keeps it.
//! Each round is decided from the whole film: with only a target error, the picture is the same for
//! any number of threads.

use super::budget::{self, CoarsePicture};
use super::noise::FilmNoise;
use super::parameter::{Parameter, not_applicable};
use super::progressive::{CheckpointSink, Checkpointer, ProgressiveRender};
use super::quality::PixelQuality;
use super::rounds::next_round;
use super::subject::Stopped;
use super::undersampled::UndersampledBound;
use rtc_color::Tone;
use rtc_image::Image;
use rtc_ir::{Pattern, Scene};
use rtc_render::{
    AnyWorld, Background, Crop, Film, PixelObserver, ProgressiveFilm, RayCounts, RenderSelection,
    Tiles, Values,
};
use rtc_valid::revalidate;
use std::time::Duration;

/// The stopping criterion; with both, whichever comes first.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct RenderGoal {
    /// The root mean square error in grey levels of 8 bits, of display values.
    pub error: Option<f64>,
    /// The time budget, by the clock of [`RenderCallbacks::elapsed`]. One pixel of each 8 × 8 block
    /// always gets a sample of each replicate.
    pub time: Option<Duration>,
}

/// A render job with a goal.
#[derive(Clone, Copy, Debug)]
pub struct RenderRequest {
    /// When to stop.
    pub goal: RenderGoal,
    /// The rendered part of the picture.
    pub crop: Crop,
    /// The background, for path tracing.
    pub background: Background,
    /// The values in the picture; errors are always those of display values.
    pub values: Values,
    /// The tone curve and the exposure factor, for path tracing.
    pub display: (Tone, f64),
    /// Whether area lights keep their number of samples. Otherwise it is chosen.
    pub keep_lights: bool,
    /// The seed: another seed gives independent noise.
    pub seed: u64,
}

/// The callbacks of a render.
pub struct RenderCallbacks<'a> {
    /// Called from all threads after each pixel with its rays; false stops the render.
    pub on_pixel: &'a PixelObserver<'a>,
    /// Whether the user stopped the render, rather than the time budget.
    pub is_stopped: &'a (dyn Fn() -> bool + Sync),
    /// The time since the start of the time budget.
    pub elapsed: &'a (dyn Fn() -> Duration + Sync),
    /// Called before each round, also while light samples are chosen.
    pub round: &'a (dyn Fn(Progress) + Sync),
}

/// The progress before a round.
#[derive(Clone, Copy, Debug)]
pub struct Progress {
    /// The number of pixels of the round.
    pub pixels: u64,
    /// The current error bound in grey levels; `None` before the first round.
    pub error: Option<f64>,
}

/// Statistics of the samples per pixel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SampleStatistics {
    /// The minimum.
    pub min: u64,
    /// The mean.
    pub mean: f64,
    /// The maximum.
    pub most: u64,
}

/// A picture and its error bound.
#[derive(Clone, Debug)]
pub struct TargetResult {
    /// The picture.
    pub image: Image,
    /// For each pixel, the fraction of samples that hit a surface.
    pub coverage: Vec<f32>,
    /// The quality of each pixel.
    pub quality: Vec<PixelQuality>,
    /// Its rays, including those for choosing light samples, without those of an unfinished round.
    pub counts: RayCounts,
    /// The bound on the root mean square error in grey levels, which holds in 90 % of all renders,
    /// as `benches/honest.sh` counts; if there is no bound, that of the sampled part.
    pub error: f64,
    /// The likely error of the sampled part, in grey levels.
    pub estimate: f64,
    /// If there is no bound: the possible brightness, in multiples of white, of light that no
    /// sample has hit.
    pub undersampled: Option<f64>,
    /// Set if the time ended before each pixel had a sample; then there is no error bound.
    pub coarse: Option<CoarsePicture>,
    /// The samples per pixel.
    pub samples: SampleStatistics,
    /// Samples of each area light at a hit.
    pub light_samples: u32,
}

/// The fraction of pictures whose error may exceed the bound.
pub(super) const TAIL: f64 = 0.05;

/// The minimum total number of samples per replicate in the first round, for pictures of few
/// pixels.
const FIRST: usize = 1024;

/// The minimum number of samples per replicate in the first round of path tracing: sRGB coding is
/// nonlinear, so means of very few samples are not representative.
const FIRST_PATHS: usize = 8;

/// The minimum number of pilot samples: a variance needs two.
const FIRST_PILOT: u32 = 2;

/// Renders a validated scene until the goal is reached, on the threads of the current pool.
///
/// # Errors
/// If it was stopped.
pub fn approach(
    world: &mut AnyWorld,
    scene: &Scene,
    order: &RenderRequest,
    watch: &RenderCallbacks<'_>,
) -> Result<TargetResult, Stopped> {
    approach_keeping(world, scene, order, watch, None)
}

/// Like [`approach`], with checkpoints: it resumes from one and saves new ones.
///
/// # Errors
/// If it was stopped; then a checkpoint is saved.
pub fn approach_keeping(
    world: &mut AnyWorld,
    scene: &Scene,
    order: &RenderRequest,
    watch: &RenderCallbacks<'_>,
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

/// Like [`approach`], for a sampled scene; it changes the settings of the world.
fn in_rounds(
    world: &mut AnyWorld,
    scene: &Scene,
    order: &RenderRequest,
    watch: &RenderCallbacks<'_>,
    mut checkpointer: Option<Checkpointer<'_>>,
) -> Result<TargetResult, Stopped> {
    // Resume from a checkpoint, or choose light samples and begin.
    let mut progressive = match checkpointer.as_mut().and_then(Checkpointer::resumed_from) {
        Some(resumed_from) => resumed_from,
        None => {
            let (light_samples, tried) = light_samples(world, scene, order, watch)?;
            let mut progressive = new_render(light_samples, order);
            progressive.film.counts = tried;
            progressive.requested = vec![first_round(scene, order, world); progressive.film.len()];
            progressive
        }
    };
    // Refine in rounds until the bound meets the target.
    set_sampling(world, scene, progressive.light_samples);
    let undersampled = order.undersampled(world);
    let mut error = None;
    loop {
        let pixels = progressive.film.len() as u64;
        (watch.round)(Progress { pixels, error });
        if !progressive.refine(world, watch.on_pixel, checkpointer.as_mut()) {
            return Err(Stopped);
        }
        let noise = FilmNoise::of(&progressive.film, &undersampled);
        let tail = tail_of(progressive.rounds + 1);
        let bound = noise.bound(tail, order.goal.error);
        let goal = order.goal.error;
        let Some(requested) = next_round(&progressive.film, &noise, tail, goal, f64::INFINITY)
        else {
            checkpointer
                .iter()
                .for_each(|checkpointer| checkpointer.save(&progressive));
            return Ok(progressive.result(bound, &undersampled, order.values));
        };
        (progressive.requested, error) = (requested, Some(bound.error));
        progressive.rounds += 1;
    }
}

/// The tail probability of the bound after a number of rounds. The render may stop after any round
/// (sequential testing): the tails of all rounds, 1/(r(r + 1)), sum to the allowed one.
pub(super) fn tail_of(rounds: u32) -> f64 {
    let round = f64::from(rounds);
    TAIL / (round * (round + 1.0))
}

/// A render without samples yet.
pub(super) fn new_render(light_samples: u32, order: &RenderRequest) -> ProgressiveRender {
    ProgressiveRender {
        film: order.film(),
        requested: Vec::new(),
        rounds: 0,
        light_samples,
        keeps_lights: order.keep_lights,
    }
}

/// The samples of each replicate and of the pilot of all pixels in the first round.
pub(super) fn first_round(scene: &Scene, order: &RenderRequest, world: &AnyWorld) -> [u32; 2] {
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

impl RenderRequest {
    /// A film without samples.
    pub(super) fn film(&self) -> ProgressiveFilm {
        let mut film = ProgressiveFilm::new(self.crop, self.seed);
        (film.background, film.display) = (self.background, self.display);
        film
    }

    /// The bound on undersampled features in a world.
    pub(super) fn undersampled(&self, world: &AnyWorld) -> UndersampledBound {
        let (_, exposure) = self.display;
        UndersampledBound {
            brightest: (world.brightest() * exposure).max(1.0),
            pixels: self.crop.pixels(),
        }
    }
}

/// Renders a mode without random sampling.
fn render_unsampled(
    world: &AnyWorld,
    order: &RenderRequest,
    watch: &RenderCallbacks<'_>,
) -> Result<TargetResult, Stopped> {
    // Render the picture once.
    let job = RenderSelection {
        crop: Some(order.crop),
        values: order.values,
        background: order.background,
        ..RenderSelection::default()
    };
    let film = world.render(&job, watch.on_pixel).ok_or(Stopped)?;
    let samples = SampleStatistics {
        min: 1,
        mean: 1.0,
        most: 1,
    };
    let Film {
        image,
        coverage,
        counts,
    } = film;
    // It has no sampling error.
    let exact = PixelQuality {
        error: [0.0; 3],
        samples: 1,
        undersampled: 0.0,
    };
    Ok(TargetResult {
        quality: vec![exact; image.pixels.len()],
        image,
        coverage,
        counts,
        error: 0.0,
        estimate: 0.0,
        undersampled: None,
        coarse: None,
        samples,
        light_samples: 1,
    })
}

/// Sets jittered sub-samples, and the number of light samples.
pub(super) fn set_sampling(world: &mut AnyWorld, scene: &Scene, light_samples: u32) {
    let mut scene = scene.clone();
    scene.settings.pattern = Pattern::Jitter;
    scene.settings.light_samples = light_samples;
    world.change(revalidate(&scene));
}

/// The best number of samples of each area light, and the rays for finding it. Larger numbers are
/// tried on some tiles as long as noise times rays decreases: that product is the cost at a given
/// error (the inverse efficiency).
pub(super) fn light_samples(
    world: &mut AnyWorld,
    scene: &Scene,
    order: &RenderRequest,
    watch: &RenderCallbacks<'_>,
) -> Result<(u32, RayCounts), Stopped> {
    /// The number of tiles, and the samples per replicate in them.
    const TILES: usize = 4;
    const LENGTH: u32 = 4;
    // Keep the number if it is fixed or cannot matter.
    let scene_samples = scene.settings.light_samples;
    let (mut best, mut tried) = ((scene_samples, f64::INFINITY), RayCounts::default());
    if order.keep_lights || scene_samples == 1 || not_applicable(Parameter::Lights, scene).is_some()
    {
        return Ok((scene_samples, tried));
    }
    // Choose some random tiles of the crop.
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
    let requested: Vec<_> = pixels
        .map(|pixel| [if some.contain(pixel) { LENGTH } else { 0 }, 0])
        .collect();
    // Try larger numbers while noise times rays decreases.
    for count in [2, 4, 8, 16, 32] {
        let mut film = ProgressiveFilm::new(order.crop, order.seed);
        set_sampling(world, scene, count);
        (watch.round)(Progress {
            pixels: film.len() as u64,
            error: None,
        });
        if !world.grow(&mut film, &|index| requested[index], watch.on_pixel) {
            return Err(Stopped);
        }
        tried = tried.plus(film.counts);
        let cost =
            FilmNoise::of(&film, &order.undersampled(world)).square * film.counts.rays() as f64;
        if cost >= best.1 {
            break;
        }
        best = (count, cost);
    }
    Ok((best.0, tried))
}
