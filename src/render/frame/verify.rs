//! Validation of a plan: the picture is made once more with everything that was left out, and what
//! the plan says adds nothing is looked at where it is added.

use crate::plan::{Arithmetic, Effect, Plan, Rule, Rules};
use crate::render::film::heartbeat::OnPixel;
use crate::render::film::{Crop, Film, Job};
use crate::render::shape::Shape;
use crate::render::shape::plain::PlainShape;
use crate::render::world::World;
use crate::render::world::any;
use crate::render::world::shape::Prepare;
use crate::valid::Proof;
use std::sync::{Mutex, PoisonError};

/// Something that a plan left out and that shows.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Mismatch {
    /// The pixel, from the upper left.
    pub pixel: [u32; 2],
    /// The effect that was left out.
    pub effect: Effect,
    /// The rule that left it out, where the plan has one for that effect.
    pub rule: Option<Rule>,
    /// What was seen.
    pub what: &'static str,
}

/// A plan under validation, and the first fault in the order of pixels.
pub(in crate::render) struct Verify {
    pub(in crate::render) plan: Plan,
    first: Mutex<Option<Mismatch>>,
}

impl Verify {
    /// Notes a fault, if its pixel comes before those noted so far: of one pixel the first cause is
    /// kept.
    pub(in crate::render) fn report(&self, pixel: [u32; 2], effect: Effect, what: &'static str) {
        let rule = self.plan.rule_of(effect);
        self.keep(Mismatch {
            pixel,
            effect,
            rule,
            what,
        });
    }

    /// Keeps a fault, if it is the first in the order of pixels.
    fn keep(&self, mismatch: Mismatch) {
        let mut first = self.first.lock().unwrap_or_else(PoisonError::into_inner);
        let order = |mismatch: &Mismatch| (mismatch.pixel[1], mismatch.pixel[0]);
        if first
            .as_ref()
            .is_none_or(|first| order(&mismatch) < order(first))
        {
            *first = Some(mismatch);
        }
    }
}

/// Renders as planned and without rules, and compares: `None` if `on_pixel` said stop, else the
/// film as planned, or the first fault.
///
/// # Errors
/// If something that was left out adds something.
pub fn verify(
    scene: &Proof,
    plan: &Plan,
    job: &Job,
    on_pixel: &OnPixel<'_>,
) -> Option<Result<Film, Mismatch>> {
    let planned = any::render(scene, plan, job, on_pixel)?;
    let (naive, verify) = match plan.arithmetic {
        Arithmetic::Robust => naively::<Shape>(scene, plan, job, on_pixel)?,
        Arithmetic::Plain => naively::<PlainShape<f64>>(scene, plan, job, on_pixel)?,
        Arithmetic::F32 => naively::<PlainShape<f32>>(scene, plan, job, on_pixel)?,
    };
    if !plan.rules.contains(Rule::Cut)
        && let Some((pixel, color)) = first_difference(&planned, &naive, job)
    {
        verify.keep(blame(scene, plan, job, pixel, color, on_pixel)?);
    }
    let first = verify
        .first
        .into_inner()
        .unwrap_or_else(PoisonError::into_inner);
    Some(first.map_or(Ok(planned), Err))
}

/// The film without rules, and what it shows of a plan.
fn naively<S: Prepare>(
    scene: &Proof,
    plan: &Plan,
    job: &Job,
    on_pixel: &OnPixel<'_>,
) -> Option<(Film, Verify)> {
    let mut world = World::<S>::prepare(scene, &Plan::by(plan.arithmetic, scene, Rules::NONE));
    world.verify = Some(Verify {
        plan: plan.clone(),
        first: Mutex::new(None),
    });
    let naive = world.render_by_few(job, on_pixel)?;
    Some((naive, world.verify?))
}

/// The first pixel whose bits differ, and its value without the rules.
fn first_difference(planned: &Film, naive: &Film, job: &Job) -> Option<([u32; 2], [f64; 3])> {
    let bits = |pixel: &[f64; 3]| pixel.map(f64::to_bits);
    let mut pairs = planned.image.pixels.iter().zip(&naive.image.pixels);
    let index = pairs.position(|(a, b)| bits(a) != bits(b))?;
    let [x, y] = job.crop.map_or([0, 0], |crop| [crop.x, crop.y]);
    let (row, column) = (
        index / planned.image.width as usize,
        index % planned.image.width as usize,
    );
    let offset = |place: usize| u32::try_from(place).unwrap_or(u32::MAX);
    Some((
        [x + offset(column), y + offset(row)],
        naive.image.pixels[index],
    ))
}

/// The rule without which a pixel has the value it has without all rules; `None` if `on_pixel` said
/// stop.
fn blame(
    scene: &Proof,
    plan: &Plan,
    job: &Job,
    pixel: [u32; 2],
    color: [f64; 3],
    on_pixel: &OnPixel<'_>,
) -> Option<Mismatch> {
    let [x, y] = pixel;
    let crop = Some(Crop {
        x,
        y,
        width: 1,
        height: 1,
    });
    let mut mismatch = Mismatch {
        pixel,
        effect: Effect::Surfaces,
        rule: None,
        what: "the pixel is another without the rules",
    };
    for verdict in &plan.verdicts {
        let Some(rule) = verdict.rule.filter(|rule| plan.rules.contains(*rule)) else {
            continue;
        };
        let without = Plan::by(plan.arithmetic, scene, plan.rules.without(rule));
        let film = any::render(scene, &without, &Job { crop, ..*job }, on_pixel)?;
        if film.image.pixels.first() == Some(&color) {
            (mismatch.effect, mismatch.rule) = (verdict.effect, Some(rule));
            break;
        }
    }
    Some(mismatch)
}
