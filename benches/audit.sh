#!/usr/bin/env bash
# Audits 1 000 tampered pictures, counts how often a draw misses as many damaged tiles as the bound rules out, and audits 250 sound
# pictures and parts on other threads and instructions than those on which they were made. Exits with 1 if a promise was broken.
# AUDIT is a driver that was built before.
set -euo pipefail
cd "$(dirname "$0")/.."
. benches/driver.sh
exec "${AUDIT:-$(driver audit)}"
