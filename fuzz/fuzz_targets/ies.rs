//! A photometric file of a lamp is read or refused.

#![no_main]
libfuzzer_sys::fuzz_target!(|bytes: &[u8]| rtc_fuzz::ies(bytes));
