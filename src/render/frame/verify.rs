//! Validation of a plan: the picture is made once more with everything that was left out, and what
//! the plan says adds nothing is looked at where it is added.

use crate::plan::{Arithmetic, Effect, Plan, Rule, Rules};
use crate::render::film::heartbeat::Proceed;
use crate::render::film::{Film, Job};
use crate::render::shape::Shape;
use crate::render::shape::plain::PlainShape;
use crate::render::world::World;
use crate::render::world::any;
use crate::render::world::shape::Prepare;
use crate::valid::Proof;
use std::sync::{Mutex, PoisonError};

/// Something that a plan left out and that shows.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Fault {
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
    first: Mutex<Option<Fault>>,
}

impl Verify {
    /// Notes a fault, if its pixel comes before those noted so far: of one pixel the first cause is
    /// kept.
    pub(in crate::render) fn report(&self, pixel: [u32; 2], effect: Effect, what: &'static str) {
        let fault = Fault {
            pixel,
            effect,
            rule: self.plan.rule_of(effect),
            what,
        };
        let mut first = self.first.lock().unwrap_or_else(PoisonError::into_inner);
        let order = |fault: &Fault| (fault.pixel[1], fault.pixel[0]);
        if first
            .as_ref()
            .is_none_or(|first| order(&fault) < order(first))
        {
            *first = Some(fault);
        }
    }
}

/// Renders as planned and without rules, and compares: `None` if `proceed` said stop, else the film
/// as planned, or the first fault.
///
/// # Errors
/// If something that was left out adds something.
pub fn verify(
    scene: &Proof,
    plan: &Plan,
    job: &Job,
    proceed: &Proceed<'_>,
) -> Option<Result<Film, Fault>> {
    let planned = any::render(scene, plan, job, proceed)?;
    let (naive, verify) = match plan.arithmetic {
        Arithmetic::Robust => naively::<Shape>(scene, plan, job, proceed)?,
        Arithmetic::Plain => naively::<PlainShape<f64>>(scene, plan, job, proceed)?,
        Arithmetic::F32 => naively::<PlainShape<f32>>(scene, plan, job, proceed)?,
    };
    if !plan.rules.contains(Rule::Cut) {
        compare(&planned, &naive, job, &verify);
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
    proceed: &Proceed<'_>,
) -> Option<(Film, Verify)> {
    let mut world = World::<S>::prepare(scene, &Plan::by(plan.arithmetic, scene, Rules::NONE));
    world.verify = Some(Verify {
        plan: plan.clone(),
        first: Mutex::new(None),
    });
    let naive = world.render_by_few(job, proceed)?;
    Some((naive, world.verify?))
}

/// Notes a pixel whose bits differ.
fn compare(planned: &Film, naive: &Film, job: &Job, verify: &Verify) {
    let bits = |pixel: &[f64; 3]| pixel.map(f64::to_bits);
    let mut pairs = planned.image.pixels.iter().zip(&naive.image.pixels);
    if let Some(index) = pairs.position(|(a, b)| bits(a) != bits(b)) {
        let index = u32::try_from(index).unwrap_or(u32::MAX);
        let [x, y] = job.crop.map_or([0, 0], |crop| [crop.x, crop.y]);
        let pixel = [
            x + index % planned.image.width,
            y + index / planned.image.width,
        ];
        verify.report(
            pixel,
            Effect::Surfaces,
            "the pixel is another without the rules",
        );
    }
}
