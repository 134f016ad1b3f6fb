#!/usr/bin/env bash
# How soon `rtc preview` shows a picture after a save of scenes/camera.yaml (400 × 400 pixels), its
# CPU time while nothing changes, and whether it survives ten thousand connections. Wants an idle
# machine and a limit of 10 000 open files.
. "$(dirname "$0")/driver.sh"
ulimit -n 12000 2>/dev/null || true
rtc=$(rtc)
exec python3 benches/preview.py "$rtc"
