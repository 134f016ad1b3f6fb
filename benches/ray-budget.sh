#!/usr/bin/env bash
# Where the time of five pictures goes, in nanoseconds a camera ray, by `perf`, and what a camera ray asks of the machine, by valgrind:
# `[RTC_SIMD=avx2] benches/ray-budget.sh [counts]`, with `counts` the latter alone. After `peers/run.sh`, which makes most of the
# scenes; the room is of ../shared. Puts the tables into benches/README.md.
set -euo pipefail
cd "$(dirname "$0")/.."
. benches/driver.sh
export RTC
RTC=$(rtc)
[ "${1:-}" = counts ] || python3 benches/ray_budget.py | python3 benches/page.py ray-budget
python3 benches/ray_counts.py | python3 benches/page.py ray-counts
