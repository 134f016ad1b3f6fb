#!/usr/bin/env bash
# Public scenes of Mitsuba, pbrt and USD: how many are read, rendered, and equal to Mitsuba's own picture; a table to benches/public.md.
# `public.sh [FOLDER]`: the folder of the scenes, by default ../shared/public-scenes. Needs Mitsuba's wheel (`pip install mitsuba`) in
# the Python of PYTHON. JOBS files at once (default: the cores); SIDE pixels wide (48), SPP samples (64), SEEDS of Mitsuba (4). Results
# stay in the folder KEEP (default: target/public), and what is there is not made again.
set -euo pipefail
cd "$(dirname "$0")/.."
. benches/driver.sh
RTC=$(rtc)
export RTC
exec "${PYTHON:-python3}" benches/public.py "${1:-../shared/public-scenes}" "${KEEP:-target/public}"
