//! The `rtc` binary.

#![forbid(unsafe_code)]

fn main() {}
