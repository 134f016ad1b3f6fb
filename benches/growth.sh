#!/usr/bin/env bash
# How time and memory grow with the scene and with the picture. Writes the tables of growth.md and
# draws growth.svg.
# - One mesh of 10^3 to 10^7 triangles (MOST sets the last exponent), 256 × 256 pixels, 4 paths per
#   pixel, one thread: CPU-seconds from the start of the process to the picture, and the peak of
#   memory. The time of a ray comes from the difference between 36 paths and 4.
# - The camera scene of the course from 256² to 16 384² pixels (WIDEST sets the last side), one
#   sample per pixel, as a whole and by `--strips`.
. "$(dirname "$0")/driver.sh"
rtc=$(rtc)
asset=$(driver big_asset)
out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT

# `cost PATHS`: CPU-seconds, MB and rays of a render.
cost() {
    /usr/bin/time -o "$out/cost" -f '%U %S %M' "$rtc" render "$out/big.glb" --size 256x256 \
        --spp "$1" --threads 1 --env-color 0.6 --color never -o "$out/big.png" 2>"$out/words"
    rays=$(sed -n 's/.*, \([0-9,]*\) rays,.*/\1/p' "$out/words" | tr -d ,)
    awk -v rays="$rays" '{ print $1 + $2, $3 / 1024, rays }' "$out/cost"
}

for exponent in $(seq 3 "${MOST:-7}"); do
    "$asset" write "$out/big.glb" "1e$exponent"
    echo "$exponent $(cost 4) $(cost 36)"
done >"$out/rows"

# `size SIDE [OPTION]`: CPU-seconds and MB of a square picture.
size() {
    /usr/bin/time -o "$out/cost" -f '%U %S %M' "$rtc" render scenes/camera.yaml \
        --size "$1x$1" --supersampling 1 --threads 1 -q "${@:2}" -o "$out/wide.png"
    awk '{ print $1 + $2, $3 / 1024 }' "$out/cost"
}

for ((side = 256; side <= ${WIDEST:-16384}; side *= 4)); do
    # 16 384² pixels as a whole take 10 GB.
    echo "$side $(size "$side" --strips) $([ "$side" -gt 4096 ] || size "$side")"
done >"$out/sizes"
python3 benches/growth.py benches/growth.svg "$out/rows" "$out/sizes" |
    python3 benches/page.py growth growth
