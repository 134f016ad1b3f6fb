//! Tests of files that not everybody has: the scenes and figures of the course, the scenes that
//! people published for it, the corpus of the Khronos validator. They lie in `../shared`, or in the
//! folder that `RTC_SHARED` names; a test whose files are not there is counted as ignored.

#![expect(
    clippy::unwrap_used,
    clippy::print_stdout,
    clippy::disallowed_methods,
    reason = "a test stops at the first surprise, tells what it did, and reads what it checks"
)]

mod assets;
mod corpus;
mod dialects;
mod energy;
mod exchange;
mod exports;
mod fates;
mod figures;
mod gltf;
mod hosts;
mod laws;
mod looks;
mod models;
mod objs;
mod oracle;
mod paths;
mod pictures;
mod plain;
mod plan;
mod scenes;
mod seen;
mod stages;
mod wild;
mod written;

use libtest_mimic::Trial;

/// All its trials.
pub(crate) fn trials() -> Vec<Trial> {
    [
        assets::trials(),
        corpus::trials(),
        dialects::trials(),
        energy::trials(),
        exchange::trials(),
        exports::trials(),
        fates::trials(),
        figures::trials(),
        gltf::trials(),
        hosts::trials(),
        laws::trials(),
        looks::trials(),
        models::trials(),
        objs::trials(),
        paths::trials(),
        pictures::trials(),
        plain::trials(),
        plan::trials(),
        seen::trials(),
        stages::trials(),
        wild::trials(),
        written::trials(),
    ]
    .into_iter()
    .flatten()
    .collect()
}
