#!/usr/bin/env bash
# How many mutants of the plan its tests kill, as Markdown. Without arguments all that `cargo mutants` lists; else so many drawn
# at random, by a seed, among those whose name matches a pattern: `benches/mutants.sh 150 1 window.rs`. Survivors want a test.
# All of them take some hours.
set -euo pipefail
cd "$(dirname "$0")/.."
command -v cargo-mutants >/dev/null || cargo install --locked --quiet cargo-mutants
exec python3 benches/mutants.py "${1:-1000000}" "${2:-1}" "${3:-.}"
