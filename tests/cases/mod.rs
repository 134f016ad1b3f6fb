//! A test is a file: each of those below `tests/render`, `tests/diagnostics`, `tests/ir`, `scenes`
//! and `fuzz/corpus` is one, which runs by its name, as `cargo test --test files render/light/sun`.
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
mod hashes;
mod ir;
mod permissions;
mod render;

use libtest_mimic::Trial;

/// All its trials.
pub(crate) fn trials() -> Vec<Trial> {
    [
        render::trials(),
        diagnostics::trials(),
        gltf::trials(),
        ir::trials(),
        hashes::trials(),
        corpora::trials(),
        permissions::trials(),
    ]
    .into_iter()
    .flatten()
    .collect()
}
