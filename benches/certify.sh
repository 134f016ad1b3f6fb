#!/usr/bin/env bash
# What `rtc certify` proves, as a table in Markdown: the proven pixels of each scene, the CPU time
# beside that of `rtc render`, and random proven pixels beside an evaluation of the same formulas by
# MPFR with 200 bits, written in Python. Fails if one of them is wrong.
# `certify.sh [SCENE...]`; by default the scenes of the course and of the tutorial. PIXELS of each
# scene are checked (500), JOBS scenes at once (1); each time is the least of ROUNDS (3).
. "$(dirname "$0")/driver.sh"
RTC=$(rtc)
export RTC
if [ $# = 0 ]; then
    # All but those that are path-traced.
    for scene in scenes/*.yaml docs/book/scenes/tutorial-*.yaml; do
        "$RTC" certify "$scene" -o target/certify.png --size 4 --quiet 2>/dev/null &&
            set -- "$@" "$scene"
    done
fi
python=$(python_with gmpy2 pillow)
exec "$python" benches/certify.py "$@"
