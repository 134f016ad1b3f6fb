#!/usr/bin/env bash
# How many public scenes are read without an error, and rendered. `public.sh [FOLDER]`: those below
# ../shared/public-scenes/pbrt and ../shared/public-scenes/usd without; files of pbrt (one that others include is no
# scene) and layers of USD. A line for each: whether it is read and rendered, its warnings by code, and the files that
# are not there; then a line for each kind.
set -euo pipefail
cd "$(dirname "$0")/.."
. benches/driver.sh
rtc=$(rtc)
if [ $# -gt 0 ]; then folders=("$1"); else folders=(../shared/public-scenes/pbrt ../shared/public-scenes/usd); fi
out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT
failed=no
# Tries all files of a kind below a folder: KIND FOLDER, and the tests of `find`.
try_all() {
    local kind=$1 folder=$2 total=0 read=0 rendered=0 scene is_read is_rendered codes absent
    shift 2
    while IFS= read -r -d '' scene; do
        [ "$kind" = USD ] || grep -qE '^[[:space:]]*(WorldBegin|Camera)' "$scene" || continue
        total=$((total + 1)) is_read=no is_rendered=no
        if "$rtc" check --asset-root "$folder" --message-format short --max-errors 1000 "$scene" 2>"$out/said"; then
            is_read=yes read=$((read + 1))
        fi
        if timeout 120 "$rtc" render --asset-root "$folder" -q "$scene" --size 32 --spp 4 -o "$out/p.png" 2>/dev/null; then
            is_rendered=yes rendered=$((rendered + 1))
        fi
        codes=$(grep -oE '(error|warning)\[[A-Z]+[0-9]+\]' "$out/said" | sort | uniq -c | awk '{ printf " %s×%s", $2, $1 }')
        absent=$(grep -c 'there is no file' "$out/said" || true)
        echo "${scene#"$folder"/}: read $is_read, rendered $is_rendered, absent files $absent,${codes:- nothing said}"
    done < <(find "$folder" \( "$@" \) -print0 | sort -z)
    [ "$total" -gt 0 ] || return 0
    echo "$kind: $read of $total are read without an error, $rendered are rendered"
    [ "$read" = "$total" ] && [ "$rendered" = "$total" ] || failed=yes
}
for folder in "${folders[@]}"; do
    [ -d "$folder" ] || { echo "there is no folder $folder" >&2; exit 2; }
    try_all pbrt "$folder" -name '*.pbrt'
    try_all USD "$folder" -name '*.usd' -o -name '*.usda' -o -name '*.usdc' -o -name '*.usdz'
done
[ "$failed" = no ]
