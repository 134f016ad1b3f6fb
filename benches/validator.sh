#!/usr/bin/env bash
# How often rtc and the validator of Khronos find the same set of error codes in a glTF asset, as Markdown: in the assets and
# the corpus of ../shared/gltf, in 2000 mutants of them, made by a seed, and in 1000 with other bytes in accessors and images: `benches/validator.sh [COUNT [SEED]]`. It needs
# node and npm, which fetches the validator into target/validator. `benches/validator.sh >benches/validator.md` makes the
# page that is kept; LIST=1 names each file that differs on stderr.
set -euo pipefail
cd "$(dirname "$0")/.."
. benches/driver.sh
rtc=$(rtc)
[ -d ../shared/gltf ] || { echo "no folder ../shared/gltf: nothing to compare" >&2 && exit 0; }
work=target/validator
mkdir -p "$work"
[ -d "$work/node_modules/gltf-validator" ] || npm install --silent --no-save --prefix "$work" gltf-validator@2.0.0-dev.3.10 >&2
exec node benches/validator.mjs "$work" "$rtc" ../shared/gltf "${1:-2000}" "${2:-1}"
