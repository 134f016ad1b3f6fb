//! Messages of an editor are answered.

#![no_main]
libfuzzer_sys::fuzz_target!(|bytes: &[u8]| rtc::internals::cli::trial::messages(bytes));
