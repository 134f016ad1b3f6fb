#!/usr/bin/env bash
# Ten scenes in 1, 2, 7 and 64 parts, by tiles and by samples, merged in any order. Prints a table with the CPU-seconds of all parts, and
# exits with 1 if a picture has other bytes than that of one process.
set -euo pipefail
cd "$(dirname "$0")/.."
. benches/driver.sh
python3 benches/parts.py "$(rtc)" scenes
