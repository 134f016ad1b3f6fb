//! The comparison of a scene with a reference scene, for example before and after a change: their
//! costs, and whether their pictures differ by more than noise.
//!
//! Both are rendered several times with the same random numbers, so that common noise cancels. The
//! error beyond noise is the mean product of two independent differences, and a paired test decides
//! for each tile whether it differs (as Welch's does for unpaired renders in Jung, Hanika,
//! Dachsbacher, "Detecting Bias in Monte Carlo Renderers using Welch's t-test", JCGT 9(2), 2020).

use super::benchmark::{BenchmarkCase, benchmark};
use super::metrics::{LEVELS, mean_product, products, rmse};
use super::outcome::{RayTotals, StudyArea, StudyProvenance};
use super::reference::independent;
use super::setting::Setting;
use super::statistics::{Estimate, SplitMix64, normal_quantile, paired};
use super::subject::{Stopped, StudySubject};
use super::{Effort, StudyRuntime};
use rtc_image::Image;
use rtc_ir::Scene;
use rtc_render::Crop;
use schemars::JsonSchema;
use serde::Serialize;

/// The number of renders of each scene with independent samples.
const REPLICATES: u8 = 8;

/// The timed renders of both.
const ROUNDS: f64 = 3.0;

/// All renders of both, with the pilot.
const RENDERS: f64 = 8.0 + ROUNDS + 1.0;

/// The seed of the pilot.
const PILOT: u64 = 0x5EED;

/// The minimum number of tiles.
const MIN_TILES: usize = 8;

/// The probability that any tile is reported as different if none is.
const FALSE_ALARM: f64 = 0.05;

/// The comparison of a scene with its reference; ratios are scene over reference.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
#[serde(rename_all = "camelCase")]
pub struct SceneComparison {
    /// The schema of this report: `rtc-versus/1`.
    #[schemars(extend("const" = "rtc-versus/1"))]
    pub schema: String,
    /// The scene and its reference, and the machine.
    pub scenes: [StudyProvenance; 2],
    /// The rendered part of the pictures.
    pub part: StudyArea,
    /// Processor seconds for the whole pictures.
    pub seconds: [Estimate; 2],
    /// The ratio of the seconds.
    pub time: Estimate,
    /// The rays of the rendered part.
    pub rays: [RayTotals; 2],
    /// The sampling noise of one render of each, in grey levels.
    pub noise: [f64; 2],
    /// The difference of the pictures that `rtc render` makes, in grey levels.
    pub rendered: f64,
    /// Their difference beyond noise, with its 95 % interval, in grey levels.
    pub error: Estimate,
    /// The number of tested tiles.
    pub tested: usize,
    /// The tiles that differ significantly, the most different first.
    pub different: Vec<DifferentTile>,
    /// Wall time over processor time: above 1.2 the machine was busy.
    pub wall_over_cpu: f64,
}

/// A tile of two pictures that differ by more than noise.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, JsonSchema)]
#[serde(rename_all = "camelCase")]
pub struct DifferentTile {
    /// Its first column and row.
    pub at: [u32; 2],
    /// Columns and rows.
    pub size: [u32; 2],
    /// The difference of its mean colours, in grey levels.
    pub levels: f64,
    /// The significance, as a number of standard deviations of a normal variable.
    pub deviations: f64,
}

impl SceneComparison {
    /// The ratio of rays.
    #[must_use]
    pub fn ratio_of_rays(&self) -> f64 {
        let [scene, reference] = self.rays.map(|rays| rays.all() as f64);
        scene / reference.max(1.0)
    }

    /// The ratio of noise; 1 if neither has any.
    #[must_use]
    pub fn ratio_of_noise(&self) -> f64 {
        match self.noise {
            [scene, reference] if scene == reference => 1.0,
            [scene, reference] => scene / reference,
        }
    }
}

/// Compares a validated scene with its reference; their pictures have the same size.
///
/// # Errors
/// If it was stopped.
///
/// # Panics
/// If the pictures differ in size.
pub fn versus(
    scenes: [&Scene; 2],
    about: [StudyProvenance; 2],
    effort: Effort,
    seed: u64,
    runtime: &StudyRuntime<'_>,
) -> Result<SceneComparison, Stopped> {
    assert_eq!(scenes[0].camera.size, scenes[1].camera.size);
    // Choose as many tiles as the budget allows.
    let budget = scenes
        .map(|scene| effort.rays(scene))
        .into_iter()
        .fold(u64::MAX, u64::min);
    runtime.report_budget(budget);
    let budget = budget as f64;
    let [first, second] = scenes.map(|scene| StudySubject::new(scene, seed, runtime));
    let count = affordable([&first, &second], budget)?;
    let subjects = [first.keep(count), second.keep(count)];
    // A benchmark reports ratios to the first case.
    let cases = [&subjects[1], &subjects[0]].map(|subject| BenchmarkCase {
        subject: subject.clone(),
        setting: Setting::of(&subject.scene),
    });
    let rounds = (budget * ROUNDS / RENDERS) as u64;
    let benchmark = benchmark(&cases, rounds, None, &mut SplitMix64::new(seed))?;
    let [first, second] = [1, 0].map(|which| &benchmark.runs[which]);
    // Render the replicates of both.
    let cells = subjects[0].cells();
    let [scene, reference] = subjects
        .each_ref()
        .map(|subject| SampledScene::of(subject, seed));
    let sampled = [scene?, reference?];
    Ok(SceneComparison {
        schema: "rtc-versus/1".to_owned(),
        scenes: about,
        part: subjects[0].area(),
        seconds: [first.seconds, second.seconds],
        time: first.ratio,
        rays: [first.rendered.counts.into(), second.rendered.counts.into()],
        noise: sampled.each_ref().map(SampledScene::noise),
        rendered: rmse(&first.rendered.tiles, &second.rendered.tiles),
        error: beyond_noise(&sampled, subjects[0].fraction()),
        tested: cells.len(),
        different: different(&sampled, &cells),
        wall_over_cpu: benchmark.wall_over_cpu,
    })
}

/// The number of tiles of both that a ray budget allows.
fn affordable(subjects: [&StudySubject<'_>; 2], budget: f64) -> Result<usize, Stopped> {
    let mut rays = 0.0;
    for subject in subjects {
        let pilot = subject.keep(MIN_TILES);
        let rendered = pilot.render(Setting::of(&subject.scene), independent(PILOT))?;
        rays += rendered.counts.rays() as f64 / pilot.count() as f64;
    }
    let tiles = (budget / (RENDERS * rays)).min(subjects[0].count() as f64);
    Ok((tiles as usize).max(MIN_TILES))
}

/// The replicates of a scene.
struct SampledScene {
    /// The means of the even and of the odd replicates, in tiles.
    halves: [Vec<Image>; 2],
    /// The mean colour of each tile, for each replicate.
    means: Vec<Vec<[f64; 3]>>,
}

impl SampledScene {
    /// Renders the replicates of a seed, which are independent of those of other seeds.
    fn of(subject: &StudySubject<'_>, seed: u64) -> Result<Self, Stopped> {
        let first = seed.wrapping_mul(u64::from(REPLICATES)).wrapping_add(1);
        let mut halves = [Vec::new(), Vec::new()];
        let mut means = Vec::new();
        for number in 0..REPLICATES {
            let seeds = independent(first.wrapping_add(u64::from(number)).max(1));
            let rendered = subject.render(Setting::of(&subject.scene), seeds)?;
            let tiles = subject.tiles_of(rendered);
            means.push(tiles.iter().map(mean_color).collect());
            let half = &mut halves[usize::from(number % 2)];
            match half.is_empty() {
                true => *half = tiles,
                false => half
                    .iter_mut()
                    .zip(&tiles)
                    .for_each(|(sum, tile)| add(sum, tile)),
            }
        }
        let scale = f64::from(REPLICATES / 2).recip();
        let all = halves
            .iter_mut()
            .flatten()
            .flat_map(|tile| &mut tile.pixels);
        all.flatten().for_each(|value| *value *= scale);
        Ok(Self { halves, means })
    }

    /// The root mean square error of one replicate, in grey levels, from the difference of the two
    /// half means.
    fn noise(&self) -> f64 {
        let [first, second] = &self.halves;
        rmse(first, second) * (0.25 * f64::from(REPLICATES)).sqrt()
    }

    /// A channel of the mean colour of a tile, for each replicate.
    fn channel(&self, tile: usize, channel: usize) -> Vec<f64> {
        self.means
            .iter()
            .map(|tiles| tiles[tile][channel])
            .collect()
    }
}

fn mean_color(tile: &Image) -> [f64; 3] {
    let count = tile.pixels.len().max(1) as f64;
    [0, 1, 2].map(|c| tile.pixels.iter().map(|pixel| pixel[c]).sum::<f64>() / count)
}

fn add(sum: &mut Image, tile: &Image) {
    let pairs = sum
        .pixels
        .iter_mut()
        .flatten()
        .zip(tile.pixels.iter().flatten());
    pairs.for_each(|(sum, value)| *sum += value);
}

/// The difference of two scenes beyond noise, in grey levels, with its 95 % interval from noise and
/// from the choice of tiles.
fn beyond_noise([a, b]: &[SampledScene; 2], fraction: f64) -> Estimate {
    let first = [a.halves[0].as_slice(), &b.halves[0]];
    let second = [a.halves[1].as_slice(), &b.halves[1]];
    let square = mean_product(first, second);
    let squares = products(first, first).zip(products(second, second));
    let (mut count, mut variance) = (0.0, 0.0);
    for (product, (one, other)) in products(first, second).zip(squares) {
        // Estimate the variance of either difference.
        let noise = 0.5 * (one - 2.0 * product + other).max(0.0);
        // Add the variance of their product.
        variance += noise * (2.0 * product.max(0.0) + noise);
        count += 1.0;
    }
    let squares: Vec<_> = (0..a.halves[0].len())
        .map(|tile| {
            let tile = tile..tile + 1;
            let pair = |half: usize| [&a.halves[half][tile.clone()], &b.halves[half][tile.clone()]];
            mean_product(pair(0), pair(1))
        })
        .collect();
    let by_tiles = (1.0 - fraction) * variance_of(&squares) / squares.len().max(1) as f64;
    let off = 1.96 * (variance / f64::max(count * count, 1.0) + by_tiles).sqrt();
    let levels = |square: f64| square.max(0.0).sqrt() * LEVELS;
    Estimate {
        value: levels(square),
        low: levels(square - off),
        high: levels(square + off),
    }
}

fn variance_of(values: &[f64]) -> f64 {
    let mean = values.iter().sum::<f64>() / values.len().max(1) as f64;
    let squares = values.iter().map(|value| (value - mean) * (value - mean));
    squares.sum::<f64>() / values.len().saturating_sub(1).max(1) as f64
}

/// The tiles in which a colour differs significantly, with a correction for multiple tests (Holm,
/// "A simple sequentially rejective multiple test procedure", Scandinavian Journal of Statistics 6
/// (1979)).
fn different([a, b]: &[SampledScene; 2], cells: &[Crop]) -> Vec<DifferentTile> {
    let of = |(tile, cell): (usize, &Crop)| {
        let tests = [0, 1, 2].map(|c| paired(&a.channel(tile, c), &b.channel(tile, c)));
        let square = tests
            .iter()
            .map(|test| test.difference * test.difference)
            .sum::<f64>();
        DifferentTile {
            at: [cell.x, cell.y],
            size: [cell.width, cell.height],
            levels: (square / 3.0).sqrt() * LEVELS,
            deviations: tests.iter().map(|test| test.deviations).fold(0.0, f64::max),
        }
    };
    let mut tiles: Vec<_> = cells.iter().enumerate().map(of).collect();
    tiles.sort_by(|a, b| b.deviations.total_cmp(&a.deviations));
    // Three channels of each tile, two-sided.
    let tests = 6.0 * tiles.len() as f64;
    let limit = |rejected: usize| normal_quantile(FALSE_ALARM / (tests - 6.0 * rejected as f64));
    let count = tiles
        .iter()
        .enumerate()
        .take_while(|(n, tile)| tile.deviations > limit(*n))
        .count();
    tiles.truncate(count);
    tiles.sort_by(|a, b| b.levels.total_cmp(&a.levels));
    tiles
}
