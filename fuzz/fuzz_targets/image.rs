//! A picture file, PNG, JPEG, WebP, KTX2, HDR or EXR, is read or refused.

#![no_main]
libfuzzer_sys::fuzz_target!(|bytes: &[u8]| rtc_fuzz::image(bytes));
