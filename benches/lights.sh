#!/usr/bin/env bash
# Emitters of many shapes and sizes beside Mitsuba: whether the mean is the same, and relMSE at equal samples, as Markdown. Needs a Python
# with `mitsuba` (3.9) and `numpy` in PYTHON. SIDE sets the pixels of a side (default 24), SAMPLES those of a pixel (16), REFERENCE those of
# each of the four converged pictures (1024); ONLY names families. RTC and PATHS, if set, are the programs.
set -euo pipefail
cd "$(dirname "$0")/.."
. benches/driver.sh
RTC=$(rtc) exec "${PYTHON:-python3}" benches/lights.py "${PATHS:-$(driver paths)}" target/lights
