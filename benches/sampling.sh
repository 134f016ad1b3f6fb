#!/usr/bin/env bash
# Traced paths at equal time, before and after a change: `benches/sampling.sh BEFORE`, where BEFORE is the program `paths` of another
# commit (`cargo build --release --bench paths` there); AFTER, if set, is that of this one. Prints relMSE, CPU time and efficiency
# of 10 scenes and of streets of lamps as Markdown, as in sampling.md; SIDE, SAMPLES, REFERENCE, TURNS, STREETS (how many lamps each) and
# ONLY (names, by `;`) set how much is measured.
# Reads ../shared/gltf.
set -euo pipefail
cd "$(dirname "$0")/.."
. benches/driver.sh
[ $# = 1 ] || { echo 'usage: benches/sampling.sh BEFORE' >&2; exit 2; }
before=$(realpath "$1")
[ -d ../shared/gltf ] || { echo 'no ../shared/gltf here' >&2; exit 0; }
RTC=$(rtc) exec python3 benches/sampling.py "$before" "${AFTER:-$(driver paths)}" ../shared/gltf/assets ../shared/gltf/env
