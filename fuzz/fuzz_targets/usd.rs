//! A stage of USD, text, binary or package, with the layers that it names is read or refused.

#![no_main]
libfuzzer_sys::fuzz_target!(|bytes: &[u8]| rtc_fuzz::usd(bytes));
