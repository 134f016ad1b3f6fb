#!/usr/bin/env bash
# How near path-traced pictures come to the references of ../shared/gltf/refs, as a table in
# Markdown: the mean in its worst channel, relMSE, and the error of the means of blocks of 8 × 8
# pixels at the 95th percentile. 256 × 256 pixels. `references.sh [SAMPLES]` (256). Fails if a value
# is above its gate.
. "$(dirname "$0")/driver.sh"
refs=../shared/gltf/refs
samples=${1:-256}
needs "$refs"
compare=$(driver compare)

echo '| reference | mean off by | gate | relMSE | block p95 | gate |'
echo '| --- | --: | --: | --: | --: | --: |'
failed=0
while read -r name mean block; do
    line=$("$compare" "$refs/$name.json" "$samples")
    # `field NAME`: of the line of JSON.
    field() { grep -o "\"$1\":[-+.0-9e]*" <<<"$line" | cut -d : -f 2; }
    awk -v name="$name" -v mean="$mean" -v block="$block" -v off="$(field mean_off)" \
        -v square="$(field rel_mse)" -v p95="$(field block_p95)" 'BEGIN {
            form = "| %s | %.2f %% | %s %% | %.5f | %.1f %% | %s %% |\n"
            printf form, name, 100 * off, mean, square, 100 * p95, block
            exit 100 * off > mean || 100 * p95 > block
        }' || failed=1
done <<'END'
CornellLambert 0.3 2
MetalRoughGrid 2 6
FlightHelmet 3 10
GlassSphere 3 15
END
exit $failed
