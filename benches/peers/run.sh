#!/usr/bin/env bash
# Embree, POV-Ray, Mitsuba, Cycles, f3d and `rtc` in turns, in one run: RUNS turns of each (7).
# Writes the tables of peers.md. `run.sh [--simd LEVEL] [KIND…]` measures only rays, course,
# courtyard, assets, models, growth or cores and keeps the other tables. LEVEL (avx2) limits the
# vector instructions of `rtc`; the peers choose theirs. The rings have 3840 × 2160 pixels and take
# at most 3 turns of some four minutes; RINGS=480x270 makes them smaller. Wants an idle machine of
# two cores.
. "$(dirname "$0")/../driver.sh"
benches/peers/setup.sh
folder=target/peers
python=$folder/venv/bin/python
if [ "${1:-}" = --simd ]; then
    export RTC_SIMD=$2
    shift 2
fi
if [ -z "${RTC_PROFILE:-}" ]; then
    # As it is released: optimised by a profile of pictures.
    CARGO_BUILD_TARGET=$(rustc -vV | sed -n 's/host: //p')
    RUSTFLAGS=-Cprofile-use=$(dist/profile.sh "$CARGO_BUILD_TARGET")
    export CARGO_BUILD_TARGET RUSTFLAGS
fi
RTC=$(rtc)
RAYS=$(driver rays)
PATHS=$(driver paths)
RINGS=${RINGS:-3840x2160}
RESULTS=$folder/results-${RTC_SIMD:-best}.json
export RTC RAYS PATHS RINGS RESULTS
"$python" benches/peers/scenes.py "$folder"
[ $# != 0 ] || set -- rays course courtyard assets models growth cores
"$python" benches/peers/turns.py "$folder" "${RUNS:-7}" "$@"
"$python" benches/peers/tables.py "$RESULTS" | python3 benches/page.py peers peers
