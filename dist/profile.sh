#!/usr/bin/env bash
# `dist/profile.sh TARGET`: how often each branch of the program for TARGET is taken in the pictures of scenes/, small and by all
# vector instructions there are here, and in the check of a long scene: the compiler lays the code out by it (profile-guided
# optimization). Prints the file, which is made once for the sources at hand. Needs rustup, and a machine that runs TARGET.
set -euo pipefail
cd "$(dirname "$0")/.."
target=$1
out=$PWD/target/profile/$target
state=$(git rev-parse HEAD:src HEAD:Cargo.toml HEAD:Cargo.lock; git diff HEAD -- src Cargo.toml Cargo.lock | sha256sum)
if [[ $(cat "$out/state" 2>/dev/null) != "$state" ]]; then
    rm -rf "$out"
    mkdir -p "$out/counts"
    rustup component add llvm-tools >/dev/null 2>&1
    flags=CARGO_TARGET_$(tr a-z- A-Z_ <<<"$target")_RUSTFLAGS
    env "$flags=${!flags:-} -Cprofile-generate=$out/counts" CARGO_TARGET_DIR=target/profile \
        cargo build --quiet --locked --profile dist --bin rtc --target "$target"
    program=target/profile/$target/dist/rtc
    export LLVM_PROFILE_FILE=$out/counts/%m.profraw
    for level in scalar sse2 avx2 avx512 neon; do
        export RTC_SIMD=$level
        # A level that this machine lacks is told with an error.
        "$program" render scenes/zbuffer.yaml --size 16 -q -o "$out/picture.png" 2>/dev/null || continue
        for scene in scenes/*.yaml scenes/vase.glb benches/peers/rings.yaml; do
            "$program" render "$scene" --size 96 --threads 1 -q -o "$out/picture.png" >&2
        done
    done
    unset RTC_SIMD
    awk 'BEGIN { print "Eye: [0, 0, 10]\nObjects:"
        for (k = 0; k < 1000; k++) printf "- type: sphere\n  position: [%.3f, 0.5, -%d]\n  radius: 0.75\n  material: {color: [0.2, 0.5, 0.7], ka: 0.2, kd: 0.7, ks: 0.5, n: 64}\n", k / 8, k
    }' >"$out/long.yaml"
    "$program" check -q "$out/long.yaml" >&2
    unset LLVM_PROFILE_FILE
    "$(rustc --print sysroot)/lib/rustlib/$(rustc -vV | sed -n 's/host: //p')/bin/llvm-profdata" merge -o "$out/rtc.profdata" "$out/counts"
    rm -rf "$out/counts" "$out/picture.png" "$out/long.yaml"
    echo "$state" >"$out/state"
fi
echo "$out/rtc.profdata"
