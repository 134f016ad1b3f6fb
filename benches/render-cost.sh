#!/usr/bin/env bash
# What rendering the course's camera scene costs: 400 × 400 pixels, 16 rays a pixel, six spheres, two lights, shadows, two
# bounces. Prints rays, CPU seconds and instructions; only instructions are the same on a busy machine.
set -euo pipefail
cd "$(dirname "$0")/.."
. benches/driver.sh
rtc=$(rtc)
out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT

TIMEFORMAT='CPU seconds: %U'
time "$rtc" render --threads 1 scenes/camera.yaml -o "$out/camera.png"
if command -v valgrind >/dev/null; then
    valgrind --tool=callgrind --callgrind-out-file=/dev/null "$rtc" render -q --threads 1 \
        --size 100x100 scenes/camera.yaml -o "$out/small.png" 2>&1 | sed -n 's/.*Collected : /instructions at 100 × 100: /p'
fi
