# Builds what the scripts of this folder run, in release mode, and prints where it is; to be sourced from the root of the repo.

# `driver NAME`: the program of benches/NAME.rs.
driver() {
    cargo build --release --quiet --bench "$1" --message-format json-render-diagnostics |
        sed -n 's/.*"kind":\["bench"\].*"executable":"\([^"]*\)".*/\1/p'
}

# `rtc`: the program itself, or RTC where that is set.
rtc() {
    if [ -z "${RTC:-}" ]; then
        cargo build --release --quiet --bin rtc --message-format json-render-diagnostics |
            sed -n 's/.*"kind":\["bin"\].*"executable":"\([^"]*\)".*/\1/p'
    else
        realpath "$RTC"
    fi
}
