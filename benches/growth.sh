#!/usr/bin/env bash
# How time and memory grow with the scene: one mesh of 10^3 to 10^7 triangles (MOST sets another end), 256 × 256 pixels, 4 paths
# each, one thread: CPU-seconds from the start of the process to the picture and its peak of memory; and the time a ray takes,
# by the difference from 36 paths to 4. Puts the table into benches/README.md and draws benches/growth.svg.
set -euo pipefail
cd "$(dirname "$0")/.."
. benches/driver.sh
rtc=$(rtc) asset=$(driver big_asset)
out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT

# CPU-seconds, MB, and rays of a render with so many paths a pixel.
cost() {
    /usr/bin/time -o "$out/cost" -f '%U %S %M' "$rtc" render "$out/big.glb" --size 256x256 --spp "$1" --threads 1 --env-color 0.6 \
        --color never -o "$out/big.png" 2>"$out/words"
    rays=$(sed -n 's/.*, \([0-9,]*\) rays,.*/\1/p' "$out/words" | tr -d ,)
    awk -v rays="$rays" '{ print $1 + $2, $3 / 1024, rays }' "$out/cost"
}

for exponent in $(seq 3 "${MOST:-7}"); do
    "$asset" write "$out/big.glb" "1e$exponent"
    echo "$exponent $(cost 4) $(cost 36)"
done | python3 benches/growth.py benches/growth.svg | python3 benches/page.py growth
