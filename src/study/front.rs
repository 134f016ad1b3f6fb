//! Which settings are worth their work: candidates by greed on the model, the front of those measured.

use super::knob::{Knob, Setting};
use super::sweep::Model;
use crate::math::ln;

/// A step that lessens the error by less than a hundredth is not worth a row.
const WORTH: f64 = 0.99;

/// Errors that differ by less than a thousandth are the same: so much is in how hits at edges are rounded.
const SAME: f64 = 1.001;

/// Settings from the least work up, each with the knob raised that the model says lessens the error most for the work;
/// until the rays exceed `most_rays` or the error falls below `least_error`.
pub(super) fn candidates(
    model: &Model,
    least: Setting,
    knobs: &[Knob],
    most_rays: f64,
    least_error: f64,
) -> Vec<Setting> {
    let mut path = vec![least];
    loop {
        let now = path[path.len() - 1];
        let (error, rays) = (model.error(now), model.rays(now));
        if error < least_error {
            return path;
        }
        let raised = knobs.iter().filter_map(|knob| {
            let value = knob.ladder().find(|value| *value > now.get(*knob))?;
            Some(now.with(*knob, value))
        });
        let affordable = raised.filter(|next| model.rays(*next) <= most_rays && model.error(*next) < WORTH * error);
        let gain = |next: &Setting| ln(error / model.error(*next)) / ln(model.rays(*next) / rays).max(1e-6);
        match affordable.max_by(|a, b| gain(a).total_cmp(&gain(b))) {
            Some(next) => path.push(next),
            None => return path,
        }
    }
}

/// The setting by the arithmetic of the least work that leaves no more error, as the model says; none if that is its own.
pub(super) fn cheaper(model: &Model, setting: Setting) -> Option<Setting> {
    let mut others = model.tried(Knob::Precision).map(|value| setting.with(Knob::Precision, value));
    let enough = others.find(|other| WORTH * model.error(*other) <= model.error(setting));
    enough.filter(|other| *other != setting)
}

/// What a row of the table costs and is worth.
#[derive(Clone, Copy, Debug)]
pub struct Point {
    /// Seconds: the interval they lie in.
    pub seconds: [f64; 2],
    /// Rays, which decide where seconds can't.
    pub rays: u64,
    /// The error.
    pub error: f64,
}

impl Point {
    /// Whether this one costs no more than the other, for an error no larger, and is better in one of the two; or is as good,
    /// and the `first` of them.
    fn dominates(&self, other: &Self, first: bool) -> bool {
        let apart = self.seconds[1] < other.seconds[0] || other.seconds[1] < self.seconds[0];
        let (cheaper, dearer) = if apart {
            (self.seconds[1] < other.seconds[0], other.seconds[1] < self.seconds[0])
        } else {
            (self.rays < other.rays, other.rays < self.rays)
        };
        !dearer && self.error <= SAME * other.error && (cheaper || first || SAME * self.error < other.error)
    }
}

/// For each point whether no other dominates it; of equals the first stands.
#[must_use]
pub fn front(points: &[Point]) -> Vec<bool> {
    let stands = |(place, point): (usize, &Point)| {
        let mut others = (0..).zip(points).filter(|(other, _)| *other != place);
        !others.any(|(other, better)| better.dominates(point, other < place))
    };
    points.iter().enumerate().map(stands).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn point(seconds: f64, rays: u64, error: f64) -> Point {
        Point { seconds: [0.99 * seconds, 1.01 * seconds], rays, error }
    }

    #[test]
    fn the_front_is_what_nothing_dominates() {
        let points = [point(1.0, 10, 4.0), point(2.0, 20, 5.0), point(2.0, 20, 2.0), point(4.0, 40, 2.0)];
        assert_eq!(front(&points), [true, false, true, false]);
    }

    #[test]
    fn rays_decide_where_seconds_cannot() {
        let points = [point(1.0, 11, 3.0), point(1.005, 10, 3.0), point(1.001, 12, 1.0)];
        assert_eq!(front(&points), [false, true, true]);
        let rounded = [point(1.0, 10, 3.000_1), point(2.0, 10, 3.0), point(4.0, 10, 2.99)];
        assert_eq!(front(&rounded), [true, false, true], "errors as good as the same");
        assert_eq!(front(&[point(1.0, 10, 1.0), point(1.0, 10, 1.0)]), [true, false], "of equals the first");
    }
}
