#!/usr/bin/env bash
# Path-traced pictures at equal time, before and after a change, as a table in Markdown: relMSE, CPU
# time and efficiency of 10 scenes and of streets of lamps. `sampling.sh BEFORE`: the program
# `paths` of another commit (`cargo build --release --bench paths` there). AFTER names that of this
# commit. SIDE, SAMPLES, REFERENCE, TURNS, STREETS (lamps of each) and ONLY (names, separated by
# `;`) set how much is measured. Reads ../shared/gltf.
. "$(dirname "$0")/driver.sh"
[ $# = 1 ] || { echo 'usage: benches/sampling.sh BEFORE' >&2; exit 2; }
before=$(realpath "$1")
needs ../shared/gltf
RTC=$(rtc)
export RTC
after=${AFTER:-$(driver paths)}
exec python3 benches/sampling.py "$before" "$after" ../shared/gltf/{assets,env}
