//! The Pareto front of error and cost: candidates by a greedy search on the model, and the front of
//! the measured rows.

use super::parameter::Parameter;
use super::setting::Setting;
use super::sweep::CostModel;
use rtc_math::ln;

/// A new row must reduce the error to this fraction or less.
const MIN_GAIN: f64 = 0.99;

/// Errors within a thousandth count as equal: rounding of hits at edges causes as much.
pub(super) const EQUAL_ERROR: f64 = 1.001;

/// Ray counts within this factor count as equal, unless the times differ clearly.
const EQUAL_COST: f64 = 1.02;

/// Settings in ascending order of work. Each step raises the parameter with the best reduction of
/// error per work in the model, until the rays exceed `most_rays` or the error falls below
/// `least_error`.
pub(super) fn candidates(
    model: &CostModel,
    min: Setting,
    parameters: &[Parameter],
    most_rays: f64,
    least_error: f64,
) -> Vec<Setting> {
    let mut path = vec![min];
    loop {
        let now = path[path.len() - 1];
        let (error, rays) = (model.error(now), model.rays(now));
        if error < least_error {
            return path;
        }
        let raised = parameters.iter().filter_map(|parameter| {
            let value = parameter
                .levels()
                .find(|value| *value > now.get(*parameter))?;
            Some(now.with(*parameter, value))
        });
        let affordable = raised
            .filter(|next| model.rays(*next) <= most_rays && model.error(*next) < MIN_GAIN * error);
        let gain = |next: &Setting| {
            ln(error / model.error(*next)) / ln(model.rays(*next) / rays).max(1e-6)
        };
        match affordable.max_by(|a, b| gain(a).total_cmp(&gain(b))) {
            Some(next) => path.push(next),
            None => return path,
        }
    }
}

/// The setting with the cheapest arithmetic that adds no error in the model; `None` if it has that
/// arithmetic already.
pub(super) fn cheaper(model: &CostModel, setting: Setting) -> Option<Setting> {
    let mut others = model
        .measured_values(Parameter::Precision)
        .map(|value| setting.with(Parameter::Precision, value));
    let enough = others.find(|other| MIN_GAIN * model.error(*other) <= model.error(setting));
    enough.filter(|other| *other != setting)
}

/// The cost of a row.
#[derive(Clone, Copy, Debug)]
pub(super) struct CostPoint {
    /// The time in seconds, as an interval.
    pub(super) seconds: [f64; 2],
    /// The rays, which decide where times do not differ clearly.
    pub(super) rays: u64,
}

impl CostPoint {
    fn is_clearly_cheaper(&self, other: &Self) -> bool {
        self.seconds[1] < other.seconds[0]
    }

    /// Whether its cost is not distinguishable from that of an earlier point.
    fn costs_the_same(&self, before: &Self) -> bool {
        !before.is_clearly_cheaper(self) && self.rays as f64 <= EQUAL_COST * before.rays as f64
    }
}

/// The points in ascending order of cost, each with whether it is on the front: on the front, error
/// decreases with cost. `is_better(a, b)` says whether the error of `a` is certainly lower.
pub(super) fn ranking(
    points: &[CostPoint],
    is_better: impl Fn(usize, usize) -> bool,
) -> Vec<(usize, bool)> {
    let (mut order, mut front) = (Vec::new(), Vec::<usize>::new());
    for index in by_cost(points) {
        let point = &points[index];
        order.push(index);
        if front.last().is_none_or(|last| is_better(index, *last)) {
            front.pop_if(|last| point.costs_the_same(&points[*last]));
            front.push(index);
        }
    }
    order
        .into_iter()
        .map(|index| (index, front.contains(&index)))
        .collect()
}

/// The indices of the points in ascending order of cost: no point comes before one that is clearly
/// cheaper; ties are ordered by rays.
fn by_cost(points: &[CostPoint]) -> impl Iterator<Item = usize> {
    let mut remaining: Vec<_> = (0..points.len()).collect();
    std::iter::from_fn(move || {
        let is_next = |index: usize| {
            !remaining
                .iter()
                .any(|other| points[*other].is_clearly_cheaper(&points[index]))
        };
        let next = (0..remaining.len())
            .filter(|index| is_next(remaining[*index]))
            .min_by_key(|index| points[remaining[*index]].rays);
        next.map(|index| remaining.remove(index))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A point with its error.
    fn point(seconds: f64, rays: u64, error: f64) -> (CostPoint, f64) {
        let seconds = [0.99 * seconds, 1.01 * seconds];
        (CostPoint { seconds, rays }, error)
    }

    /// The indices of the points in ascending order of cost, those off the front as −1 − index.
    fn ranked(rows: &[(CostPoint, f64)]) -> Vec<isize> {
        let points: Vec<_> = rows.iter().map(|row| row.0).collect();
        ranking(&points, |a, b| EQUAL_ERROR * rows[a].1 < rows[b].1)
            .into_iter()
            .map(|(index, front)| {
                if front {
                    index as isize
                } else {
                    -1 - index as isize
                }
            })
            .collect()
    }

    #[test]
    fn the_front_is_what_nothing_dominates() {
        let points = [
            point(4.0, 40, 2.0),
            point(2.0, 20, 5.0),
            point(2.0, 20, 2.0),
            point(1.0, 10, 4.0),
        ];
        assert_eq!(ranked(&points), [3, -2, 2, -1]);
    }

    #[test]
    fn rays_decide_where_seconds_cannot() {
        let points = [
            point(1.0, 11, 3.0),
            point(1.005, 10, 3.0),
            point(1.001, 12, 1.0),
        ];
        assert_eq!(ranked(&points), [1, -1, 2]);
        let rounded = [
            point(1.0, 10, 3.000_1),
            point(2.0, 10, 3.0),
            point(4.0, 10, 2.99),
        ];
        assert_eq!(ranked(&rounded), [0, -2, 2], "errors as good as the same");
        assert_eq!(
            ranked(&[point(1.0, 10, 1.0), point(1.0, 10, 1.0)]),
            [0, -2],
            "of equals the first"
        );
    }

    #[test]
    fn of_two_that_cost_the_same_the_better_is_on_the_front() {
        let points = [
            point(1.01, 1000, 3.1),
            point(1.0, 1001, 3.0),
            point(1.0, 1100, 2.0),
        ];
        assert_eq!(ranked(&points), [-1, 1, 2]);
    }
}
