//! The cost of each effect, light, object and material, by ablation: the scene is rendered with and
//! without it, with the same random numbers.

use super::ablation::{self, Ablation};
use super::benchmark::{BenchmarkCase, benchmark};
use super::metrics::{LEVELS, mean_product, rmse};
use super::outcome::RayTotals;
use super::parameter::Parameter;
use super::reference::independent;
use super::setting::Setting;
use super::statistics::{Estimate, SplitMix64};
use super::subject::{Stopped, StudySubject};
use rtc_image::Image;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The measurements of one ablation.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "camelCase")]
pub struct EffectCost {
    /// The kind of the removed feature.
    pub kind: Ablation,
    /// The name of the removed feature.
    pub effect: String,
    /// The rays of the rendered part without it.
    pub rays: RayTotals,
    /// The ratio of rays: without it over with it.
    pub ray_ratio: f64,
    /// The ratio of processor times: without it over with it.
    pub ratio: Estimate,
    /// The ratio of sampling noise: without it over with it.
    pub noise_ratio: f64,
    /// The difference of the picture without it, beyond noise, in grey levels.
    pub difference: f64,
}

/// The renders of each scene: three timed ones, and two with independent samples.
const RENDERS: u64 = 3 + 2;

/// The minimum number of tiles.
const MIN_TILES: usize = 8;

/// The cost of each ablation of a scene, near a setting, as far as the ray budget allows.
pub(super) fn costs(
    subject: &StudySubject<'_>,
    setting: Setting,
    budget: u64,
    rng: &mut SplitMix64,
) -> Result<Vec<EffectCost>, Stopped> {
    /// More paths do not change the ratios.
    const PATHS: u32 = 4;
    // List the ablations, as many as the budget allows.
    let setting = setting.with(Parameter::Paths, setting.paths.min(PATHS));
    let mut ablations = ablation::of(&subject.scene);
    let Some((subject, count)) = affordable(subject, setting, (budget, ablations.len()))? else {
        return Ok(Vec::new());
    };
    ablations.truncate(count);
    // Time the scene and all ablations against each other.
    let mut cases = vec![case(subject.clone(), setting)];
    let mut names = Vec::new();
    for ablated in ablations {
        names.push((ablated.kind, ablated.name));
        cases.push(case(subject.with_scene(ablated.scene), setting));
    }
    let benchmark = benchmark(&cases, budget * 3 / RENDERS, None, rng)?;
    // Measure noise and difference with two independent renders each.
    let pairs = cases.iter().map(SampledPair::of);
    let pairs = pairs.collect::<Result<Vec<_>, _>>()?;
    let (with, all) = (
        &pairs[0],
        RayTotals::from(benchmark.runs[0].rendered.counts).all(),
    );
    let costs = names.into_iter().zip(&pairs[1..]).zip(&benchmark.runs[1..]);
    let cost = |(((kind, effect), pair), run): ((_, &SampledPair), &super::benchmark::TimedRun)| {
        EffectCost {
            kind,
            effect,
            rays: run.rendered.counts.into(),
            ray_ratio: RayTotals::from(run.rendered.counts).all() as f64 / all.max(1) as f64,
            ratio: run.ratio,
            noise_ratio: pair.noise_over(with),
            difference: pair.difference(with),
        }
    };
    // Drop effects that change neither the picture nor the work: they are absent.
    let costs = costs.map(cost);
    Ok(costs
        .filter(|cost| cost.difference > 0.0 || cost.ray_ratio != 1.0)
        .collect())
}

fn case(subject: StudySubject<'_>, setting: Setting) -> BenchmarkCase<'_> {
    let depth = subject.scene.settings.max_depth.min(setting.depth);
    BenchmarkCase {
        subject,
        setting: Setting { depth, ..setting },
    }
}

/// The tiles and the number of ablations that a ray budget allows; `None` if it does not allow one.
fn affordable<'a>(
    subject: &StudySubject<'a>,
    setting: Setting,
    (budget, requested): (u64, usize),
) -> Result<Option<(StudySubject<'a>, usize)>, Stopped> {
    let pilot = subject.keep(MIN_TILES);
    let rays = pilot.render(setting, independent(1))?.counts.rays();
    let of_tile = RENDERS as f64 * rays as f64 / pilot.count() as f64;
    let renders = budget as f64 / of_tile.max(1.0);
    // The unmodified scene takes one more.
    let count = (renders / pilot.count() as f64) as usize;
    if requested == 0 || count < 2 {
        return Ok(None);
    }
    let count = requested.min(count - 1);
    let tiles = renders / (count + 1) as f64;
    Ok(Some((subject.keep(tiles as usize), count)))
}

/// Two renders of a scene, with seeds that all scenes share.
struct SampledPair([Vec<Image>; 2]);

impl SampledPair {
    fn of(case: &BenchmarkCase<'_>) -> Result<Self, Stopped> {
        let render = |seed| case.subject.render(case.setting, independent(seed));
        Ok(Self([render(11)?.tiles, render(12)?.tiles]))
    }

    fn noise_over(&self, other: &Self) -> f64 {
        let [ours, theirs] = [self, other].map(|pair| rmse(&pair.0[0], &pair.0[1]));
        match ours == theirs {
            true => 1.0,
            false => ours / theirs,
        }
    }

    /// The difference in grey levels, beyond noise.
    fn difference(&self, other: &Self) -> f64 {
        let pair = |which: usize| [self.0[which].as_slice(), &other.0[which]];
        mean_product(pair(0), pair(1)).max(0.0).sqrt() * LEVELS
    }
}
