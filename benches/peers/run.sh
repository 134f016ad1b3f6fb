#!/usr/bin/env bash
# Embree, POV-Ray, Mitsuba, Cycles and rtc by turns, in one run: RUNS turns of each, 7 without, and the table of all in
# benches/README.md. `benches/peers/run.sh [--simd LEVEL] [KIND…]` measures only rays, course, courtyard, assets, models, growth or
# cores and keeps the rest; LEVEL (avx2) is what rtc may use of a machine that has more; the peers keep what they find.
# The rings are 3840 × 2160 pixels and take at most 3 turns, of some four minutes each; RINGS=480x270 makes them smaller. Wants an idle
# machine of two cores.
set -euo pipefail
cd "$(dirname "$0")/../.."
. benches/driver.sh
benches/peers/setup.sh
folder=target/peers python=target/peers/venv/bin/python
if [ "${1:-}" = --simd ]; then
    export RTC_SIMD=$2
    shift 2
fi
if [ -z "${RTC_PROFILE:-}" ]; then
    # As it is handed out: laid out by the profile of pictures.
    CARGO_BUILD_TARGET=$(rustc -vV | sed -n 's/host: //p')
    RUSTFLAGS=-Cprofile-use=$(dist/profile.sh "$CARGO_BUILD_TARGET")
    export CARGO_BUILD_TARGET RUSTFLAGS
fi
RTC=$(rtc) RAYS=$(driver rays) PATHS=$(driver paths) RINGS=${RINGS:-3840x2160}
export RTC RAYS PATHS RINGS
"$python" benches/peers/scenes.py "$folder"
kinds=("$@")
[ ${#kinds[@]} -gt 0 ] || kinds=(rays course courtyard assets models growth cores)
export RESULTS=$folder/results-${RTC_SIMD:-best}.json
"$python" benches/peers/turns.py "$folder" "${RUNS:-7}" "${kinds[@]}"
"$python" benches/peers/tables.py "$RESULTS" | python3 benches/page.py peers
