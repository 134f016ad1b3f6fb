//! Bytes are decoded or refused, in both forms of the IR.

#![no_main]
libfuzzer_sys::fuzz_target!(|bytes: &[u8]| rtc::internals::pipeline::trial::decode(bytes));
