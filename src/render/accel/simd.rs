//! The SIMD instruction sets of a machine, and the choice of one. All give the same bits.

use fearless_simd::{Fallback, Level};

/// The SIMD instructions that BVHs are searched with.
#[derive(Clone, Copy, Debug)]
pub struct SimdLevel(SimdTokens);

/// Proofs that the machine has the instructions.
#[derive(Clone, Copy, Debug)]
pub(crate) enum SimdTokens {
    /// None: one lane after the other.
    Scalar(Fallback),
    /// SSE2 of x86.
    #[cfg(target_arch = "x86_64")]
    Sse2(fearless_simd::Sse2),
    /// AVX2 of x86.
    #[cfg(target_arch = "x86_64")]
    Avx2(fearless_simd::Avx2),
    /// AVX-512 of x86, of Ice Lake and later.
    #[cfg(target_arch = "x86_64")]
    Avx512(fearless_simd::Avx512),
    /// NEON of 64-bit ARM.
    #[cfg(target_arch = "aarch64")]
    Neon(fearless_simd::aarch64::Neon),
    /// The SIMD of WebAssembly, where the program is built for it.
    #[cfg(target_feature = "simd128")]
    Wasm(fearless_simd::wasm32::WasmSimd128),
}

impl SimdLevel {
    /// The names of all levels of all machines.
    pub const NAMES: [&'static str; 6] = ["scalar", "sse2", "avx2", "avx512", "neon", "wasm"];

    /// The best that this machine has.
    #[must_use]
    pub fn best() -> Self {
        let best = ["wasm", "neon", "avx512", "avx2", "sse2"].into_iter();
        best.filter_map(Self::named)
            .next()
            .unwrap_or(Self(SimdTokens::Scalar(Fallback::new())))
    }

    /// The level of a name; `None` if this machine lacks it or it is no name of a level.
    #[must_use]
    pub fn named(name: &str) -> Option<Self> {
        if name == "scalar" {
            return Some(Self(SimdTokens::Scalar(Fallback::new())));
        }
        Self::native(name, Level::new()).map(Self)
    }

    #[cfg(target_arch = "x86_64")]
    fn native(name: &str, level: Level) -> Option<SimdTokens> {
        match name {
            "sse2" => level.as_sse2().map(SimdTokens::Sse2),
            "avx2" => level.as_avx2().map(SimdTokens::Avx2),
            "avx512" => level.as_avx512().map(SimdTokens::Avx512),
            _ => None,
        }
    }

    #[cfg(target_arch = "aarch64")]
    fn native(name: &str, level: Level) -> Option<SimdTokens> {
        level
            .as_neon()
            .filter(|_| name == "neon")
            .map(SimdTokens::Neon)
    }

    #[cfg(target_feature = "simd128")]
    fn native(name: &str, level: Level) -> Option<SimdTokens> {
        level
            .as_wasm_simd128()
            .filter(|_| name == "wasm")
            .map(SimdTokens::Wasm)
    }

    #[cfg(not(any(
        target_arch = "x86_64",
        target_arch = "aarch64",
        target_feature = "simd128"
    )))]
    fn native(_: &str, _: Level) -> Option<SimdTokens> {
        None
    }

    /// Its name.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self.0 {
            SimdTokens::Scalar(_) => "scalar",
            #[cfg(target_arch = "x86_64")]
            SimdTokens::Sse2(_) => "sse2",
            #[cfg(target_arch = "x86_64")]
            SimdTokens::Avx2(_) => "avx2",
            #[cfg(target_arch = "x86_64")]
            SimdTokens::Avx512(_) => "avx512",
            #[cfg(target_arch = "aarch64")]
            SimdTokens::Neon(_) => "neon",
            #[cfg(target_feature = "simd128")]
            SimdTokens::Wasm(_) => "wasm",
        }
    }

    /// The token that the machine has it.
    #[inline]
    pub(crate) fn tokens(self) -> SimdTokens {
        self.0
    }
}

/// The SIMD instructions that each machine of this architecture has, for unit tests of functions
/// over lanes.
#[cfg(all(test, target_arch = "x86_64"))]
pub(crate) fn baseline() -> fearless_simd::Sse2 {
    let level = Level::new().as_sse2();
    level.expect("each x86-64 has SSE2")
}

/// As on x86-64.
#[cfg(all(test, target_arch = "aarch64"))]
pub(crate) fn baseline() -> fearless_simd::aarch64::Neon {
    let level = Level::new().as_neon();
    level.expect("each 64-bit ARM has NEON")
}

/// One lane after the other, where no SIMD instructions are common to all machines.
#[cfg(all(test, not(any(target_arch = "x86_64", target_arch = "aarch64"))))]
pub(crate) fn baseline() -> Fallback {
    Fallback::new()
}

/// Does the same with the instructions of a level, named `$simd` within; without SIMD instructions
/// `$alone`, if that is given.
macro_rules! at_level {
    ($level:expr, $simd:ident => $what:expr) => {
        $crate::accel::simd::at_level!($level, $simd => $what, scalar($simd) => $what)
    };
    ($level:expr, $simd:ident => $what:expr, scalar => $alone:expr) => {
        $crate::accel::simd::at_level!($level, $simd => $what, scalar(_) => $alone)
    };
    ($level:expr, $simd:ident => $what:expr, scalar($scalar:pat) => $alone:expr) => {{
        #[cfg(any(
            target_arch = "x86_64",
            target_arch = "aarch64",
            target_feature = "simd128"
        ))]
        use fearless_simd::Simd;
        use $crate::accel::simd::SimdTokens;
        match $level.tokens() {
            SimdTokens::Scalar($scalar) => $alone,
            #[cfg(target_arch = "x86_64")]
            SimdTokens::Sse2($simd) => $simd.vectorize(
                #[inline(always)]
                || $what,
            ),
            #[cfg(target_arch = "x86_64")]
            SimdTokens::Avx2($simd) => $simd.vectorize(
                #[inline(always)]
                || $what,
            ),
            #[cfg(target_arch = "x86_64")]
            SimdTokens::Avx512($simd) => $simd.vectorize(
                #[inline(always)]
                || $what,
            ),
            #[cfg(target_arch = "aarch64")]
            SimdTokens::Neon($simd) => $simd.vectorize(
                #[inline(always)]
                || $what,
            ),
            #[cfg(target_feature = "simd128")]
            SimdTokens::Wasm($simd) => $simd.vectorize(
                #[inline(always)]
                || $what,
            ),
        }
    }};
}
pub(crate) use at_level;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_level_is_found_by_its_own_name() {
        assert!(SimdLevel::named("sse9").is_none());
        assert_eq!(
            SimdLevel::named("scalar").map(SimdLevel::name),
            Some("scalar")
        );
        for name in SimdLevel::NAMES {
            let level = SimdLevel::named(name);
            assert!(level.is_none_or(|level| level.name() == name), "{name}");
        }
        assert_ne!(SimdLevel::best().name(), "scalar");
    }
}
