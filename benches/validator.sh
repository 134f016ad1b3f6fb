#!/usr/bin/env bash
# How often `rtc` and the validator of Khronos find the same set of error codes in a glTF asset, as
# a page in Markdown: in the assets and the corpus of ../shared/gltf, in 2 000 mutants of them, and
# in 1 000 files with changed bytes in accessors and images. `validator.sh [MUTANTS [SEED]]`. Needs
# node and npm, which fetches the validator into target/validator. LIST=1 names on stderr each file
# that differs. `benches/validator.sh >benches/validator.md` writes the page.
. "$(dirname "$0")/driver.sh"
needs ../shared/gltf
rtc=$(rtc)
work=target/validator
mkdir -p "$work"
if [ ! -d "$work/node_modules/gltf-validator" ]; then
    npm install --silent --no-save --prefix "$work" gltf-validator@2.0.0-dev.3.10 >&2
fi
exec node benches/validator.mjs "$work" "$rtc" ../shared/gltf "${1:-2000}" "${2:-1}"
