#!/usr/bin/env bash
# What is handed out: one archive a target with the program, its licences and those of its packages, its manual page and completions, and SHA256SUMS.
# `dist/build.sh [TARGET…]`; without a word the static programs for Linux and the one for Windows. Needs rustup, for arm64
# qemu-aarch64-static, for Windows x86_64-w64-mingw32-gcc and zip. What runs here without an emulator is optimised by a profile of
# the pictures of scenes/ (`dist/profile.sh`). What can be run here must print its version and make the picture of a scene with the
# bytes of the first target; what can't is told.
set -euo pipefail
cd "$(dirname "$0")/.."

targets=("${@:-x86_64-unknown-linux-musl}")
[[ $# -gt 0 ]] || targets+=(aarch64-unknown-linux-musl x86_64-pc-windows-gnu)
version=$(sed -n 's/^version = "\(.*\)"/\1/p' Cargo.toml | head -n 1)
out=target/dist-files
# The linker of the toolchain is enough where all code is Rust. It keeps functions of the same code once, and takes a bit for
# each address that is relocated.
for machine in X86_64 AARCH64; do
    export "CARGO_TARGET_${machine}_UNKNOWN_LINUX_MUSL_LINKER=rust-lld"
    export "CARGO_TARGET_${machine}_UNKNOWN_LINUX_MUSL_RUSTFLAGS=-C link-arg=--icf=all -C link-arg=--pack-dyn-relocs=relr"
done

# `runner TARGET`: how a program of the target runs here, on the last line; fails if it can't.
runner() {
    case $1-$(uname -sm) in
    x86_64-unknown-linux-*-"Linux x86_64" | aarch64-unknown-linux-*-"Linux aarch64" | *-apple-darwin-"Darwin "*) ;;
    aarch64-unknown-linux-*) command -v qemu-aarch64-static ;;
    *) return 1 ;;
    esac
}

# `try NAME PROGRAM…`: its version, and the picture of a scene, which is the same for all.
try() {
    local name=$1
    shift
    "$@" --version | head -n 1
    "$@" render scenes/camera.yaml --size 100 -q -o "$out/$name.png"
    [[ -e $out/first.png ]] || cp "$out/$name.png" "$out/first.png"
    cmp "$out/$name.png" "$out/first.png"
    rm "$out/$name.png"
}

# `pack TARGET PROGRAM [RUNNER]`: the archive.
pack() {
    local name=rtc-$version-$1 folder
    folder=$out/$name
    rm -rf "$folder"
    mkdir -p "$folder"
    cp "$2" LICENSE-APACHE LICENSE-MIT README.md CHANGELOG.md SECURITY.md "$folder"
    dist/notices.sh "$1" >"$folder/THIRD-PARTY-NOTICES.txt"
    "$out/native" man >"$folder/rtc.1"
    for shell in bash zsh fish powershell; do
        "$out/native" completions "$shell" >"$folder/rtc.$shell"
    done
    case $1 in
    *windows*) (cd "$out" && rm -f "$name.zip" && zip -q -r -X "$name.zip" "$name") ;;
    *) tar --sort=name --owner=0 --group=0 --numeric-owner --mtime="@0" -C "$out" -cf - "$name" | gzip -9n >"$out/$name.tgz" ;;
    esac
    rm -r "$folder"
}

rm -rf "$out"
mkdir -p "$out"
cargo build --quiet --locked --bin rtc
cp target/debug/rtc "$out/native"
for target in "${targets[@]}"; do
    rustup target add "$target" >/dev/null 2>&1
    flags=CARGO_TARGET_$(tr a-z- A-Z_ <<<"$target")_RUSTFLAGS profile=
    if run=$(runner "$target") && [[ -z $run ]]; then
        profile=-Cprofile-use=$(dist/profile.sh "$target")
    fi
    env "$flags=${!flags:-} $profile" cargo build --quiet --locked --profile dist --bin rtc --target "$target"
    program=target/$target/dist/rtc
    [[ -e $program ]] || program+=.exe
    printf '%s: %s bytes\n' "$target" "$(wc -c <"$program")"
    if run=$(runner "$target"); then
        # shellcheck disable=SC2086 # a program, or none
        try "$target" $run "$program"
    else
        printf 'built, not run: nothing here runs it\n'
    fi
    if [[ $target == *-musl ]] && readelf -d "$program" 2>/dev/null | grep -q NEEDED; then
        printf 'it needs libraries\n' >&2
        exit 1
    fi
    pack "$target" "$program"
done
rm -f "$out/native" "$out/first.png"
(cd "$out" && sha256sum rtc-* | tee SHA256SUMS)
