#!/usr/bin/env bash
# Whether `--time-budget` is kept: ten scenes, three budgets each, from the start of the process to
# its end, as a table in Markdown. Fails if a picture is late without a warning. Wants an idle
# machine. Assets of ../shared are left out if they are not there; RTC_SHARED names another folder.
. "$(dirname "$0")/driver.sh"
rtc=$(rtc)
exec python3 benches/budget.py "$rtc" "${RTC_SHARED:-../shared}"
