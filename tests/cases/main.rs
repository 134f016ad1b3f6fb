//! A test is a file: each of those below `tests/render`, `tests/diagnostics`, `tests/ir` and
//! `scenes` is one, which runs by its name, as `cargo test --test cases render/light/sun`.
//!
//! `RTC_UPDATE=1` writes the expectations of the tests that run; nothing else does.

#![expect(
    clippy::unwrap_used,
    clippy::disallowed_methods,
    reason = "a test stops at the first surprise and reads what it checks"
)]

mod render;
#[path = "../suite/mod.rs"]
mod suite;

use std::process::ExitCode;

fn main() -> ExitCode {
    suite::run(render::trials())
}
