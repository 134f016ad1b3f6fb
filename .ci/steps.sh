# What the scripts of this folder share; to be sourced.

# `step COMMAND…`: runs it under a headline with the time so far.
step() {
    printf '\n== %s s: %s\n' "$SECONDS" "$*"
    "$@"
}

# `tools NAME…`: components of the toolchain. Where rustup manages it, it brings those that are missing.
tools() {
    command -v rustup >/dev/null || return 0
    local tool
    for tool in "$@"; do
        cargo "${tool/rustfmt/fmt}" --version >/dev/null 2>&1 || step rustup component add "$tool"
    done
}

# `package PROGRAM NAME`: brings a program from Debian's packages, if it is missing.
package() {
    command -v "$1" >/dev/null && return 0
    step apt-get update -qq
    step apt-get install -y -qq "$2"
}

# What builds for arm64 and runs it here.
arm() {
    arm=aarch64-unknown-linux-musl
    step rustup target add "$arm"
    package qemu-aarch64-static qemu-user-static
    export CARGO_TARGET_AARCH64_UNKNOWN_LINUX_MUSL_LINKER=rust-lld
    export CARGO_TARGET_AARCH64_UNKNOWN_LINUX_MUSL_RUNNER=qemu-aarch64-static
}
