//! The report of `rtc compile --explain`: each effect with its verdict, rule, reason and place, and
//! what it costs in rays.
//!
//! Rays are counted by tracing: the picture without the rule that left an effect out, less the
//! picture as planned; on every k-th pixel where the whole would take long.

use super::Failure;
use super::args::Explanation;
use super::input::{Input, Proven};
use crate::pipeline;
use crate::plan::{Effect, Plan, Rule, Rules, State, Verdict};
use crate::render::{Counts, Job, KERNELS, Stride, choose};
use crate::valid::Proof;
use serde_json::{Value, json};

/// About the most rays of one pass.
const MAX_RAYS: u64 = 200_000;

/// Columns of the table.
const WIDTH: usize = 80;

/// What is said of a plan.
pub(super) struct Report {
    kernel: &'static str,
    stride: Stride,
    planned: u64,
    unpruned: u64,
    samples: u64,
    rows: Vec<Row>,
}

/// One verdict, with what the effect costs.
struct Row {
    verdict: Verdict,
    /// `file:line` of the values that decided.
    places: Vec<String>,
    /// The address of the one light or material it is about.
    of: Option<String>,
    /// Rays it takes.
    costs: u64,
    /// Rays it would take if the rule did not leave it out.
    saves: u64,
}

impl Report {
    /// Plans the picture and counts rays.
    pub(super) fn new(proven: &Proven, input: &Input) -> Result<Self, Failure> {
        let plan = Plan::new(&proven.scene, Rules::ALL);
        let mut counter = Counter::new(&proven.scene);
        let planned = counter.count(Rules::ALL)?;
        let unpruned = counter.count(Rules::NONE)?.rays();
        let mut rows = Vec::new();
        for verdict in &plan.verdicts {
            let mut saves = 0;
            if let Some(rule) = verdict
                .rule
                .filter(|_| verdict.of.is_none() && verdict.state == State::Pruned)
            {
                saves = counter
                    .count(Rules::ALL.without(rule))?
                    .rays()
                    .saturating_sub(planned.rays());
            }
            let spans = verdict
                .facts
                .iter()
                .filter_map(|place| proven.lowered.origins.span(*place));
            let mut places = spans
                .map(|span| input.line(span))
                .map(|(file, line)| at(file, line))
                .collect::<Vec<_>>();
            places.dedup();
            let costs = if verdict.of.is_none() {
                cost(verdict.effect, &planned)
            } else {
                0
            };
            let of = verdict.of.map(|place| place.to_string());
            rows.push(Row {
                verdict: verdict.clone(),
                places,
                of,
                costs,
                saves,
            });
        }
        let (kernel, stride) = (KERNELS[choose(plan.features)].name, counter.stride);
        let samples = counter.samples();
        Ok(Self {
            kernel,
            stride,
            planned: planned.rays(),
            unpruned,
            samples,
            rows,
        })
    }

    /// The report in the form asked for.
    pub(super) fn print(&self, form: Explanation) -> String {
        match form {
            Explanation::Human => self.table(),
            Explanation::Json => format!("{:#}\n", self.object()),
        }
    }

    fn table(&self) -> String {
        let mut text = format!(
            "{:<15} {:<7} {:<15} {:>12} {:>12}\n",
            "effect", "verdict", "rule", "rays", "rays saved"
        );
        let about = if self.stride == Stride::EVERY {
            ""
        } else {
            "≈"
        };
        let rays = |count: u64| {
            if count == 0 {
                String::new()
            } else {
                format!("{about}{}", grouped(count))
            }
        };
        for Row {
            verdict,
            places,
            of,
            costs,
            saves,
        } in &self.rows
        {
            let rule = verdict.rule.map_or("", Rule::name);
            let (name, state) = (verdict.effect.name(), verdict.state.name());
            if of.is_none() {
                let line = format!(
                    "{name:<15} {state:<7} {rule:<15} {:>12} {:>12}",
                    rays(*costs),
                    rays(*saves)
                );
                text += line.trim_end();
                text.push('\n');
            }
            let whose = of.as_ref().map(|of| format!("{of}: ")).unwrap_or_default();
            let places = if places.is_empty() {
                String::new()
            } else {
                format!(" ({})", places.join(", "))
            };
            text += &folded(&format!("{whose}{}{places}", verdict.because));
        }
        let per_sample = |rays: u64| rays as f64 / self.samples.max(1) as f64;
        text + &format!(
            "kernel: {} (of {})\nrays a sample: {about}{:.2}, without the rules {about}{:.2}\n",
            self.kernel,
            KERNELS.len(),
            per_sample(self.planned),
            per_sample(self.unpruned)
        )
    }

    fn object(&self) -> Value {
        let row = |row: &Row| {
            json!({
                "effect": row.verdict.effect.name(),
                "of": row.of,
                "verdict": row.verdict.state.name(),
                "rule": row.verdict.rule.map(Rule::name),
                "because": row.verdict.because,
                "places": row.places,
                "pointers": row.verdict.facts.iter().map(ToString::to_string).collect::<Vec<_>>(),
                "rays": row.costs,
                "raysSaved": row.saves,
            })
        };
        json!({
            "effects": self.rows.iter().map(row).collect::<Vec<_>>(),
            "kernel": self.kernel,
            "kernels": KERNELS.len(),
            "stride": self.stride.get(),
            "samples": self.samples,
            "rays": self.planned,
            "raysUnpruned": self.unpruned,
        })
    }
}

/// The rays that an effect takes of those counted.
fn cost(effect: Effect, counts: &Counts) -> u64 {
    match effect {
        Effect::Surfaces => counts.camera,
        Effect::Shadows => counts.shadow,
        Effect::Mirror => counts.mirror,
        Effect::Refraction => counts.refracted,
        Effect::DepthBuffer
        | Effect::NormalBuffer
        | Effect::DirectLight
        | Effect::SoftLight
        | Effect::Highlight
        | Effect::GlossyReflection
        | Effect::Depth
        | Effect::Textures
        | Effect::NormalInterpolation
        | Effect::NormalMapping
        | Effect::Lens
        | Effect::Supersampling => 0,
    }
}

/// Counts the rays of a picture, on a part of its pixels that is quick.
struct Counter<'scene> {
    scene: &'scene Proof,
    stride: Stride,
}

impl<'scene> Counter<'scene> {
    fn new(scene: &'scene Proof) -> Self {
        let counter = Self {
            scene,
            stride: Stride::EVERY,
        };
        let wanted = counter.samples().saturating_mul(4);
        let mut k = 1;
        while u64::from(k) * u64::from(k) * MAX_RAYS < wanted {
            k += 1;
        }
        Self {
            stride: Stride::new(k),
            ..counter
        }
    }

    /// All samples of the picture.
    fn samples(&self) -> u64 {
        let (camera, factor) = (
            self.scene.camera(),
            u64::from(self.scene.settings().supersampling.get()),
        );
        let lens = if camera.lens.radius.get() > 0.0 {
            u64::from(camera.lens.samples.get())
        } else {
            1
        };
        let pixels = u64::from(camera.width.get()) * u64::from(camera.height.get());
        pixels.saturating_mul(factor * factor).saturating_mul(lens)
    }

    /// The rays of the whole picture, scaled from those of a part.
    fn count(&mut self, rules: Rules) -> Result<Counts, Failure> {
        let job = Job {
            stride: self.stride,
            ..Job::default()
        };
        let film = pipeline::render(self.scene, &Plan::new(self.scene, rules), &job, 0, &|_| {
            true
        });
        let film =
            film.map_err(|error| Failure::Trouble(format!("can't start threads: {error}")))?;
        let counts = film.ok_or(Failure::Interrupted)?.counts;
        let (width, height) = (
            self.scene.camera().width.get(),
            self.scene.camera().height.get(),
        );
        let whole = u128::from(width) * u128::from(height);
        let part = u128::from(self.stride.of(width)) * u128::from(self.stride.of(height));
        let scaled =
            |count: u64| u64::try_from(u128::from(count) * whole / part.max(1)).unwrap_or(u64::MAX);
        let Counts {
            camera,
            shadow,
            mirror,
            refracted,
            hits,
            unnumbered,
        } = counts;
        let [camera, shadow, mirror, refracted] = [camera, shadow, mirror, refracted].map(scaled);
        let [hits, unnumbered] = [hits, unnumbered].map(scaled);
        Ok(Counts {
            camera,
            shadow,
            mirror,
            refracted,
            hits,
            unnumbered,
        })
    }
}

/// A line of a file, by the name of the file alone.
fn at(file: &str, line: u32) -> String {
    let name = file.rsplit(['/', '\\']).next().unwrap_or(file);
    format!("{name}:{line}")
}

/// The number with commas between thousands.
fn grouped(count: u64) -> String {
    let digits = count.to_string();
    let mut text = String::new();
    for (index, digit) in digits.chars().enumerate() {
        if index > 0 && (digits.len() - index).is_multiple_of(3) {
            text.push(',');
        }
        text.push(digit);
    }
    text
}

/// The words in indented lines of at most [`WIDTH`] columns.
fn folded(words: &str) -> String {
    const INDENT: &str = "    ";
    let mut text = String::new();
    let mut line = INDENT.to_owned();
    for word in words.split(' ') {
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
    fn lines_fit_and_numbers_are_grouped() {
        let text = folded(&"word ".repeat(60));
        assert!(
            text.lines()
                .all(|line| line.chars().count() <= WIDTH && line.starts_with("    "))
        );
        assert_eq!(text.split_whitespace().count(), 60);
        assert_eq!(
            [grouped(0), grouped(999), grouped(1_234_567)],
            ["0", "999", "1,234,567"]
        );
        assert_eq!(at("/a/b.yaml", 7), "b.yaml:7");
    }
}
