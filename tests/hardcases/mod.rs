//! Hard numeric cases against high-precision truth, and counts over many rays.
//!
//! The truth is made here in double-double ([`hardcases::exact`]), or was once made by arithmetic of
//! 200 digits: `cases.json` and `families.txt`. A line is printed for each case (`cargo test --release hardcases --
//! --nocapture`). `RTC_RAYS` is the number of rays of a count.

#![expect(
    clippy::print_stdout,
    clippy::unwrap_used,
    clippy::disallowed_methods,
    reason = "a test stops at the first surprise and reads files"
)]

mod camera;
mod certified;
mod exact;
mod families;
mod family;
mod gaps;
mod intersect;
mod leaks;
mod limits;
mod mesh;
mod meshes;
mod optics;
mod policies;
mod random;
mod scenes;
mod self_hits;
mod solids;
mod truth;
