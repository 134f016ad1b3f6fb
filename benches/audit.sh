#!/usr/bin/env bash
# What `rtc audit` finds: audits of 1 008 tampered pictures, how often a random draw of tiles misses
# damaged ones beside the stated bound, and audits of 250 sound pictures and parts with other
# numbers of threads and other vector instructions. Fails if a promise is broken.
# `audit.sh arm64` audits pictures of this machine on arm64, which qemu simulates, and the other way
# round. It needs the target of rustup and qemu-aarch64-static.
. "$(dirname "$0")/driver.sh"
audit=$(driver audit)
if [ "${1:-}" != arm64 ]; then
    exec "$audit"
fi
arm64=$(driver_for aarch64-unknown-linux-musl audit 0)
out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT
mkdir "$out/here" "$out/arm64"
"$audit" write "$out/here"
qemu-aarch64-static "$arm64" write "$out/arm64"
qemu-aarch64-static "$arm64" read "$out/here"
"$audit" read "$out/arm64"
cmp "$out/here/0" "$out/arm64/0"
