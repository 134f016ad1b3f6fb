#!/usr/bin/env bash
# What rays that are none cost: instructions of rays with a NaN or an infinite component over those of sound rays, through
# a thousand spheres. Limit: 2.5. Needs valgrind; builds the example `broken_rays` in release mode.
set -euo pipefail
cd "$(dirname "$0")/.."
cargo build --quiet --release --example broken_rays

instructions() {
    valgrind --tool=callgrind --callgrind-out-file=/dev/null --toggle-collect='*broken_rays*trace*' \
        target/release/examples/broken_rays "$1" 2>&1 >/dev/null | sed -n 's/.*Collected : //p'
}

sound=$(instructions sound)
echo "sound: $sound instructions, $(target/release/examples/broken_rays sound)"
for kind in nan infinite; do
    broken=$(instructions "$kind")
    awk -v kind="$kind" -v broken="$broken" -v sound="$sound" \
        'BEGIN { ratio = broken / sound; printf "%s: %d instructions, %.2f of sound\n", kind, broken, ratio; exit ratio > 2.5 }'
    target/release/examples/broken_rays "$kind" | grep '^0 of'
done
