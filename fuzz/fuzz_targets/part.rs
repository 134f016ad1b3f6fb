//! A part of a picture, or what was saved of one, is read or refused.

#![no_main]
libfuzzer_sys::fuzz_target!(|bytes: &[u8]| rtc::internals::pipeline::trial::part(bytes));
