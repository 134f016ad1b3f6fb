//! A test is a file: each of those below `tests/render`, `tests/diagnostics`, `tests/ir`, `scenes`
//! and `fuzz/corpus` is one, which runs by its name, as `cargo test --test cases render/light/sun`.
//!
//! `RTC_UPDATE=1` writes the expectations of the tests that run; nothing else does.

#![expect(
    clippy::unwrap_used,
    clippy::print_stdout,
    clippy::disallowed_methods,
    reason = "a test stops at the first surprise, names it, and reads what it checks"
)]

mod corpora;
mod diagnostics;
mod gltf;
#[path = "../hashed/mod.rs"]
mod hashed;
mod hashes;
mod ir;
mod permissions;
mod render;
#[path = "../small/mod.rs"]
mod small;
#[path = "../suite/mod.rs"]
mod suite;

use std::process::ExitCode;

fn main() -> ExitCode {
    let suites = [
        render::trials(),
        diagnostics::trials(),
        gltf::trials(),
        ir::trials(),
        hashes::trials(),
        corpora::trials(),
        permissions::trials(),
    ];
    suite::run(suites.into_iter().flatten().collect())
}
