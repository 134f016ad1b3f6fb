//! Arguments of the command line are parsed or refused; nothing is carried out.

#![no_main]
libfuzzer_sys::fuzz_target!(|bytes: &[u8]| rtc::internals::cli::trial::arguments(bytes));
