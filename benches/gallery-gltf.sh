#!/usr/bin/env bash
# Renders every asset of a folder into target/gallery/gltf.html: its picture, its name, the CPU time it took, samples per
# CPU-second, and what was found in it. `gallery-gltf.sh [FOLDER [ARGUMENTS OF RENDER]]`; fails if an asset has no picture.
set -euo pipefail
cd "$(dirname "$0")/.."
. benches/driver.sh
rtc=$(rtc)
folder=${1:-../shared/gltf/assets}
[ -d "$folder" ] || { echo "no folder $folder: nothing to show" && exit 0; }
size=${SIZE:-256} spp=${SPP:-64} out=target/gallery/gltf
mkdir -p "$out"

escape() { sed 's/&/\&amp;/g; s/</\&lt;/g; s/>/\&gt;/g'; }

failed=0
{
    echo '<!doctype html><html lang="en"><meta charset="utf-8"><title>glTF by rtc</title>'
    echo '<meta name="viewport" content="width=device-width, initial-scale=1">'
    echo '<style>body{font:14px sans-serif;margin:1em;display:grid;gap:1em;grid-template-columns:repeat(auto-fill,16em)}'
    echo 'figure{margin:0}img{width:100%}pre{max-height:12em;overflow:auto;white-space:pre-wrap;font-size:.8em}</style>'
    while read -r asset; do
        name=$(basename "${asset%.*}")
        arguments=(render "$asset" -v --color never --message-format short --size "${size}x$size" --spp "$spp")
        TIMEFORMAT='%U %S'
        status=0
        { time "$rtc" "${arguments[@]}" "${@:2}" -o "$out/$name.png" >"$out/$name.txt" 2>&1 || status=$?; } 2>"$out/time"
        read -r user system <"$out/time"
        rate=$(awk "BEGIN { t = $user + $system; printf \"%.2f s, %.2f M samples/s\", t, $size * $size * $spp / t / 1e6 }")
        [ "$status" = 0 ] || failed=1 rate="exit code $status"
        echo "<figure><img src=\"gltf/$name.png\" alt=\"$name\"><figcaption><b>$name</b><br>$rate</figcaption>"
        echo "<pre>$(sed "s|$folder/||g" "$out/$name.txt" | escape)</pre></figure>"
        echo "$name: $rate" >&2
    done < <(find "$folder" \( -name '*.gltf' -o -name '*.glb' \) | sort)
    echo '</html>'
} >"$out.html.new"
mv "$out.html.new" "$out.html"
rm "$out/time"
echo "$out.html"
exit "$failed"
