//! A mesh file of any format is read or refused.

#![no_main]
libfuzzer_sys::fuzz_target!(|bytes: &[u8]| rtc_fuzz::mesh(bytes));
