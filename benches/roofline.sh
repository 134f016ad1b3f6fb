#!/usr/bin/env bash
# How far the rays of benches/peers are from what this machine could do: its bandwidth and latency by size, instructions and
# cache misses a ray as valgrind simulates the caches of two and of three levels, and what follows. Puts both tables into
# benches/README.md. Needs valgrind, the files of benches/peers/run.sh, and some minutes.
set -euo pipefail
cd "$(dirname "$0")/.."
. benches/driver.sh
folder=target/peers
[ -e "$folder/globe.glb" ] || { echo "run benches/peers/run.sh before" >&2; exit 1; }
rays=$(driver rays) memory=$(driver memory)
out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT
sets=("$folder/coherent.f32" "$folder/incoherent.f32")
cache() { echo "$(getconf "LEVEL$1_SIZE"),$(getconf "LEVEL$1_ASSOC"),$(getconf "LEVEL$1_LINESIZE")"; }
# The last level is taken to be what a core complex of this family has; machines that are shared tell other sizes.
levels=("$(cache 2_CACHE)" "$((32 << 20)),16,64")

"$memory" >"$out/memory"
"$rays" "$folder/globe.glb" "${sets[@]}" >"$out/rays"
# The work of 2^16 rays of each set; all other instructions don't count. One profile for each call of a batch.
only=('--toggle-collect=rays::*_hits' '--dump-after=rays::closest_hits' '--dump-after=rays::any_hits')
for k in 0 1; do
    mkdir "$out/$k"
    valgrind --tool=callgrind --cache-sim=yes --D1="$(cache 1_DCACHE)" --LL="${levels[k]}" "${only[@]}" \
        --callgrind-out-file="$out/$k/profile" \
        "$rays" "$folder/globe.glb" "${sets[@]}" 65536 >/dev/null 2>"$out/$k/words" &
done
wait
python3 benches/roofline.py "$out" | python3 benches/page.py roofline
