//! A text is put right where its findings say how, and has no more errors then.

#![no_main]
libfuzzer_sys::fuzz_target!(|bytes: &[u8]| rtc::internals::pipeline::trial::fix(bytes));
