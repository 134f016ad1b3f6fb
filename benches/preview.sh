#!/usr/bin/env bash
# How soon `rtc preview` shows a picture after a save of scenes/camera.yaml (400 × 400), what it takes when nothing changes, and
# whether ten thousand connections end it. Prints three lines. Wants an idle machine, and 10 000 files that may be open.
set -euo pipefail
cd "$(dirname "$0")/.."
. benches/driver.sh
ulimit -n 12000 2>/dev/null || true
exec python3 benches/preview.py "$(rtc)"
