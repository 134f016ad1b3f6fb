//! The reference of a study. Parameters are raised one at a time until the picture no longer
//! changes or the budget ends; then it is rendered a second time with independent samples. The mean
//! of the two halves is the reference, and their difference estimates its error.

use super::metrics::{LEVELS, mean, mean_product, rmse};
use super::outcome::{BounceCost, MoreBounces};
use super::parameter::{MAX_DEPTH, Parameter};
use super::setting::Setting;
use super::subject::{RenderedTiles, Stopped, StudySubject};
use rtc_image::Image;
use rtc_render::SamplingSeeds;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The smallest error worth a row, in grey levels: a twentieth of a level is invisible.
pub(super) const MIN_ERROR: f64 = 0.05;

/// The picture counts as unchanged if raising a parameter changes it by less than this, in grey
/// levels.
const UNCHANGED: f64 = MIN_ERROR / 10.0;

/// A value of a parameter, and its error.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct ParameterLevel {
    /// The value.
    pub value: u32,
    /// Its error if all other parameters have none, in grey levels.
    pub error: f64,
    /// Whether the error is significant against the noise of the study.
    pub resolved: bool,
    /// Its rays, with the other parameters as in the sweep.
    pub rays: u64,
}

/// The best picture within the budget.
pub(super) struct Reference {
    pub(super) tiles: Vec<Image>,
    pub(super) setting: Setting,
    /// The error of the reference itself, in grey levels.
    pub(super) floor: f64,
}

/// The path depths compared with that of the scene.
pub(super) struct ComparedDepths {
    /// The error of each depth up to that of the scene, or to the depth where the picture no longer
    /// changes.
    pub(super) levels: Vec<ParameterLevel>,
    /// The effect of more bounces.
    pub(super) more: MoreBounces,
}

/// The end of the search for deeper paths.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "camelCase")]
pub enum DepthEnd {
    /// No path goes deeper: greater depths add nothing.
    Exact,
    /// One more bounce changes nothing visible.
    Still,
    /// The study could not afford more; deeper paths may be visible.
    Open,
}

/// Seeds that are independent of normal renders and of other numbers.
pub(super) fn independent(number: u64) -> SamplingSeeds {
    SamplingSeeds {
        pixel: number,
        lens: number,
        path: number,
    }
}

/// The renders of a depth, one for each seed.
struct DepthProbe(Vec<RenderedTiles>);

impl DepthProbe {
    fn rays(&self) -> u64 {
        self.0.iter().map(|rendered| rendered.counts.rays()).sum()
    }

    fn secondary(&self) -> u64 {
        self.0
            .iter()
            .map(|rendered| rendered.counts.secondary())
            .sum()
    }

    /// Its difference from another depth, beyond sampling noise.
    fn error(&self, other: &Self) -> f64 {
        let [a, b] = [&self.0, &other.0]
            .map(|renders| [&renders[0].tiles, &renders[renders.len() - 1].tiles]);
        mean_product([a[0], b[0]], [a[1], b[1]]).max(0.0).sqrt() * LEVELS
    }
}

/// Compares path depths with that of `start`, up to the depth where the picture no longer changes.
/// All depths use the same seeds, so that only the depth differs.
pub(super) fn depths(
    subject: &StudySubject<'_>,
    start: Setting,
    seeds: &[SamplingSeeds],
    budget: u64,
) -> Result<ComparedDepths, Stopped> {
    // Render the depths from 0 up.
    let render = |depth| {
        let renders = seeds
            .iter()
            .map(|seeds| subject.render(start.with(Parameter::Depth, depth), *seeds));
        renders.collect::<Result<_, _>>().map(DepthProbe)
    };
    let (mut renders, end) = search_depths(render, budget)?;
    // If the budget ended the search, the scene's depth is still needed.
    let last = renders.len() - 1;
    if end == DepthEnd::Open && last < start.depth as usize {
        renders.push(render(start.depth)?);
    }
    // Compare each depth with that of the scene.
    let depth = |index: usize| match u32::try_from(index) {
        Ok(depth) if index <= last => depth,
        _ => start.depth,
    };
    let scene_index = (renders.len() - 1).min(start.depth as usize);
    let level = |(index, rendered): (usize, &DepthProbe)| {
        let error = rendered.error(&renders[scene_index]);
        ParameterLevel {
            value: depth(index),
            error,
            resolved: error > 0.0,
            rays: rendered.rays(),
        }
    };
    let mut levels: Vec<_> = renders.iter().enumerate().map(level).collect();
    // Report the greater depths separately.
    let scene_rays = renders[scene_index].rays().max(1) as f64;
    let deeper = levels.split_off(scene_index + 1).into_iter();
    let cost = |level: ParameterLevel| BounceCost {
        depth: level.value,
        ray_ratio: level.rays as f64 / scene_rays,
        difference: level.error,
    };
    let more = MoreBounces {
        scene_depth: start.depth,
        end,
        deeper: deeper.map(cost).collect(),
    };
    Ok(ComparedDepths { levels, more })
}

/// Renders the depths from 0 up, until the picture no longer changes or the budget ends.
fn search_depths(
    render: impl Fn(u32) -> Result<DepthProbe, Stopped>,
    budget: u64,
) -> Result<(Vec<DepthProbe>, DepthEnd), Stopped> {
    let mut renders = vec![render(0)?];
    let mut spent = renders[0].rays();
    let end = loop {
        let depth = u32::try_from(renders.len()).unwrap_or(MAX_DEPTH);
        if let [.., before, last] = renders.as_slice() {
            let growth = last.rays() as f64 / before.rays() as f64;
            if last.secondary() == before.secondary() {
                renders.pop();
                break DepthEnd::Exact;
            }
            if depth > MAX_DEPTH || spent as f64 + last.rays() as f64 * growth > budget as f64 {
                break DepthEnd::Open;
            }
        }
        if let [.., first, second, third] = renders.as_slice()
            && first.error(second).max(second.error(third)) < UNCHANGED
        {
            break DepthEnd::Still;
        }
        renders.push(render(depth)?);
        spent += renders[renders.len() - 1].rays();
    };
    Ok((renders, end))
}

/// Renders the reference with about `budget` rays: raises the sampling parameters in turn, from
/// `start`, until the picture no longer changes or the budget ends.
pub(super) fn reference(
    subject: &StudySubject<'_>,
    start: Setting,
    parameters: &[Parameter],
    budget: u64,
) -> Result<Reference, Stopped> {
    // Without sampling, one render is exact.
    let mut setting = start;
    if parameters.is_empty() {
        let rendered = subject.render(setting, SamplingSeeds::NONE)?;
        return Ok(Reference {
            tiles: rendered.tiles,
            setting,
            floor: 0.0,
        });
    }
    // Raise the parameters in turn.
    let mut half = subject.render(setting, independent(1))?;
    let mut spent = half.counts.rays() as f64;
    for (number, parameter) in (2..).zip(parameters.iter().cycle()) {
        let raised = setting.with(*parameter, raised(setting.get(*parameter)));
        let growth =
            parameter.samples(raised.get(*parameter)) / parameter.samples(setting.get(*parameter));
        // Reserve the cost of the second half.
        if spent + 2.0 * growth * half.counts.rays() as f64 > budget as f64 {
            break;
        }
        let next = subject.render(raised, independent(number))?;
        spent += next.counts.rays() as f64;
        let change = rmse(&half.tiles, &next.tiles);
        (setting, half) = (raised, next);
        if change < UNCHANGED {
            break;
        }
    }
    // Render a second, independent half.
    let other = subject.render(setting, independent(0x5EED))?;
    let tiles = mean(&half.tiles, &other.tiles);
    Ok(Reference {
        floor: 0.5 * rmse(&half.tiles, &other.tiles),
        tiles,
        setting,
    })
}

/// The next of 2, 3, 4, 6, 8, 12, 16, ….
fn raised(value: u32) -> u32 {
    if value.is_multiple_of(3) {
        value / 3 * 4
    } else {
        value / 2 * 3
    }
}
