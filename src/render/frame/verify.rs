//! Plan validation: a render without pruning checks each term that the plan calls zero, and
//! compares the two pictures.

use crate::film::{Film, RenderSelection};
use rtc_math::to_u32;
use rtc_plan::{Effect, Plan, Rule};
use std::sync::{Mutex, PoisonError};

/// A visible term that a plan left out.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PlanMismatch {
    /// The pixel, from the upper left.
    pub pixel: [u32; 2],
    /// The effect that was left out, if it is known.
    pub effect: Option<Effect>,
    /// The rule that is wrong; `None` if all are right, but the plan is not what they make, or its
    /// features are too few.
    pub rule: Option<Rule>,
    /// The observation.
    pub what: &'static str,
}

/// A plan under verification, and the first difference in the order of pixels.
pub(crate) struct PlanVerification {
    pub(crate) plan: Plan,
    first: Mutex<Option<PlanMismatch>>,
}

impl PlanVerification {
    /// A plan without differences so far.
    pub(crate) fn new(plan: Plan) -> Self {
        let first = Mutex::new(None);
        Self { plan, first }
    }

    /// The first difference.
    pub(crate) fn into_first(self) -> Option<PlanMismatch> {
        let first = self.first.into_inner();
        first.unwrap_or_else(PoisonError::into_inner)
    }

    /// Reports a difference. The first one in the order of pixels is kept, and in one pixel the
    /// first reported.
    pub(crate) fn report(&self, pixel: [u32; 2], effect: Effect, what: &'static str) {
        let rule = self.plan.rule_of(effect);
        self.keep(PlanMismatch {
            pixel,
            effect: Some(effect),
            rule,
            what,
        });
    }

    /// Keeps a difference, if it is the first in the order of pixels.
    pub(crate) fn keep(&self, mismatch: PlanMismatch) {
        let mut first = self.first.lock().unwrap_or_else(PoisonError::into_inner);
        let order = |mismatch: &PlanMismatch| (mismatch.pixel[1], mismatch.pixel[0]);
        if first
            .as_ref()
            .is_none_or(|first| order(&mismatch) < order(first))
        {
            *first = Some(mismatch);
        }
    }
}

/// The first pixel whose bits differ.
pub(crate) fn first_difference(
    planned: &Film,
    naive: &Film,
    job: &RenderSelection,
) -> Option<[u32; 2]> {
    let bits = |pixel: &[f64; 3]| pixel.map(f64::to_bits);
    let mut pairs = planned.image.pixels.iter().zip(&naive.image.pixels);
    let index = pairs.position(|(a, b)| bits(a) != bits(b))?;
    let [x, y] = job.crop.map_or([0, 0], |crop| [crop.x, crop.y]);
    let (row, column) = (
        index / planned.image.width as usize,
        index % planned.image.width as usize,
    );
    Some([x + to_u32(column), y + to_u32(row)])
}
