#!/usr/bin/env bash
# Whether Mitsuba and POV-Ray show what `rtc compile --emit` writes as rtc shows the scene: pictures of both, and how far they are
# apart beyond their noise. Fails where that is more than it should be. Peers are brought by setup.sh; RTC names a program that is built.
set -euo pipefail
cd "$(dirname "$0")/../.."
. benches/driver.sh
benches/peers/setup.sh
RTC=$(rtc)
export RTC
target/peers/venv/bin/python benches/peers/twins.py target/peers
