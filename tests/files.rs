//! The suites that find their tests: each is a file of this repo, or of `../shared` where that is at hand.

#![expect(
    clippy::unwrap_used,
    clippy::disallowed_methods,
    reason = "a test stops at the first surprise and reads what it checks"
)]

mod cases;
mod compiled;
mod hashed;
mod obj_oracle;
mod ray_counts;
mod repo;
mod scale;
mod scene_laws;
mod shared;
mod small;
mod suite;
mod texts;
mod to_gltf;

use std::process::ExitCode;

fn main() -> ExitCode {
    let suites = [
        cases::trials(),
        compiled::trials(),
        shared::trials(),
        to_gltf::trials(),
    ];
    suite::run(suites.into_iter().flatten().collect())
}
