#!/usr/bin/env bash
# Denoised pictures of 16 paths a pixel beside plain ones, the error told of them beside the true one, how often the bound holds and how often
# a picture is worse than the plain one, as Markdown (benches/denoise.md). SIDE (256 pixels), PATHS (192 a pixel of each of two references) and
# SEEDS (1) set how much is measured; `unseen` as an argument takes scenes that the filter was not made with, from tests/, scenes/ and
# ../shared, and only what is here. DENOISE is a driver that was built before; OIDN is a Python that has pyoidn, which filters the same plain pictures.
set -euo pipefail
cd "$(dirname "$0")/.."
. benches/driver.sh
assets=../shared/gltf/assets
lights=../shared/round-3/lights
if [ "${1:-}" = unseen ]; then
    files=(tests/render/layer/*.gltf tests/render/alpha/*.gltf tests/render/light/{directional,emissive-triangles,leaf,spot}.gltf
        tests/render/texture/normal-scale.gltf tests/render/asset/interpenetrating.gltf
        scenes/{glass,mirrors,shapes,glossy,five-spheres,soft-light,bokeh}.yaml tests/render/light/bounce-denoised.yaml
        tests/render/csg/path.yaml $assets/{CornellBox,AttenuationTest,AlphaBlendModeTest,NormalTangentTest,pirate}.glb
        $lights/{denoise-worse,quad-light,target-error-erratic}.yaml)
else
    files=($assets/FlightHelmet/FlightHelmet.gltf $assets/{own_MetalRoughGrid,TransmissionRoughnessTest,own_CornellLambert}.glb
        $assets/{own_GlassSphere,ClearCoatTest,SheenCloth}.glb scenes/vases.yaml)
fi
present=()
for file in "${files[@]}"; do
    [ -f "$file" ] && present+=("$file")
done
exec "${DENOISE:-$(driver denoise)}" "${SIDE:-256}" "${PATHS:-192}" "${SEEDS:-1}" "${present[@]}"
