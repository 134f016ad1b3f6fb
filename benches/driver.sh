# Builds what the scripts of this folder run, as it is handed out (the profile `dist`, with its symbols), or in the profile that
# RTC_PROFILE names, and prints where it is; to be sourced from the root of the repo.
built=(cargo build --quiet --profile "${RTC_PROFILE:-dist}" --config profile.dist.strip=false --message-format json-render-diagnostics)

# `driver NAME`: the program of benches/NAME.rs.
driver() {
    "${built[@]}" --bench "$1" |
        sed -n 's/.*"kind":\["bench"\].*"executable":"\([^"]*\)".*/\1/p'
}

# `rtc`: the program itself, or RTC where that is set.
rtc() {
    if [ -z "${RTC:-}" ]; then
        "${built[@]}" --bin rtc |
            sed -n 's/.*"kind":\["bin"\].*"executable":"\([^"]*\)".*/\1/p'
    else
        realpath "$RTC"
    fi
}
