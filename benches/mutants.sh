#!/usr/bin/env bash
# How many mutants of the plan its tests detect, as a page in Markdown. By default all that
# `cargo mutants` lists, which takes some hours. `mutants.sh 150 1 window.rs`: 150 mutants, drawn at
# random by seed 1 among those whose names match a pattern. A mutant that survives needs a test.
. "$(dirname "$0")/driver.sh"
command -v cargo-mutants >/dev/null || cargo install --locked --quiet cargo-mutants
exec python3 benches/mutants.py "${1:-1000000}" "${2:-1}" "${3:-.}"
