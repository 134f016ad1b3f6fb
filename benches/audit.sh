#!/usr/bin/env bash
# Audits 1 008 tampered pictures, counts how often a draw misses as many damaged tiles as the bound rules out, and audits 250 sound
# pictures and parts on changing threads and instructions. `benches/audit.sh arm64`: pictures of this
# machine are audited on arm64, which qemu simulates, and the other way round; this needs the target of rustup and
# qemu-aarch64-static. Exits with 1 if a promise was broken. AUDIT is a driver that was built before.
set -euo pipefail
cd "$(dirname "$0")/.."
. benches/driver.sh
audit=${AUDIT:-$(driver audit)}
if [ "${1:-}" != arm64 ]; then
    exec "$audit"
fi
arm64=$(CARGO_TARGET_AARCH64_UNKNOWN_LINUX_MUSL_LINKER=rust-lld cargo bench --locked --no-run --quiet --profile dev --no-default-features \
    --bench audit --target aarch64-unknown-linux-musl --config profile.dev.opt-level=0 --message-format json-render-diagnostics |
    sed -n 's/.*"kind":\["bench"\].*"executable":"\([^"]*\)".*/\1/p')
out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT
mkdir "$out/here" "$out/arm64"
"$audit" write "$out/here"
qemu-aarch64-static "$arm64" write "$out/arm64"
qemu-aarch64-static "$arm64" read "$out/here"
"$audit" read "$out/arm64"
cmp "$out/here/0" "$out/arm64/0"
