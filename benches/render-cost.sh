#!/usr/bin/env bash
# What rendering the camera scene of the course costs: 400 × 400 pixels, 16 rays per pixel, six
# spheres, two lights, shadows, two bounces. Prints rays, CPU-seconds and instructions. Only rays
# and instructions are the same on a busy machine.
. "$(dirname "$0")/driver.sh"
rtc=$(rtc)
out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT

TIMEFORMAT='CPU seconds: %U'
time "$rtc" render --threads 1 scenes/camera.yaml -o "$out/camera.png"
if command -v valgrind >/dev/null; then
    render=("$rtc" render -q --threads 1 --size 100x100 scenes/camera.yaml -o "$out/small.png")
    echo "instructions at 100 × 100: $(instructions '' "${render[@]}")"
fi
