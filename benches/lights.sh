#!/usr/bin/env bash
# Emitters of many shapes and sizes by `rtc` and by Mitsuba, as a table in Markdown: whether the
# means are equal, and relMSE at equal samples. SIDE sets the pixels of a side (24), SAMPLES those
# of a pixel (16), REFERENCE those of each of the four converged pictures (1024). ONLY names
# families.
. "$(dirname "$0")/driver.sh"
RTC=$(rtc)
export RTC
paths=$(driver paths)
python=$(python_with mitsuba==3.9.1 numpy)
exec "$python" benches/lights.py "$paths" target/lights
