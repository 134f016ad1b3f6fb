#!/usr/bin/env bash
# Renders strip.png, the row of pictures of the README.
set -euo pipefail
cd "$(dirname "$0")"
made=$(mktemp -d)
trap 'rm -r "$made"' EXIT
scenes=(shapes globe mirrors soft-light bokeh vases)
cargo run --release --quiet -- render -q "${scenes[@]/%/.yaml}" -o "$made/" --contact-sheet strip.png
