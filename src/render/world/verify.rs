//! Plan validation: renders the picture again without pruning.

use super::World;
use super::any::render;
use super::shape::Prepare;
use crate::film::heartbeat::PixelObserver;
use crate::film::{Crop, Film, RenderSelection};
use crate::frame::verify::{PlanMismatch, PlanVerification, first_difference};
use crate::shape::{PlainShape, PlainShapeF32, Shape};
use rtc_plan::{Arithmetic, Plan, Rule, RuleSet};
use rtc_valid::{Mode, ValidScene};

/// Renders as planned and without rules, and compares: `None` if `on_pixel` said stop, else the
/// planned film, or the first difference.
///
/// # Errors
/// If something that was left out adds something.
pub fn verify(
    scene: &ValidScene,
    plan: &Plan,
    job: &RenderSelection,
    on_pixel: &PixelObserver<'_>,
) -> Option<Result<Film, PlanMismatch>> {
    let (planned, mismatch) = compare(scene, plan, job, on_pixel)?;
    Some(match mismatch {
        None => Ok(planned),
        Some(mismatch) => Err(blame(scene, plan, job, mismatch, on_pixel)?),
    })
}

/// The planned film, and the first difference from that without rules.
fn compare(
    scene: &ValidScene,
    plan: &Plan,
    job: &RenderSelection,
    on_pixel: &PixelObserver<'_>,
) -> Option<(Film, Option<PlanMismatch>)> {
    let planned = render(scene, plan, job, on_pixel)?;
    let (naive, verify) = match plan.arithmetic {
        Arithmetic::Robust => naively::<Shape>(scene, plan, job, on_pixel)?,
        Arithmetic::Plain => naively::<PlainShape>(scene, plan, job, on_pixel)?,
        Arithmetic::F32 => naively::<PlainShapeF32>(scene, plan, job, on_pixel)?,
    };
    if !plan.rules.contains(Rule::Cut)
        && let Some(pixel) = first_difference(&planned, &naive, job)
    {
        verify.keep(PlanMismatch {
            pixel,
            effect: None,
            rule: None,
            what: "the pixel is another without the rules",
        });
    }
    Some((planned, verify.into_first()))
}

/// The film without rules, and its evidence against a plan.
fn naively<S: Prepare>(
    scene: &ValidScene,
    plan: &Plan,
    job: &RenderSelection,
    on_pixel: &PixelObserver<'_>,
) -> Option<(Film, PlanVerification)> {
    let mut world = World::<S>::prepare(
        scene,
        &Plan::with_arithmetic(plan.arithmetic, scene, RuleSet::NONE),
    );
    world.verify = Some(PlanVerification::new(plan.clone()));
    let naive = world.render(job, on_pixel)?;
    Some((naive, world.verify?))
}

/// The mismatch with the rule that is wrong: the last of a few that differ at its pixel without the
/// others. It has none if the plan is not that of its rules, or the features of the integrator
/// alone are too few. `None` if `on_pixel` said stop.
fn blame(
    scene: &ValidScene,
    plan: &Plan,
    job: &RenderSelection,
    mismatch: PlanMismatch,
    on_pixel: &PixelObserver<'_>,
) -> Option<PlanMismatch> {
    let [x, y] = mismatch.pixel;
    let crop = Some(Crop {
        x,
        y,
        width: 1,
        height: 1,
    });
    let is_wrong = |rules| {
        let plan = Plan::with_arithmetic(plan.arithmetic, scene, rules);
        let job = RenderSelection { crop, ..*job };
        Some(compare(scene, &plan, &job, on_pixel)?.1.is_some())
    };
    // A rule of the other integrator chooses its features, and does nothing else.
    let is_path = matches!(scene.settings().mode, Mode::Path(_));
    let mut others = Rule::ALL.into_iter();
    let idle = others.find(|rule| rule.is_of_paths() != is_path)?;
    if !is_wrong(plan.rules)? || is_wrong(RuleSet::NONE.with(idle))? {
        return Some(mismatch);
    }
    let all = Rule::ALL.into_iter();
    let rules = all.filter(|rule| plan.rules.contains(*rule)).collect();
    let rule = isolated(rules, is_wrong)?.last().copied();
    let mut statuses = plan.statuses.iter();
    let of_rule = statuses.find(|status| status.rule.is_some() && status.rule == rule);
    Some(PlanMismatch {
        effect: mismatch.effect.or(of_rule.map(|status| status.effect)),
        rule,
        ..mismatch
    })
}

/// A few of some rules that are wrong together, found by leaving out ever smaller stretches
/// (Zeller, Hildebrandt, "Simplifying and isolating failure-inducing input", 2002).
fn isolated(mut rules: Vec<Rule>, is_wrong: impl Fn(RuleSet) -> Option<bool>) -> Option<Vec<Rule>> {
    let mut size = rules.len();
    while size > 1 {
        size = size.div_ceil(2);
        let mut at = 0;
        while at < rules.len() {
            let mut fewer = rules.clone();
            fewer.drain(at..rules.len().min(at + size));
            if is_wrong(fewer.iter().copied().collect())? {
                rules = fewer;
            } else {
                at += size;
            }
        }
    }
    Some(rules)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::cell::Cell;

    #[test]
    fn a_wrong_rule_is_found_among_all_with_few_trials() {
        for wrong in Rule::ALL {
            let trials = Cell::new(0);
            let found = isolated(Rule::ALL.to_vec(), |rules| {
                trials.set(trials.get() + 1);
                Some(rules.contains(wrong))
            });
            assert_eq!(found, Some(vec![wrong]));
            assert!(trials.get() < 16, "{}", trials.get());
        }
    }

    #[test]
    fn rules_that_are_wrong_together_are_all_found() {
        let together = [Rule::Mode, Rule::Opaque, Rule::PathCull];
        let is_wrong = |rules: RuleSet| Some(rules.contains_all(together.into_iter().collect()));
        let found = isolated(Rule::ALL.to_vec(), is_wrong);
        assert_eq!(found.as_deref(), Some(&together[..]));
        assert_eq!(isolated(Rule::ALL.to_vec(), |_| None), None);
    }
}
