//! The `rtc` binary.
fn main() {}
