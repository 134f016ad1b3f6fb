//! Which vector instructions the user wants: the variable `RTC_SIMD` names them.

use super::Failure;
use rtc_render::SimdLevel;

/// Those that `RTC_SIMD` names, or the best of this machine.
pub(super) fn level() -> Result<SimdLevel, Failure> {
    let Some(name) = std::env::var_os("RTC_SIMD") else {
        return Ok(SimdLevel::best());
    };
    let name = name.to_string_lossy();
    SimdLevel::named(&name).ok_or_else(|| {
        let all = SimdLevel::NAMES.into_iter();
        let there: Vec<_> = all
            .filter(|name| SimdLevel::named(name).is_some())
            .collect();
        Failure::Failed(format!(
            "RTC_SIMD: this machine has no `{name}`, but {}",
            there.join(", ")
        ))
    })
}
