#!/usr/bin/env bash
# Builds the page into dist/, which any server of files can serve: `hosts/web/build.sh`. Needs cargo and node.
set -euo pipefail
cd "$(dirname "$0")"
target=$(cargo metadata --locked --format-version 1 --no-deps | sed 's/.*"target_directory":"\([^"]*\)".*/\1/')

if command -v rustup >/dev/null; then
    rustup target add wasm32-unknown-unknown
fi
cargo build --locked --release --package rtc-web-bind
cargo build --locked --release --package rtc-web --lib --target wasm32-unknown-unknown
rm -rf dist
mkdir -p dist/scenes
"$target/release/rtc-web-bind" "$target/wasm32-unknown-unknown/release/rtc_web.wasm" dist
cp page/* ../../src/cli/preview/page/base.css dist/
node scenes.mjs
gzip -9 --keep dist/rtc_web_bg.wasm
printf 'dist: %d bytes of WebAssembly, %d compressed\n' "$(wc -c <dist/rtc_web_bg.wasm)" "$(wc -c <dist/rtc_web_bg.wasm.gz)"
