//! An arbitrary scene is proven or refused.

#![no_main]
libfuzzer_sys::fuzz_target!(|bytes: &[u8]| rtc::internals::pipeline::trial::validate_any(bytes));
