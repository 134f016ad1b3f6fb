#!/usr/bin/env bash
# What a keystroke costs `rtc lsp`: milliseconds of CPU from a change until its findings are there, and of what an editor asks
# after it, in scenes of 100 and of 5 000 objects. Prints one line for each. Goal: 20 ms for findings at 5 000 objects.
set -euo pipefail
cd "$(dirname "$0")/.."
. benches/driver.sh
exec python3 benches/editor.py "$(rtc)"
