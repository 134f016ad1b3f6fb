#!/usr/bin/env bash
# Denoised pictures of 16 paths a pixel beside plain ones, the error told of them beside the true one, and how often the bound holds, as
# Markdown (benches/denoise.md). SIDE (96 pixels), PATHS (1024 a pixel of each of two references) and SEEDS (5) set how much is measured.
# Reads ../shared/gltf. DENOISE is a driver that was built before.
set -euo pipefail
cd "$(dirname "$0")/.."
. benches/driver.sh
[ -d ../shared/gltf ] || { echo 'no ../shared/gltf here' >&2; exit 0; }
exec "${DENOISE:-$(driver denoise)}" ../shared/gltf/assets "${SIDE:-96}" "${PATHS:-1024}" "${SEEDS:-5}"
