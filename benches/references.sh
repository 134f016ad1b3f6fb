#!/usr/bin/env bash
# How near traced paths come to the references of `../shared/gltf/refs`, as Markdown: the mean in its worst channel, the
# relative mean square error (over r² + 0.01), and the error of the means of blocks of 8 × 8 pixels at the 95th percentile.
# 256 × 256 pixels, as many samples as the argument says, 256 without; fails where a gate is missed.
set -euo pipefail
cd "$(dirname "$0")/.."
. benches/driver.sh
refs=../shared/gltf/refs samples=${1:-256} failed=0
[ -d "$refs" ] || { echo "no $refs here" >&2; exit 0; }
compare=$(driver compare)

echo '| reference | mean off by | gate | relMSE | block p95 | gate |'
echo '| --- | --: | --: | --: | --: | --: |'
while read -r name mean block; do
    line=$("$compare" "$refs/$name.json" "$samples")
    field() { sed "s/.*\"$1\":\([-+.0-9e]*\).*/\1/" <<<"$line"; }
    read -r off square p95 < <(awk -v off="$(field mean_off)" -v square="$(field rel_mse)" -v p95="$(field block_p95)" \
        'BEGIN { print 100 * off, square, 100 * p95 }')
    printf '| %s | %.2f %% | %s %% | %.5f | %.1f %% | %s %% |\n' "$name" "$off" "$mean" "$square" "$p95" "$block"
    awk -v off="$off" -v mean="$mean" -v p95="$p95" -v block="$block" 'BEGIN { exit off > mean || p95 > block }' || failed=1
done <<'END'
CornellLambert 0.3 2
MetalRoughGrid 2 6
FlightHelmet 3 10
GlassSphere 3 15
END
exit $failed
