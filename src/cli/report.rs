//! The report of `rtc compile --explain`: each effect with its status, rule, reason and source, and
//! its count of rays or evaluations.
//!
//! Rays are counted by tracing: the picture without the rule that left an effect out, less the
//! picture as planned; on every k-th pixel where the whole would take long.

use super::Failure;
use super::args::Explanation;
use indicatif::HumanCount;
use rtc_pipeline::{self as pipeline, Input, ValidatedScene};
use rtc_plan::{Caustics, EffectState, EffectStatus, PathPlan, Plan, Rule, RuleSet};
use rtc_render::{
    KERNELS, PATH_KERNELS, PixelStride, RayCounts, RenderSelection, choose, choose_for_paths,
};
use rtc_valid::{Mode, ValidScene};
use serde_json::{Value, json};
use std::num::NonZeroU32;

/// About the most rays of one pass.
const MAX_RAYS: u64 = 200_000;

/// The minimum pixels and paths of one pass of path tracing, if the picture has as many.
const MIN_PIXELS: u64 = 4_096;
const MIN_PATHS: u64 = 20_480;

/// Columns of the table.
const WIDTH: usize = 80;

/// The report of a plan.
pub(super) struct PlanReport {
    /// The integrator, and out of how many it was chosen.
    kernel: (&'static str, usize),
    /// How traced paths find caustics, if there are any.
    caustics: Option<Caustics>,
    counter: SampledPaths,
    planned: u64,
    unpruned: u64,
    rows: Vec<EffectStatusRow>,
}

/// The samples of the picture whose rays were counted.
#[derive(Clone, Copy)]
struct SampledPaths {
    stride: PixelStride,
    /// Samples of each of those pixels.
    samples: u64,
    /// All of them.
    paths: u64,
    /// The rays of the whole picture.
    all: u64,
}

impl SampledPaths {
    fn is_whole(&self) -> bool {
        self.paths == self.all
    }
}

/// The integrator that renders as planned.
fn kernel(plan: &Plan) -> (&'static str, usize) {
    match &plan.paths {
        Some(paths) => (
            PATH_KERNELS[choose_for_paths(paths.features)].name,
            PATH_KERNELS.len(),
        ),
        None => (KERNELS[choose(plan.features)].name, KERNELS.len()),
    }
}

/// The rays or evaluations that a rule saves: of traced paths those of its effect, else all rays of
/// the picture without the rule, less those as planned.
fn saved(
    status: &EffectStatus,
    counter: &SampledRayCounter<'_>,
    planned: &RayCounts,
    unpruned: &RayCounts,
) -> Result<u64, Failure> {
    let is_path = matches!(counter.scene.settings().mode, Mode::Path(_));
    match status.rule.filter(|_| status.state == EffectState::Pruned) {
        None => Ok(0),
        Some(_) if is_path => Ok(unpruned
            .of(status.effect)
            .saturating_sub(planned.of(status.effect))),
        Some(rule) => {
            let without = counter.count(RuleSet::ALL.without(rule))?;
            Ok(without.rays().saturating_sub(planned.rays()))
        }
    }
}

/// The status of one effect, with its cost.
struct EffectStatusRow {
    status: EffectStatus,
    /// `file:line` of the values that decided.
    places: Vec<String>,
    /// The address of the one light or material it is about.
    of: Option<String>,
    /// Rays it takes.
    costs: u64,
    /// Rays it would take if the rule did not leave it out.
    saves: u64,
}

impl EffectStatusRow {
    /// The row of a status, with the rays that it takes and saves.
    fn new(
        status: &EffectStatus,
        [costs, saves]: [u64; 2],
        validated: &ValidatedScene,
        input: &Input,
    ) -> Self {
        let spans = status
            .facts
            .iter()
            .filter_map(|place| validated.lowered.source_spans.span(*place));
        let lines = spans.map(|span| input.line(span));
        let mut places: Vec<_> = lines.map(|(file, line)| at(file, line)).collect();
        places.dedup();
        Self {
            status: status.clone(),
            places,
            of: status.of.map(|place| place.to_string()),
            costs,
            saves,
        }
    }

    /// The lines of the table, with `about` before counts.
    fn lines(&self, about: &str) -> String {
        let rays = |count: u64| match count {
            0 => String::new(),
            _ => format!("{about}{}", HumanCount(count)),
        };
        let status = &self.status;
        let message = match &self.of {
            Some(of) => format!("{of}: {}", status.reason),
            None => status.reason.clone(),
        };
        let places = if self.places.is_empty() {
            String::new()
        } else {
            format!(" ({})", self.places.join(", "))
        };
        let reason = folded(&(message + &places));
        if self.of.is_some() {
            return reason;
        }
        let line = format!(
            "{:<15} {:<7} {:<15} {:>12} {:>12}",
            status.effect.name(),
            status.state.name(),
            status.rule.map_or("", Rule::name),
            rays(self.costs),
            rays(self.saves)
        );
        format!("{}\n{reason}", line.trim_end())
    }
}

impl PlanReport {
    /// Plans the picture and counts rays.
    pub(super) fn new(validated: &ValidatedScene, input: &Input) -> Result<Self, Failure> {
        let plan = Plan::new(&validated.scene, RuleSet::ALL);
        let counter = SampledRayCounter::new(&validated.scene);
        let planned = counter.count(RuleSet::ALL)?;
        let unpruned = counter.count(RuleSet::NONE)?;
        let row = |status: &EffectStatus| {
            let is_whole = status.of.is_none();
            let saves = if is_whole {
                saved(status, &counter, &planned, &unpruned)?
            } else {
                0
            };
            let costs = if is_whole {
                planned.of(status.effect)
            } else {
                0
            };
            Ok(EffectStatusRow::new(
                status,
                [costs, saves],
                validated,
                input,
            ))
        };
        Ok(Self {
            kernel: kernel(&plan),
            caustics: plan.paths.as_ref().and_then(PathPlan::caustics),
            planned: planned.rays(),
            unpruned: unpruned.rays(),
            rows: plan
                .statuses
                .iter()
                .map(row)
                .collect::<Result<_, Failure>>()?,
            counter: counter.sampled,
        })
    }

    /// The verdicts of a plan as a table, without counts.
    pub(super) fn statuses(validated: &ValidatedScene, input: &Input) -> String {
        let plan = Plan::new(&validated.scene, RuleSet::ALL);
        let row = |status: &EffectStatus| EffectStatusRow::new(status, [0; 2], validated, input);
        let lines = plan.statuses.iter().map(|status| row(status).lines(""));
        lines.collect()
    }

    /// The report in the requested format.
    pub(super) fn print(&self, form: Explanation) -> String {
        match form {
            Explanation::Table => self.table(),
            Explanation::Json => format!("{:#}\n", self.object()),
        }
    }

    fn table(&self) -> String {
        let about = if self.counter.is_whole() { "" } else { "≈" };
        let mut text = format!(
            "{:<15} {:<7} {:<15} {:>12} {:>12}\n",
            "effect", "verdict", "rule", "count", "saved"
        );
        self.rows.iter().for_each(|row| text += &row.lines(about));
        text + &self.totals(about)
    }

    /// The kernel, and the rays of all effects together, with `about` for estimates.
    fn totals(&self, about: &str) -> String {
        let (kernel, kernels) = self.kernel;
        let all = self.counter.all;
        let [planned, unpruned] =
            [self.planned, self.unpruned].map(|rays| rays as f64 / all.max(1) as f64);
        let mut text = format!(
            "kernel: {kernel} (of {kernels})\n\
             rays a sample: {about}{planned:.2}, without the rules {about}{unpruned:.2}\n"
        );
        if let Some(caustics) = self.caustics {
            text += &format!("caustics: {}\n", caustics.description());
        }
        if !self.counter.is_whole() {
            text += &format!(
                "counted on {} of {} samples: {} of each pixel in each {} of a row and column\n",
                HumanCount(self.counter.paths),
                HumanCount(all),
                self.counter.samples,
                ordinal(self.counter.stride.get())
            );
        }
        text
    }

    fn object(&self) -> Value {
        let row = |row: &EffectStatusRow| {
            json!({
                "effect": row.status.effect.name(),
                "of": row.of,
                "verdict": row.status.state.name(),
                "rule": row.status.rule.map(Rule::name),
                "because": row.status.reason,
                "places": row.places,
                "pointers": row.status.facts.iter().map(ToString::to_string).collect::<Vec<_>>(),
                "rays": row.costs,
                "raysSaved": row.saves,
            })
        };
        json!({
            "effects": self.rows.iter().map(row).collect::<Vec<_>>(),
            "kernel": self.kernel.0,
            "kernels": self.kernel.1,
            "caustics": self.caustics.map(Caustics::description),
            "stride": self.counter.stride.get(),
            "samples": self.counter.all,
            "samplesCounted": self.counter.paths,
            "rays": self.planned,
            "raysUnpruned": self.unpruned,
        })
    }
}

/// Counts the rays of a picture, on a part of its samples that is quick.
struct SampledRayCounter<'scene> {
    scene: &'scene ValidScene,
    sampled: SampledPaths,
}

impl<'scene> SampledRayCounter<'scene> {
    fn new(scene: &'scene ValidScene) -> Self {
        let pixel = samples_of_pixel(scene);
        let [width, height] = [scene.camera().width.get(), scene.camera().height.get()];
        let pixels = u64::from(width) * u64::from(height);
        let all = pixels.saturating_mul(pixel);
        let (samples, wanted) = match scene.settings().mode {
            // Paths are long: some of each pixel suffice, and distant pixels are more informative.
            Mode::Path(_) => (
                pixel.min((MIN_PATHS / pixels.clamp(1, MIN_PIXELS)).max(1)),
                MIN_PIXELS,
            ),
            Mode::Phong | Mode::Gooch(_) | Mode::Normal | Mode::Depth => {
                (pixel, (MAX_RAYS / 4 / pixel.max(1)).max(1))
            }
        };
        let mut k = 1;
        while u64::from(k + 1) * u64::from(k + 1) * wanted <= pixels {
            k += 1;
        }
        let stride = PixelStride::new(k);
        let hit = u64::from(stride.of(width)) * u64::from(stride.of(height));
        let sampled = SampledPaths {
            stride,
            samples,
            paths: hit.saturating_mul(samples),
            all,
        };
        Self { scene, sampled }
    }

    /// The rays of the whole picture, scaled from those of a part.
    fn count(&self, rules: RuleSet) -> Result<RayCounts, Failure> {
        let SampledPaths {
            stride,
            samples,
            paths,
            all,
        } = self.sampled;
        let samples = NonZeroU32::new(u32::try_from(samples).unwrap_or(u32::MAX));
        let job = RenderSelection {
            stride,
            samples,
            ..RenderSelection::default()
        };
        let plan = Plan::new(self.scene, rules);
        let film = pipeline::render(self.scene, &plan, &job, 0, &|_| true);
        let film =
            film.map_err(|error| Failure::Failed(format!("can't start threads: {error}")))?;
        Ok(film.ok_or(Failure::Interrupted)?.counts.scaled(all, paths))
    }
}

/// The samples that a pixel takes.
fn samples_of_pixel(scene: &ValidScene) -> u64 {
    let (lens, settings) = (scene.camera().lens, scene.settings());
    match settings.mode {
        Mode::Path(path) => path.samples.get().into(),
        Mode::Depth => 1,
        Mode::Phong | Mode::Gooch(_) | Mode::Normal => {
            let factor = u64::from(settings.supersampling.get());
            let points = if lens.radius.get() > 0.0 {
                lens.samples.get()
            } else {
                1
            };
            (factor * factor).saturating_mul(points.into())
        }
    }
}

/// The number as an ordinal, as `1st` and `12th`.
fn ordinal(number: u32) -> String {
    let ending = match (number % 10, number % 100) {
        (1, tens) if tens != 11 => "st",
        (2, tens) if tens != 12 => "nd",
        (3, tens) if tens != 13 => "rd",
        _ => "th",
    };
    format!("{number}{ending}")
}

/// A line of a file, by the name of the file alone.
fn at(file: &str, line: u32) -> String {
    let name = file.rsplit(['/', '\\']).next().unwrap_or(file);
    format!("{name}:{line}")
}

/// The text in indented lines of at most [`WIDTH`] columns.
fn folded(message: &str) -> String {
    const INDENT: &str = "    ";
    let mut text = String::new();
    let mut line = INDENT.to_owned();
    for word in message.split(' ') {
        if line.trim_start().chars().count() > 0
            && line.chars().count() + 1 + word.chars().count() > WIDTH
        {
            text += line.trim_end();
            text.push('\n');
            line = INDENT.to_owned();
        }
        if line != INDENT {
            line.push(' ');
        }
        line += word;
    }
    text + &line + "\n"
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_fit_and_places_are_short() {
        let text = folded(&"word ".repeat(60));
        assert!(
            text.lines()
                .all(|line| line.chars().count() <= WIDTH && line.starts_with("    "))
        );
        assert_eq!(text.split_whitespace().count(), 60);
        assert_eq!(at("/a/b.yaml", 7), "b.yaml:7");
    }
}
