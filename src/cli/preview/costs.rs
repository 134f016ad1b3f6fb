//! What accuracy costs in the scene that is shown: the table of `rtc cost --effort quick`.

use super::Failure;
use crate::cli::cost::{about, on_bench};
use crate::ir::Scene;
use crate::study::{self, Effort};

/// What draws the samples; that of `rtc cost` without a flag.
const SEED: u64 = 1;

/// The table of a scene of this name; `None` if the work is to stop.
pub(super) fn table(
    (name, scene): (&str, &Scene),
    threads: usize,
    is_going: &(dyn Fn() -> bool + Sync),
) -> Result<Option<String>, Failure> {
    let study = on_bench(threads, is_going, |bench| {
        study::study(scene, about(name, scene), Effort::QUICK, SEED, &bench)
    })?;
    Ok(study.ok().map(|study| study::table(&study)))
}
