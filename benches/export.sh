#!/usr/bin/env bash
# Scenes exported to Mitsuba and POV-Ray, as rows in Markdown: the mean of the picture of the other
# renderer against that of `rtc`, and the warnings of the export. `export.sh [SCENE]...`; by default
# the assets of ../shared/gltf/assets and scenes/. Without `povray` only Mitsuba is compared. Fails
# if a mean is more than 2 % off and no warning says why.
. "$(dirname "$0")/driver.sh"
RTC=$(rtc)
export RTC
scenes=("$@")
if [ "${#scenes[@]}" = 0 ]; then
    mapfile -t scenes < <(find ../shared/gltf/assets scenes -name '*.gl*' -o -name '*.yaml' | sort)
fi
python=$(python_with mitsuba==3.9.1 numpy)
exec "$python" benches/export.py "${scenes[@]}"
