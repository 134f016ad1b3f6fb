//! Hard numeric cases against high-precision truth.
//!
//! The files are those of `../shared/numerics`, or of the variables `RTC_HARDCASES` and `RTC_HARDCASES_FAMILIES`; the
//! tests that need a file skip with a note where it is absent. A line is printed for each case (`--nocapture`).

#![expect(
    clippy::print_stdout,
    clippy::unwrap_used,
    clippy::disallowed_methods,
    reason = "a test stops at the first surprise and reads files"
)]

mod camera;
mod families;
mod intersect;
mod meshes;
mod optics;
mod policies;
mod scenes;
mod truth;
