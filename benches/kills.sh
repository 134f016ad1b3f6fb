#!/usr/bin/env bash
# Kills renders at random moments and goes on: 30 SIGKILLs over 6 scenes. Prints a table, and exits with 1 if a picture has other bytes
# than that of a render that nobody killed. SEED sets other moments.
set -euo pipefail
cd "$(dirname "$0")/.."
. benches/driver.sh
python3 benches/kills.py "$(rtc)" scenes "${SEED:-1}"
