# shellcheck shell=bash
# Shared by the scripts of this folder. Each of them begins with
#
#     . "$(dirname "$0")/driver.sh"
#
# which ends the script at the first failure and goes to the root of the repository. Programs are
# built in the profile `dist`, as they are released, but with symbols. RTC_PROFILE names another
# profile.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

# What pages say of the version that they were measured with.
STATE="Measured at commit $(git rev-parse --short HEAD 2>/dev/null || echo unknown) ($(date -I))."
export STATE

built=(cargo build --quiet --profile "${RTC_PROFILE:-dist}" --config profile.dist.strip=false
    --message-format json-render-diagnostics)

# `executable KIND`: prints the path of the program, from the messages of cargo.
executable() {
    sed -n "s/.*\"kind\":\\[\"$1\"\\].*\"executable\":\"\\([^\"]*\\)\".*/\\1/p"
}

# `rtc`: builds `rtc` and prints its path. The variable RTC names a program that exists.
rtc() {
    if [ -n "${RTC:-}" ]; then
        realpath "$RTC"
    else
        "${built[@]}" --bin rtc | executable bin
    fi
}

# `driver NAME`: builds benches/NAME.rs and prints its path. The variable of the same name in
# capitals names a program that exists: PATHS for `paths`.
driver() {
    local given=${1^^}
    if [ -n "${!given:-}" ]; then
        realpath "${!given}"
    else
        "${built[@]}" --bench "$1" | executable bench
    fi
}

# `driver_for TARGET NAME LEVEL`: builds benches/NAME.rs for another machine, without the command
# line, at an optimisation level, and prints its path.
driver_for() {
    CARGO_TARGET_AARCH64_UNKNOWN_LINUX_MUSL_LINKER=rust-lld cargo bench --locked --no-run --quiet \
        --profile dev --no-default-features --bench "$2" --target "$1" \
        --config "profile.dev.opt-level=$3" --message-format json-render-diagnostics |
        executable bench
}

# `instructions PATTERN PROGRAM…`: counts the instructions of a run, by valgrind: those of the
# functions whose names match the pattern with all that they call, or all if it is empty.
instructions() {
    local pattern=$1
    shift
    valgrind --tool=callgrind --callgrind-out-file=/dev/null \
        ${pattern:+"--toggle-collect=$pattern"} "$@" 2>&1 >/dev/null |
        sed -n 's/.*Collected : //p'
}

# `needs PATH`: ends the script, without a failure, if a file or folder is not there.
needs() {
    if [ ! -e "$1" ]; then
        echo "no $1: nothing to measure" >&2
        exit 0
    fi
}

# `python_with PACKAGE…`: prints the path of a Python that has these packages of PyPI. The variable
# PYTHON names one that exists.
python_with() {
    local folder
    if [ -n "${PYTHON:-}" ]; then
        echo "$PYTHON"
        return
    fi
    folder=target/python/$(tr ' ' '+' <<<"$*")
    if [ ! -e "$folder/ready" ]; then
        python3 -m venv "$folder"
        "$folder/bin/pip" install --quiet --disable-pip-version-check "$@" >&2
        touch "$folder/ready"
    fi
    echo "$folder/bin/python"
}
