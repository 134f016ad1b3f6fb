//! Plan validation: renders the picture again without pruning.

use super::World;
use super::any::render;
use super::shape::Prepare;
use crate::film::heartbeat::PixelObserver;
use crate::film::{Crop, Film, RenderSelection};
use crate::frame::verify::{PlanMismatch, PlanVerification, first_difference};
use crate::shape::{PlainShape, PlainShapeF32, Shape};
use rtc_plan::{Arithmetic, Effect, Plan, Rule, RuleSet};
use rtc_valid::ValidScene;

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
    let planned = render(scene, plan, job, on_pixel)?;
    let (naive, verify) = match plan.arithmetic {
        Arithmetic::Robust => naively::<Shape>(scene, plan, job, on_pixel)?,
        Arithmetic::Plain => naively::<PlainShape>(scene, plan, job, on_pixel)?,
        Arithmetic::F32 => naively::<PlainShapeF32>(scene, plan, job, on_pixel)?,
    };
    if !plan.rules.contains(Rule::Cut)
        && let Some((pixel, color)) = first_difference(&planned, &naive, job)
    {
        verify.keep(blame(scene, plan, job, pixel, color, on_pixel)?);
    }
    Some(verify.into_first().map_or(Ok(planned), Err))
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

/// The rule without which a pixel has the same value as without all rules; `None` if `on_pixel`
/// said stop.
fn blame(
    scene: &ValidScene,
    plan: &Plan,
    job: &RenderSelection,
    pixel: [u32; 2],
    color: [f64; 3],
    on_pixel: &PixelObserver<'_>,
) -> Option<PlanMismatch> {
    let [x, y] = pixel;
    let crop = Some(Crop {
        x,
        y,
        width: 1,
        height: 1,
    });
    let mut mismatch = PlanMismatch {
        pixel,
        effect: Effect::Surfaces,
        rule: None,
        what: "the pixel is another without the rules",
    };
    for hit_mask in &plan.statuses {
        let Some(rule) = hit_mask.rule.filter(|rule| plan.rules.contains(*rule)) else {
            continue;
        };
        let without = Plan::with_arithmetic(plan.arithmetic, scene, plan.rules.without(rule));
        let film = render(scene, &without, &RenderSelection { crop, ..*job }, on_pixel)?;
        if film.image.pixels.first() == Some(&color) {
            (mismatch.effect, mismatch.rule) = (hit_mask.effect, Some(rule));
            break;
        }
    }
    Some(mismatch)
}
