#!/usr/bin/env bash
# Whether other machines make the same pictures: the library is built for arm64, which qemu
# simulates, and for wasm32, which node runs by WASI, and the hashes of its pictures are compared
# with tests/hashes.txt. `hashes.sh [arm64] [wasm32]`; by default both. Needs the targets of rustup,
# qemu-aarch64-static, and node. Builds are not optimised, as nothing is timed.
. "$(dirname "$0")/driver.sh"

arm64() {
    local program
    program=$(driver_for aarch64-unknown-linux-musl hashes 0)
    qemu-aarch64-static "$program"
}

# Without optimisation its stack is too small.
wasm32() {
    local program
    program=$(driver_for wasm32-wasip1 hashes 1)
    node --no-warnings benches/wasi.mjs "$program" "$PWD"
}

[ $# != 0 ] || set -- arm64 wasm32
for machine in "$@"; do
    "$machine" >"target/hashes-$machine.txt"
    diff "target/hashes-$machine.txt" tests/hashes.txt
    printf '%s: the %d hashes are those of tests/hashes.txt\n' "$machine" \
        "$(wc -l <tests/hashes.txt)"
done
