//! The rows of a study: the settings worth it, rendered, timed and judged, and those on the front.

use super::knob::Parameter;
use super::metrics::Errors;
use super::outcome::Row;
use super::pareto;
use super::race::{Runner, TimedRun, race};
use super::reference::{self, Reference};
use super::sample::TileErrors;
use super::spread::ErrorSpread;
use super::statistics::Rng;
use super::subject::{Stopped, Subject};
use super::{Context, FOR_ROWS, JUDGE, Scope};

impl Scope {
    /// The scene's own setting and the best ones by the model, rendered, timed and judged.
    pub(super) fn rows(
        &self,
        subject: &Subject<'_>,
        context: &Context,
        rng: &mut Rng,
    ) -> Result<(Vec<Row>, f64), Stopped> {
        let Context {
            reference,
            depths: _,
            model,
        } = context;
        let budget = self.hundredths(FOR_ROWS);
        let turned: Vec<_> = self
            .used
            .iter()
            .copied()
            .filter(|knob| !matches!(knob, Parameter::Denoise | Parameter::Precision))
            .collect();
        let min = turned
            .iter()
            .fold(self.own, |setting, knob| setting.with(*knob, knob.lowest()));
        let least_error = (3.0 * reference.floor).max(reference::SMALLEST);
        let best = pareto::candidates(model, min, &turned, budget as f64 / 10.0, least_error);
        // Of tiles alone the pixels around are not known.
        let is_denoised = self.used.contains(&Parameter::Denoise) && subject.is_whole();
        let settings = std::iter::once(self.own)
            .chain(best.into_iter().filter(|setting| *setting != self.own));
        let settings = settings
            .flat_map(|setting| std::iter::once(setting).chain(pareto::cheaper(model, setting)))
            .chain(self.own.denoised().filter(|_| is_denoised));
        let runners: Vec<_> = settings
            .map(|setting| Runner {
                subject: subject.clone(),
                setting,
            })
            .collect();
        let race = race(&runners, budget, Some(&reference.tiles), rng)?;
        let row = |(runner, run): (&Runner<'_>, TimedRun)| {
            let errors = Errors::of(&run.shot.tiles, &reference.tiles, subject.fraction());
            Row {
                setting: runner.setting,
                own: runner.setting == self.own,
                front: false,
                rays: run.shot.counts.into(),
                seconds: run.seconds,
                ratio: run.ratio,
                judged: reference.floor <= JUDGE * errors.rmse || reference.floor == 0.0,
                spread: ErrorSpread::of(&run.squares),
                errors,
                resumed: run.is_resumed,
                model: model.error(runner.setting),
                tiles: run.shot.tiles,
            }
        };
        let rows: Vec<_> = runners.iter().zip(race.runs).map(row).collect();
        Ok((
            ranked(rows, reference, subject.fraction()),
            race.wall_over_cpu,
        ))
    }
}

/// The rows in ascending order of cost, those on the front marked: of a `fraction` of the picture, those
/// that surely have less error than what is there and costs less.
fn ranked(rows: Vec<Row>, reference: &Reference, fraction: f64) -> Vec<Row> {
    let points: Vec<_> = rows.iter().map(Row::point).collect();
    let errors = |row: &Row| TileErrors::of(&row.tiles, &reference.tiles, fraction);
    let errors: Vec<_> = rows.iter().map(errors).collect();
    let is_better = |a: usize, b: usize| errors[a].is_clearly_below(&errors[b], pareto::SAME);
    let mut rows: Vec<_> = rows.into_iter().map(Some).collect();
    let ranked = pareto::ranking(&points, is_better).into_iter();
    let ranked = ranked.filter_map(|(place, front)| {
        Some(Row {
            front,
            ..rows[place].take()?
        })
    });
    ranked.collect()
}

impl Row {
    fn point(&self) -> pareto::Point {
        pareto::Point {
            seconds: [self.seconds.low, self.seconds.high],
            rays: self.rays.all(),
        }
    }
}
