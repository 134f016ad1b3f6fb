//! A scene in any form is proven or refused, and a proven one survives both forms of the IR.

#![no_main]
libfuzzer_sys::fuzz_target!(|bytes: &[u8]| rtc::internals::pipeline::trial::check(bytes));
