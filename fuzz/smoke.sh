#!/usr/bin/env bash
# Fuzzes each target for its share of SECONDS (default 20), from the scenes, the frozen IR files and the corpora.
# Exits non-zero at the first input that fails; it is kept in fuzz/artifacts. New inputs are not kept, unless KEEP=1.
set -euo pipefail
cd "$(dirname "$0")/.."

seconds=${1:-20}
targets=(scene_parser check ir_decode validate render_tiny)
share=$(((seconds + ${#targets[@]} - 1) / ${#targets[@]}))

command -v cargo-fuzz >/dev/null || cargo install --quiet cargo-fuzz
cargo fuzz build -s none

for target in "${targets[@]}"; do
    found=$(mktemp -d)
    corpus=fuzz/corpus/$target
    mkdir -p "$corpus"
    cargo fuzz run -s none "$target" "$found" "$corpus" scenes tests/codec/v0 tests/codec/v1 -- \
        -max_total_time="$share" -timeout=5 -rss_limit_mb=2048 -max_len=20000 -dict=fuzz/yaml.dict -print_final_stats=0 \
        2>&1 | tail -n 40
    if [ "${KEEP:-0}" = 1 ]; then
        cargo fuzz run -s none "$target" "$corpus" "$found" -- -merge=1 -max_len=4096 2>&1 | tail -n 3
    fi
    rm -rf "$found"
done
