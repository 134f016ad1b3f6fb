//! A proven scene is written as glTF and as a text, and accepted.

#![no_main]
libfuzzer_sys::fuzz_target!(|bytes: &[u8]| rtc::internals::pipeline::trial::written(bytes));
