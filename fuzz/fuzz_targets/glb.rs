//! A .glb file is lowered and proven or refused, and a proven scene survives both forms of the IR.

#![no_main]
libfuzzer_sys::fuzz_target!(|bytes: &[u8]| rtc::internals::pipeline::trial::glb(bytes));
