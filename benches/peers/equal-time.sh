#!/usr/bin/env bash
# The error that rtc, Mitsuba, Cycles and POV-Ray have after the same CPU time, each against its own converged picture, by turns in
# one run, and the table in benches/README.md. TURNS of each, 3 without, SECONDS_EACH for a picture, 1 without: some 4 minutes.
# Peers are brought by setup.sh; one that does not come is left out. RTC and PATHS name programs that are built already.
set -euo pipefail
cd "$(dirname "$0")/../.."
. benches/driver.sh
benches/peers/setup.sh || echo "not all peers are there" >&2
folder=target/peers python=target/peers/venv/bin/python
RTC=$(rtc) PATHS=${PATHS:-$(driver paths)}
export RTC PATHS
[ -e "$folder/Courtyard.yaml" ] || "$python" benches/peers/scenes.py "$folder"
"$python" benches/peers/equal_time.py "$folder" "${TURNS:-3}" >"$folder/equal-time.md"
python3 benches/page.py equal-time <"$folder/equal-time.md"
