#!/usr/bin/env bash
# What robust arithmetic costs beside that of textbooks: CPU time by turns on one thread, medians, for each scene of the
# repo, or for the scenes given; and how many pixels the plain ones change. Instructions too where valgrind is at hand.
set -euo pipefail
cd "$(dirname "$0")/.."
. benches/driver.sh
driver=$(driver arithmetic)
scenes=("$@")
[ ${#scenes[@]} -gt 0 ] || scenes=(scenes/*.yaml)

"$driver" --cost "${REPEATS:-5}" "${scenes[@]}"
if command -v valgrind >/dev/null; then
    for scene in "${scenes[@]:0:3}"; do
        for arithmetic in robust plain f32; do
            count=$(valgrind --tool=callgrind --callgrind-out-file=/dev/null --toggle-collect='*::render_with*' \
                "$driver" --once "$arithmetic" "$scene" 2>&1 | sed -n 's/.*Collected : //p')
            printf '%-45s %-6s %s instructions\n' "$(basename "$scene" .yaml)" "$arithmetic" "$count"
        done
    done
fi
