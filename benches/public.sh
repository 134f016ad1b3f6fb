#!/usr/bin/env bash
# How many public scenes of pbrt are read without an error, and rendered. `public.sh [FOLDER]`: those below
# ../shared/public-scenes/pbrt without. A file that others include is no scene. A line for each scene: whether it is
# read and rendered, its warnings by code, and the files that are not there.
set -euo pipefail
cd "$(dirname "$0")/.."
. benches/driver.sh
rtc=$(rtc)
folder=${1:-../shared/public-scenes/pbrt}
[ -d "$folder" ] || { echo "there is no folder $folder" >&2; exit 2; }
out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT
total=0 read=0 rendered=0
while IFS= read -r -d '' scene; do
    grep -qE '^[[:space:]]*(WorldBegin|Camera)' "$scene" || continue
    total=$((total + 1)) is_read=no is_rendered=no
    if "$rtc" check --message-format short --max-errors 1000 "$scene" 2>"$out/said"; then
        is_read=yes read=$((read + 1))
    fi
    if timeout 120 "$rtc" render -q "$scene" --size 32 --spp 4 -o "$out/p.png" 2>/dev/null; then
        is_rendered=yes rendered=$((rendered + 1))
    fi
    codes=$(grep -oE '(error|warning)\[[A-Z]+[0-9]+\]' "$out/said" | sort | uniq -c | awk '{ printf " %s×%s", $2, $1 }')
    absent=$(grep -c 'there is no file' "$out/said" || true)
    echo "${scene#"$folder"/}: read $is_read, rendered $is_rendered, absent files $absent,${codes:- nothing said}"
done < <(find "$folder" -name '*.pbrt' -print0 | sort -z)
echo "$read of $total scenes are read without an error, $rendered are rendered"
[ "$read" = "$total" ] && [ "$rendered" = "$total" ]
