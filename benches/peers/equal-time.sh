#!/usr/bin/env bash
# The error of `rtc`, Mitsuba, Cycles and POV-Ray after the same CPU time, each against its own
# converged picture, in turns. Writes the table of equal-time.md. TURNS of each (3), SECONDS_EACH
# CPU-seconds for a picture (1): some 4 minutes. setup.sh installs the peers; one that cannot be
# installed is left out.
. "$(dirname "$0")/../driver.sh"
benches/peers/setup.sh || echo 'not all peers are installed' >&2
folder=target/peers
python=$folder/venv/bin/python
RTC=$(rtc)
PATHS=$(driver paths)
export RTC PATHS
[ -e "$folder/Courtyard.yaml" ] || "$python" benches/peers/scenes.py "$folder"
"$python" benches/peers/equal_time.py "$folder" "${TURNS:-3}" >"$folder/equal-time.md"
python3 benches/page.py equal-time equal-time <"$folder/equal-time.md"
