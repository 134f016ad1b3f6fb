#!/usr/bin/env bash
# Public scenes of Mitsuba, pbrt and USD: how many are read, rendered, and equal to the picture of
# Mitsuba. Writes public.md. `public.sh [FOLDER]`: the folder of the scenes, by default
# ../shared/public-scenes. JOBS files at once (the cores), SIDE pixels wide (48), SPP samples (64),
# SEEDS of Mitsuba (4). Results stay in the folder KEEP (target/public) and are not made again.
. "$(dirname "$0")/driver.sh"
RTC=$(rtc)
export RTC
python=$(python_with mitsuba==3.9.1 numpy)
exec "$python" benches/public.py "${1:-../shared/public-scenes}" "${KEEP:-target/public}"
