#!/usr/bin/env bash
# What scenes become for Mitsuba and POV-Ray: a row a scene with the mean of its picture against ours, and why they differ.
# `export.sh [SCENE]...`: the assets of ../shared/gltf/assets and scenes/ without. Needs Mitsuba's wheel (`pip install mitsuba`) in
# the Python of PYTHON, and `povray`. Fails where a mean is more than 2 % off and no warning says why.
set -euo pipefail
cd "$(dirname "$0")/.."
. benches/driver.sh
RTC=$(rtc)
export RTC
scenes=("$@")
if [ "${#scenes[@]}" = 0 ]; then
    mapfile -t scenes < <(find ../shared/gltf/assets scenes -name '*.gl*' -o -name "*.yaml" | sort)
fi
exec "${PYTHON:-python3}" benches/export.py "${scenes[@]}"
