//! What accuracy costs in the scene that is shown, as `rtc cost --effort quick` measures it:
//! settings, each with its seconds and its error.

use super::Failure;
use crate::cost::{about, with_runtime};
use rtc_ir::Scene;
use rtc_study::{self as study, Effort, Parameter, Setting, Study, StudyRow};
use serde_json::{Value, json};
use std::collections::BTreeMap;

/// What draws the samples; that of `rtc cost` without a flag.
const SEED: u64 = 1;

/// The costs in a scene of this name with this setting; `None` if the work was cancelled.
pub(super) fn costs(
    (name, scene, own): (&str, &Scene, &Setting),
    threads: usize,
    is_going: &(dyn Fn() -> bool + Sync),
) -> Result<Option<Value>, Failure> {
    let study = with_runtime(threads, &|_| is_going(), |runtime| {
        study::study(scene, about(name, scene), Effort::QUICK, SEED, &runtime)
    })?;
    Ok(study.ok().map(|study| reported(&study, own)))
}

fn reported(study: &Study, own: &Setting) -> Value {
    let used = study.used();
    let best = study::recommended(study).map(|row| row.setting);
    let row = |row: &StudyRow| {
        let setting = &row.setting;
        let other = |parameter: &&Parameter| setting.get(**parameter) != own.get(**parameter);
        let values = used.iter().filter(other);
        let values: BTreeMap<_, _> = values
            .map(|parameter| (parameter, setting.get(*parameter)))
            .collect();
        json!({
            "values": values,
            "words": setting.label(&used),
            "seconds": row.seconds.value,
            "ratio": row.ratio.value,
            "error": row.errors.rmse,
            "most": row.errors.rmse_high,
            "isJudged": row.is_resolved,
            "isFront": row.front,
            "isBest": best == Some(row.setting),
        })
    };
    let rows: Vec<_> = study.rows.iter().map(row).collect();
    json!({ "rows": rows, "advice": study.advice, "report": study::table(study) })
}
