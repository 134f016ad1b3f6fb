//! `IO`: files that can't be read or written.

super::codes! { IO:
    CANNOT_READ = "IO001", Error, "a file cannot be read";
    TOO_LARGE = "IO002", Error, "a file is too large";
    OVER_LIMIT = "IO003", Error, "a run would take more memory or work than its limit";
    SETTINGS_WRONG = "IO004", Error, "an `rtc.toml` has a mistake";
    SETTINGS_UNKNOWN = "IO005", Warning, "an `rtc.toml` has an unknown key";
    SETTINGS_READ = "IO006", Note, "settings come from an `rtc.toml`";
    SETTINGS_UNTRUSTED = "IO007", Warning, "an untrusted `rtc.toml` has a setting that needs trust";
}
