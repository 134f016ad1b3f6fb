#!/usr/bin/env bash
# What people wait for, as a table in Markdown: seconds of the clock and CPU-seconds of
# - the first command of the README and `cargo test`, from an empty clone of the last commit, with
#   crates downloaded,
# - one suite after one changed line,
# - the program that is released; and its size.
# `build.sh [RUNS]`: medians of so many runs (3). Nothing else should run beside it.
. "$(dirname "$0")/driver.sh"

runs=${1:-3}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cargo fetch --locked --quiet

# `within COMMAND…`: runs it in the clone, with its output in files.
within() {
    (cd "$work/rtc" && "$@") >"$work/out" 2>"$work/err"
}

# `measure NAME COMMAND…`: runs it in the clone and notes its seconds: clock, CPU.
measure() {
    local name=$1 TIMEFORMAT='%R %U %S'
    shift
    { time within "$@"; } 2>"$work/time" || {
        cat "$work/err" "$work/out" >&2
        exit 1
    }
    tail -n 1 "$work/time" | awk '{print $1, $2 + $3}' >>"$work/$name"
    printf '%s: %s\n' "$name" "$(tail -n 1 "$work/$name")" >&2
}

for _ in $(seq "$runs"); do
    rm -rf "$work/rtc"
    git clone --quiet . "$work/rtc"
    if [[ -e ../shared ]]; then
        ln -sfn "$(realpath ../shared)" "$work/shared"
    fi
    measure picture cargo run --release --locked -- render scenes/glass.yaml -o glass.png
    measure tests-built cargo test --no-run --locked
    measure tests-run cargo test --locked
    grep -h '^test result' "$work/out" | awk '{ passed += $4; failed += $6; ignored += $8 } END {
        printf "%d passed, %d failed, %d ignored\n", passed, failed, ignored
    }' >"$work/count"
    printf '\n// A changed line.\n' >>"$work/rtc/src/front/course/light.rs"
    measure one-suite cargo test --locked --test suites course::
done
measure dist cargo build --profile dist --locked --bin rtc
bytes=$(wc -c <"$work/rtc/target/dist/rtc")

# `median NAME COLUMN`: of the runs.
median() {
    cut -d ' ' -f "$2" "$work/$1" | sort -g |
        awk '{ row[NR] = $1 } END { print row[int((NR + 1) / 2)] }'
}

cpu=$(sed -n 's/^model name.*: //p' /proc/cpuinfo | head -n 1)
printf '%s %s, %s cores, %s.\n\n' "$STATE" "$cpu" "$(nproc)" "$(rustc --version)"
printf '| work | seconds | CPU-seconds |\n| --- | --: | --: |\n'
row() {
    printf '| %s | %.0f | %.0f |\n' "$2" "$(median "$1" 1)" "$(median "$1" 2)"
}
row picture 'the first command of the README'
row tests-built '"cargo test": building'
row tests-run '"cargo test": running'
row one-suite 'one suite after one changed line'
row dist 'the program that is released'
printf '\nThe program: %s bytes. The tests: %s.\n' "$bytes" "$(cat "$work/count")"
