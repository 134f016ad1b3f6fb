#!/usr/bin/env bash
# `dist/profile.sh TARGET`: how often each branch of the program for TARGET is taken in the pictures of scenes/, small and
# by all vector instructions there are here: the compiler lays the code out by it (profile-guided optimization). Prints the file,
# which is made once for the sources at hand. Needs rustup, and a machine that runs TARGET.
set -euo pipefail
cd "$(dirname "$0")/.."
target=$1
out=$PWD/target/profile/$target
state=$(git rev-parse HEAD)$(git diff HEAD -- src Cargo.toml Cargo.lock | sha256sum | cut -c1-16)
if [[ $(cat "$out/state" 2>/dev/null) != "$state" ]]; then
    rm -rf "$out"
    mkdir -p "$out/counts"
    rustup component add llvm-tools >/dev/null 2>&1
    flags=CARGO_TARGET_$(tr a-z- A-Z_ <<<"$target")_RUSTFLAGS
    env "$flags=${!flags:-} -Cprofile-generate=$out/counts" CARGO_TARGET_DIR=target/profile \
        cargo build --quiet --locked --profile dist --bin rtc --target "$target"
    program=target/profile/$target/dist/rtc
    export LLVM_PROFILE_FILE=$out/counts/%m_%p.profraw
    for level in scalar sse2 avx2 avx512 neon; do
        export RTC_SIMD=$level
        # A level that this machine lacks is told with an error.
        "$program" render scenes/zbuffer.yaml --size 16 -q -o "$out/picture.png" 2>/dev/null || continue
        for scene in scenes/*.yaml scenes/vase.glb benches/peers/rings.yaml; do
            "$program" render "$scene" --size 96 --threads 1 -q -o "$out/picture.png" >&2
        done
    done
    unset LLVM_PROFILE_FILE RTC_SIMD
    "$(rustc --print sysroot)/lib/rustlib/$(rustc -vV | sed -n 's/host: //p')/bin/llvm-profdata" merge -o "$out/rtc.profdata" "$out/counts"
    rm -rf "$out/counts" "$out/picture.png"
    echo "$state" >"$out/state"
fi
echo "$out/rtc.profdata"
