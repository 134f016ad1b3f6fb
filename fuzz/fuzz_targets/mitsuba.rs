//! A scene of Mitsuba with the files that it names is read or refused.

#![no_main]
libfuzzer_sys::fuzz_target!(|bytes: &[u8]| rtc_fuzz::mitsuba(bytes));
