#!/usr/bin/env bash
# Fuzzes each target for its share of SECONDS (default 20), from the scenes, the frozen IR files and the corpora.
# The seed is fixed, so that the same commit meets the same inputs as far as its time goes.
# Exits non-zero at the first input that fails and leaves it in fuzz/artifacts. What is new is thrown away; to keep it,
# run a target with a folder of its own and merge the folder: cargo fuzz run -s none TARGET fuzz/corpus/TARGET FOLDER -- -merge=1
set -euo pipefail
cd "$(dirname "$0")/.."

seconds=${1:-20}
targets=(scene_parser check ir_decode validate render_tiny gltf glb mesh image folder part arguments fix lsp ies mtl ply stl written pbrt usd mitsuba)
# Of the clock, for one input. The tables of the materials, made once a process, take 4 s of CPU time in such a build.
patience=30

command -v cargo-fuzz >/dev/null || cargo install --locked --quiet cargo-fuzz
# It has no such flag itself.
cargo metadata --quiet --locked --format-version 1 --manifest-path fuzz/Cargo.toml >/dev/null
cargo fuzz build -s none

new=$(mktemp -d)
trap 'rm -rf "$new"' EXIT
for index in "${!targets[@]}"; do
    target=${targets[index]}
    # Whole seconds, and no more in all than there are; 0 would be for ever.
    share=$((seconds * (index + 1) / ${#targets[@]} - seconds * index / ${#targets[@]}))
    ((share > 0)) || continue
    mkdir "$new/$target"
    echo "fuzz $target for $share s"
    cargo fuzz run -s none "$target" "$new/$target" "fuzz/corpus/$target" fuzz/seeds scenes tests/codec/v{0,1,2,3} -- \
        -seed=1 -max_total_time="$share" -timeout=$patience -rss_limit_mb=2048 -max_len=20000 -dict=fuzz/yaml.dict -verbosity=0 \
        >"$new/log" 2>&1 || { tail -n 40 "$new/log"; exit 1; }
done
