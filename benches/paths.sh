#!/usr/bin/env bash
# How fast paths are traced, as Markdown, beside Cycles: 512 × 512 pixels, 8 bounces, and as many samples as the argument says,
# 64 without. The set-ups are those of the references in `../shared/gltf/refs`, where there is one. `benches/paths.sh
# >benches/paths.md` makes the table that is kept.
set -euo pipefail
cd "$(dirname "$0")/.."
. benches/driver.sh
shared=../shared/gltf samples=${1:-64} seconds=2
[ -d "$shared" ] || { echo "no $shared here" >&2; exit 0; }
paths=$(driver paths)
# Cycles: samples per CPU-second in millions, peak of memory in MB.
row() { "$paths" "$1" "$2" ${5:-} | sed "s/\$/ $3 | $4 |/"; }
cat <<END
# Paths

\`benches/paths.sh\`, one thread of a two-core AMD EPYC (Zen 3); 512 × 512 pixels, 8 bounces. Samples are of the camera, in
millions per CPU-second of rendering, the hierarchy included. CPU-seconds and MB are those of the whole process until the picture
is there. The error, mean of (a − b)²/(b² + 0.01), is that of a picture of 256 × 256 pixels after $seconds CPU-seconds against one of 16
times its samples. Cycles is bpy 4.5.15 on a like machine, with views and lights of its own.

| scene | triangles | samples a pixel | M samples per CPU-s | CPU-s from the start | peak, MB | relMSE after $seconds CPU-s | Cycles, M per CPU-s | Cycles, MB |
| --- | --: | --: | --: | --: | --: | --: | --: | --: |
END
row $shared/refs/FlightHelmet.json "$samples" 0.86 357 $seconds
row $shared/refs/MetalRoughGrid.json "$samples" 0.66 317 $seconds
row $shared/assets/TransmissionRoughnessTest.glb "$samples" 0.43 324 $seconds
row $shared/refs/CornellLambert.json "$samples" 0.23 286 $seconds
[ "$samples" = 16 ] || row $shared/refs/FlightHelmet.json 16 0.86 357
