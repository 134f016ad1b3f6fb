#!/usr/bin/env bash
# Embree, POV-Ray, Mitsuba, Cycles and rtc by turns, in one run: RUNS turns of each, 7 without, and the table of all in
# benches/README.md. `benches/peers/run.sh [KIND…]` measures only rays, course, courtyard, assets or cores and keeps the rest.
# The rings are 3840 × 2160 pixels and take at most 3 turns, of some four minutes each; RINGS=480x270 makes them smaller. Wants an idle
# machine of two cores.
set -euo pipefail
cd "$(dirname "$0")/../.."
. benches/driver.sh
benches/peers/setup.sh
folder=target/peers python=target/peers/venv/bin/python
RTC=$(rtc) RAYS=$(driver rays) PATHS=$(driver paths) RINGS=${RINGS:-3840x2160}
export RTC RAYS PATHS RINGS
"$python" benches/peers/scenes.py "$folder"
kinds=("$@")
[ ${#kinds[@]} -gt 0 ] || kinds=(rays course courtyard assets cores)
"$python" benches/peers/turns.py "$folder" "${RUNS:-7}" "${kinds[@]}"
"$python" benches/peers/tables.py "$folder/results.json" | python3 benches/page.py peers
