#!/usr/bin/env bash
# What rays with a NaN or an infinite component cost: their instructions through a thousand spheres,
# divided by those of normal rays. The limit is 2.5. Needs valgrind.
. "$(dirname "$0")/driver.sh"
driver=$(driver broken_rays)

traced() {
    instructions '*broken_rays*trace*' "$driver" "$1"
}

sound=$(traced sound)
echo "sound: $sound instructions, $("$driver" sound)"
for kind in nan infinite; do
    awk -v kind="$kind" -v broken="$(traced "$kind")" -v sound="$sound" 'BEGIN {
        printf "%s: %d instructions, %.2f of sound\n", kind, broken, broken / sound
        exit broken / sound > 2.5
    }'
    "$driver" "$kind" | grep '^0 of'
done
