//! The vector instructions that a driver measures with: those that `RTC_SIMD` names, as in the
//! program.

use rtc::internals::render::SimdLevel;

/// The level of `RTC_SIMD`, or the best of this machine.
pub(crate) fn level() -> SimdLevel {
    std::env::var("RTC_SIMD").map_or_else(
        |_| SimdLevel::best(),
        |name| SimdLevel::named(&name).unwrap_or_else(|| panic!("this machine has no {name}")),
    )
}
