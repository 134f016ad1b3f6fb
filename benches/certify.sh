#!/usr/bin/env bash
# What `rtc certify` proves, as Markdown: scene by scene the proven pixels, the CPU time beside that of `rtc render`, and random proven
# pixels beside an evaluation of the same formulas by MPFR with 200 bits, written in Python. Fails where one is wrong.
# `certify.sh [SCENE...]`: by default the scenes of the course, and those of the book's tutorial. PIXELS of each (500), JOBS at once (1),
# ROUNDS of each time (3). Makes a Python environment in target/ with gmpy2 and Pillow from PyPI.
# `benches/certify.sh >benches/certify.md` makes the table that is kept.
set -euo pipefail
cd "$(dirname "$0")/.."
. benches/driver.sh
RTC=${RTC:-$(rtc)}
export RTC
venv=target/certify-python
[ -x "$venv/bin/python" ] || {
    python3 -m venv "$venv"
    "$venv/bin/pip" --quiet install gmpy2 pillow
}
if [ $# = 0 ]; then
    # All but those of path tracing.
    for scene in scenes/*.yaml docs/book/scenes/tutorial-*.yaml; do
        "$RTC" certify "$scene" -o target/certify.png --size 4 --quiet 2>/dev/null && set -- "$@" "$scene"
    done
fi
"$venv/bin/python" benches/certify.py "$@"
