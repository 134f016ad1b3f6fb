#!/usr/bin/env bash
# Builds the page into dist/, which any server of files can serve, and the npm package `rtc-scene` into dist/package, which the
# page uses: `hosts/web/build.sh`. Needs cargo and node.
set -euo pipefail
cd "$(dirname "$0")"
target=$(cargo metadata --locked --format-version 1 --no-deps | sed 's/.*"target_directory":"\([^"]*\)".*/\1/')

if command -v rustup >/dev/null; then
    rustup target add wasm32-unknown-unknown
fi
cargo build --locked --release --package rtc-web-bind
cargo build --locked --release --package rtc-web --lib --target wasm32-unknown-unknown
rm -rf dist
mkdir -p dist/scenes dist/package
"$target/release/rtc-web-bind" "$target/wasm32-unknown-unknown/release/rtc_web.wasm" dist/package
cp package/* ../../LICENSE-* dist/package/
cp page/* ../../src/cli/preview/page/base.css dist/
node scenes.mjs
wasm=dist/package/rtc_web_bg.wasm
printf '%s: %d bytes, %d compressed\n' "$wasm" "$(wc -c <$wasm)" "$(gzip -9 <$wasm | wc -c)"
