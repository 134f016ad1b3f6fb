#!/usr/bin/env bash
# Renders with checkpoints that are killed at random moments and resumed: 30 times SIGKILL in 6
# scenes, as a table in Markdown. Fails if a picture differs by a byte from that of a render that
# was not killed. SEED sets other moments.
. "$(dirname "$0")/driver.sh"
rtc=$(rtc)
exec python3 benches/kills.py "$rtc" scenes "${SEED:-1}"
