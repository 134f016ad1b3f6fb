#!/usr/bin/env bash
# What a keystroke costs `rtc lsp`: CPU-milliseconds from a change to its findings, and of the
# requests of an editor after it, in scenes of 100 and of 5 000 objects. The goal is 20 ms for the
# findings of 5 000 objects.
. "$(dirname "$0")/driver.sh"
rtc=$(rtc)
exec python3 benches/editor.py "$rtc"
