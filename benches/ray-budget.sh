#!/usr/bin/env bash
# Where the time of five pictures goes, in nanoseconds a camera ray, by `perf`: `[RTC_SIMD=avx2] benches/ray-budget.sh`. After
# `peers/run.sh`, which makes two of the scenes; the room is of ../shared. Puts the table into benches/README.md.
set -euo pipefail
cd "$(dirname "$0")/.."
. benches/driver.sh
RTC=$(rtc) python3 benches/ray_budget.py | python3 benches/page.py ray-budget
