#!/usr/bin/env bash
# Whether other machines make the same pictures: the library is built for arm64, which qemu simulates, and for wasm32, which
# node runs by its WASI, and its pictures are held against tests/hashes.txt. `benches/hashes.sh [arm64] [wasm32]`, both without
# a word. Needs the targets of rustup, qemu-aarch64-static, node. Debug builds, as nothing is timed.
set -euo pipefail
cd "$(dirname "$0")/.."

# `program TARGET OPTIMISATION`: the driver `hashes` for a target.
program() {
    cargo bench --locked --no-run --quiet --profile dev --no-default-features --bench hashes --target "$1" \
        --config "profile.dev.opt-level=$2" --message-format json-render-diagnostics |
        sed -n 's/.*"kind":\["bench"\].*"executable":"\([^"]*\)".*/\1/p'
}

arm64() {
    local program
    program=$(CARGO_TARGET_AARCH64_UNKNOWN_LINUX_MUSL_LINKER=rust-lld program aarch64-unknown-linux-musl 0)
    qemu-aarch64-static "$program"
}

# Not optimised, its stack would be too small.
wasm32() {
    local program
    program=$(program wasm32-wasip1 1)
    node --no-warnings benches/wasi.mjs "$program" "$PWD"
}

for machine in ${*:-arm64 wasm32}; do
    "$machine" >"target/hashes-$machine.txt"
    diff "target/hashes-$machine.txt" tests/hashes.txt
    printf '%s: the %d hashes are those of tests/hashes.txt\n' "$machine" "$(wc -l <tests/hashes.txt)"
done
