//! The rows of a study: the most promising settings, rendered, timed and compared with the
//! reference, and the Pareto front.

use super::benchmark::{BenchmarkCase, TimedRun, benchmark};
use super::metrics::PictureErrors;
use super::outcome::StudyRow;
use super::parameter::Parameter;
use super::pareto;
use super::reference::{self, Reference};
use super::setting::Setting;
use super::spread::ErrorSpread;
use super::statistics::SplitMix64;
use super::subject::{Stopped, StudySubject};
use super::tile_errors::TileErrors;
use super::{FOR_ROWS, MAX_REFERENCE_ERROR, StudyContext, StudyScope};

impl StudyScope {
    /// Renders, times and measures the scene's setting and the best ones of the model.
    pub(super) fn rows(
        &self,
        subject: &StudySubject<'_>,
        context: &StudyContext,
        rng: &mut SplitMix64,
    ) -> Result<(Vec<StudyRow>, f64), Stopped> {
        let StudyContext {
            reference,
            depths: _,
            model,
        } = context;
        // Choose candidates with the model.
        let budget = self.hundredths(FOR_ROWS);
        let varied: Vec<_> = self
            .used
            .iter()
            .copied()
            .filter(|parameter| parameter.samples_pixels() || *parameter == Parameter::Depth)
            .collect();
        let min = varied.iter().fold(self.complete(), |setting, parameter| {
            setting.with(*parameter, parameter.lowest())
        });
        let least_error = (3.0 * reference.floor).max(reference::MIN_ERROR);
        let best = pareto::candidates(model, min, &varied, budget as f64 / 10.0, least_error);
        // The denoiser needs the neighbours of tiles, too.
        let is_denoised = self.used.contains(&Parameter::Denoise) && subject.is_whole();
        // Add the scene's setting with and without estimated caustics, cheaper arithmetics and
        // denoised settings.
        let mut own = vec![self.scene_setting];
        own.extend(
            self.used
                .contains(&Parameter::Caustics)
                .then(|| self.caustics())
                .into_iter()
                .flatten(),
        );
        let best = best
            .into_iter()
            .filter(|setting| !own.contains(setting))
            .collect::<Vec<_>>();
        let settings = own.into_iter().chain(best);
        let settings = settings
            .flat_map(|setting| {
                let has_cheaper = self.has_arithmetics || setting == self.scene_setting;
                let cheaper = has_cheaper.then(|| pareto::cheaper(model, setting));
                std::iter::once(setting).chain(cheaper.flatten())
            })
            .chain(self.scene_setting.denoised().filter(|_| is_denoised));
        // Render and time all of them.
        let cases: Vec<_> = settings
            .map(|setting| BenchmarkCase {
                subject: subject.clone(),
                setting,
            })
            .collect();
        let benchmark = benchmark(&cases, budget, Some(&reference.tiles), rng)?;
        // Measure their errors.
        let row = |(case, run): (&BenchmarkCase<'_>, TimedRun)| {
            let errors =
                PictureErrors::of(&run.rendered.tiles, &reference.tiles, subject.fraction());
            StudyRow {
                setting: case.setting,
                is_scene_setting: case.setting == self.scene_setting,
                front: false,
                rays: run.rendered.counts.into(),
                seconds: run.seconds,
                ratio: run.ratio,
                is_resolved: reference.floor <= MAX_REFERENCE_ERROR * errors.rmse
                    || reference.floor == 0.0,
                spread: ErrorSpread::of(&run.squares),
                errors,
                resumed: run.is_resumed,
                model: model.error(case.setting),
                tiles: run.rendered.tiles,
            }
        };
        let rows: Vec<_> = cases.iter().zip(benchmark.runs).map(row).collect();
        Ok((
            ranked(rows, reference, subject.fraction()),
            benchmark.wall_over_cpu,
        ))
    }
}

impl StudyScope {
    /// The settings that show what the estimate of caustics gains: the other one of on and off, and
    /// off with four times the paths.
    fn caustics(&self) -> [Setting; 2] {
        let own = self.scene_setting;
        let other = own.with(Parameter::Caustics, u32::from(!own.caustics));
        let off = own.with(Parameter::Caustics, 0);
        [
            other,
            off.with(Parameter::Paths, own.paths.saturating_mul(4)),
        ]
    }
}

/// Sorts the rows by cost and marks those on the Pareto front: the rows whose error is certainly
/// below that of all cheaper ones on the front.
fn ranked(rows: Vec<StudyRow>, reference: &Reference, fraction: f64) -> Vec<StudyRow> {
    let points: Vec<_> = rows.iter().map(StudyRow::point).collect();
    let errors = |row: &StudyRow| TileErrors::of(&row.tiles, &reference.tiles, fraction);
    let errors: Vec<_> = rows.iter().map(errors).collect();
    let is_better =
        |a: usize, b: usize| errors[a].is_clearly_below(&errors[b], pareto::EQUAL_ERROR);
    let mut rows: Vec<_> = rows.into_iter().map(Some).collect();
    let ranked = pareto::ranking(&points, is_better).into_iter();
    let ranked = ranked.filter_map(|(index, front)| {
        Some(StudyRow {
            front,
            ..rows[index].take()?
        })
    });
    ranked.collect()
}

impl StudyRow {
    fn point(&self) -> pareto::CostPoint {
        pareto::CostPoint {
            seconds: [self.seconds.low, self.seconds.high],
            rays: self.rays.all(),
        }
    }
}
