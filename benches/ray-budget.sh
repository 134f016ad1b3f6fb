#!/usr/bin/env bash
# Where the time of five pictures goes, in nanoseconds per camera ray, by `perf`; and the
# instructions and cache misses of a camera ray, by valgrind. Writes the tables of ray-budget.md.
# `[RTC_SIMD=avx2] ray-budget.sh [counts]`: with `counts` only the latter. Run peers/run.sh before,
# which makes most of the scenes; the room is one of ../shared.
. "$(dirname "$0")/driver.sh"
RTC=$(rtc)
export RTC
if [ "${1:-}" != counts ]; then
    python3 benches/ray_budget.py | python3 benches/page.py ray-budget ray-budget
fi
python3 benches/ray_counts.py | python3 benches/page.py ray-budget ray-counts
