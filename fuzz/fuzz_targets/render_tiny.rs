//! A proven scene is a picture of numbers in [0, 1].

#![no_main]
libfuzzer_sys::fuzz_target!(|bytes: &[u8]| rtc::internals::pipeline::trial::picture(bytes));
