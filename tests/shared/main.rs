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
#[path = "../small/laws.rs"]
mod every;
mod fates;
mod figures;
mod gltf;
mod laws;
mod looks;
mod oracle;
mod paths;
mod pictures;
mod plain;
mod plan;
#[path = "../scale/mod.rs"]
mod scale;
mod scenes;
mod seen;
#[path = "../small/mod.rs"]
mod small;
#[path = "../suite/mod.rs"]
mod suite;
#[path = "../texts/mod.rs"]
mod texts;
#[path = "../small/told.rs"]
mod told;
mod wild;
mod written;

use std::process::ExitCode;

fn main() -> ExitCode {
    let suites = [
        assets::trials(),
        corpus::trials(),
        fates::trials(),
        figures::trials(),
        gltf::trials(),
        laws::trials(),
        looks::trials(),
        paths::trials(),
        pictures::trials(),
        plain::trials(),
        plan::trials(),
        seen::trials(),
        wild::trials(),
        written::trials(),
    ];
    suite::run(suites.into_iter().flatten().collect())
}
