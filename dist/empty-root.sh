#!/usr/bin/env bash
# Installs an archive of `dist/build.sh` into a root that holds nothing else, and works there: `dist/empty-root.sh [ARCHIVE [RUNNER]]`,
# the archive being that for x86-64 without a word, and RUNNER a static program that runs it, as qemu-aarch64-static, which is
# then in the root, too. The picture must have the sha256 of the README. Needs user namespaces, or to be root.
set -euo pipefail
cd "$(dirname "$0")/.."
archive=${1:-$(ls target/dist-files/rtc-*-x86_64-unknown-linux-musl.tgz)}
runner=${2:+/runner}

root=$(mktemp -d)
trap 'rm -r "$root"' EXIT
mkdir "$root/scenes" "$root/tmp"
tar -xzf "$archive" -C "$root" --strip-components 1 --wildcards '*/rtc'
[[ -z $runner ]] || cp "$(command -v "$2")" "$root$runner"
cp scenes/glass.yaml "$root/scenes/"
sed 's/^Objects:/Objcts:/' scenes/five-spheres.yaml >"$root/scenes/slip.yaml"

# `run WORDS…`: a command in that root, with no environment; what it is and what it says.
run() {
    printf '$ rtc %s\n' "$*"
    env -i unshare --user --map-root-user --root "$root" --wd /scenes ${runner:+"$runner"} /rtc "$@" 2>&1
}

run --version
run check slip.yaml || true
run check --fix --unsafe slip.yaml
run render slip.yaml -o spheres.png
run render glass.yaml -o glass.png
run diff glass.png glass.png --gate 'rmse<=0'
find "$root" -type f -printf '%P %s bytes\n' | sort
sum=$(sha256sum "$root/scenes/glass.png" | cut -d ' ' -f 1)
grep -q "$sum" README.md
printf 'glass.png has the sha256 of the README\n'
