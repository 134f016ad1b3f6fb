#!/usr/bin/env bash
# Whether Mitsuba and POV-Ray show what `rtc compile --emit` writes as `rtc` shows the scene: the
# difference of both pictures beyond their noise, as rows in Markdown. Fails if it is too large.
# setup.sh installs the peers.
. "$(dirname "$0")/../driver.sh"
benches/peers/setup.sh
RTC=$(rtc)
export RTC
exec target/peers/venv/bin/python benches/peers/twins.py target/peers
