//! A text of the course's format is lowered or refused.

#![no_main]
libfuzzer_sys::fuzz_target!(|bytes: &[u8]| rtc::internals::pipeline::trial::lower(bytes));
