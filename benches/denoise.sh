#!/usr/bin/env bash
# Denoised pictures of 16 paths per pixel beside plain ones, as a table in Markdown: the printed
# error beside the true one, how often the bound holds, and how often a picture is worse than the
# plain one. SIDE sets the pixels (256), PATHS the paths per pixel of each of two references (192),
# SEEDS the pictures (1). `denoise.sh unseen` takes scenes that the filter was not made with, from
# tests/, scenes/ and ../shared. OIDN names a Python with pyoidn, which filters the same pictures.
. "$(dirname "$0")/driver.sh"
assets=../shared/gltf/assets
lights=../shared/round-3/lights
if [ "${1:-}" = unseen ]; then
    files=(tests/render/layer/*.gltf tests/render/alpha/*.gltf
        tests/render/light/{directional,emissive-triangles,leaf,spot}.gltf
        tests/render/texture/normal-scale.gltf tests/render/asset/interpenetrating.gltf
        scenes/{glass,mirrors,shapes,glossy,five-spheres,soft-light,bokeh}.yaml
        tests/render/light/bounce-denoised.yaml tests/render/csg/path.yaml
        "$assets"/{CornellBox,AttenuationTest,AlphaBlendModeTest,NormalTangentTest,pirate}.glb
        "$lights"/{denoise-worse,quad-light,target-error-erratic}.yaml)
else
    files=("$assets/FlightHelmet/FlightHelmet.gltf"
        "$assets"/{own_MetalRoughGrid,TransmissionRoughnessTest,own_CornellLambert}.glb
        "$assets"/{own_GlassSphere,ClearCoatTest,SheenCloth}.glb scenes/vases.yaml)
fi
present=()
for file in "${files[@]}"; do
    [ -f "$file" ] && present+=("$file")
done
denoise=$(driver denoise)
exec "$denoise" "${SIDE:-256}" "${PATHS:-192}" "${SEEDS:-1}" "${present[@]}"
