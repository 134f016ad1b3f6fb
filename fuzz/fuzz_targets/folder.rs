//! A scene and the files that it names are proven or refused, and what is found is told.

#![no_main]
libfuzzer_sys::fuzz_target!(|bytes: &[u8]| rtc_fuzz::folder(bytes));
