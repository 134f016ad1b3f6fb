#!/usr/bin/env bash
# Whether `--time-budget` is kept: ten scenes, three times each, from the start of the process to its end. Prints a table in Markdown, and
# exits with 1 if a picture is late without a warning. Wants an idle machine; assets of ../shared are left out where it is absent.
set -euo pipefail
cd "$(dirname "$0")/.."
. benches/driver.sh
python3 benches/budget.py "$(rtc)" "${RTC_SHARED:-../shared}"
