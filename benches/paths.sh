#!/usr/bin/env bash
# How fast paths are traced, as Markdown, beside Cycles: 512 × 512 pixels, 8 bounces, and as many samples as the argument says,
# 64 without. The set-ups are those of the references in `../shared/gltf/refs`, where there is one. `benches/paths.sh
# >benches/paths.md` makes the table that is kept.
set -euo pipefail
cd "$(dirname "$0")/.."
shared=../shared/gltf samples=${1:-64}
[ -d "$shared" ] || { echo "no $shared here" >&2; exit 0; }
cargo build --release --quiet --example paths
# Cycles: samples per CPU-second in millions, peak of memory in MB.
row() { ./target/release/examples/paths "$1" "$2" | sed "s/\$/ $3 | $4 |/"; }
cat <<END
# Paths

\`benches/paths.sh\`, one thread of a busy two-core AMD EPYC (Zen 3); 512 × 512 pixels, 8 bounces. Samples are of the camera, in
millions per CPU-second of rendering, the hierarchy included. The error is the mean of the noise's square over that of the
picture, from two pictures of independent numbers. CPU-seconds and MB are those of the whole process until the picture is there.
Cycles is bpy 4.5.15 on a like machine, with views and lights of its own.

| scene | triangles | samples a pixel | M samples per CPU-s | relative error | CPU-s from the start | peak, MB | Cycles, M per CPU-s | Cycles, MB |
| --- | --: | --: | --: | --: | --: | --: | --: | --: |
END
row $shared/refs/FlightHelmet.json "$samples" 0.86 357
row $shared/refs/MetalRoughGrid.json "$samples" 0.66 317
row $shared/assets/TransmissionRoughnessTest.glb "$samples" 0.43 324
row $shared/refs/CornellLambert.json "$samples" 0.23 286
[ "$samples" = 16 ] || row $shared/refs/FlightHelmet.json 16 0.86 357
