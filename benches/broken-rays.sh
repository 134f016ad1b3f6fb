#!/usr/bin/env bash
# What rays that are none cost: instructions of rays with a NaN or an infinite component over those of sound rays, through
# a thousand spheres. Limit: 2.5. Needs valgrind; builds the driver `broken_rays`.
set -euo pipefail
cd "$(dirname "$0")/.."
. benches/driver.sh
driver=$(driver broken_rays)

instructions() {
    valgrind --tool=callgrind --callgrind-out-file=/dev/null --toggle-collect='*broken_rays*trace*' \
        "$driver" "$1" 2>&1 >/dev/null | sed -n 's/.*Collected : //p'
}

sound=$(instructions sound)
echo "sound: $sound instructions, $("$driver" sound)"
for kind in nan infinite; do
    broken=$(instructions "$kind")
    awk -v kind="$kind" -v broken="$broken" -v sound="$sound" \
        'BEGIN { ratio = broken / sound; printf "%s: %d instructions, %.2f of sound\n", kind, broken, ratio; exit ratio > 2.5 }'
    "$driver" "$kind" | grep '^0 of'
done
