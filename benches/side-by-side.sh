#!/usr/bin/env bash
# Every scene text of some folders beside what it becomes as glTF: OUT/index.html, by default target/side-by-side. Each is written
# as .glb, which our check must find without an error, and both are rendered small. `side-by-side.sh [OUT [FOLDER]...]`; texts that
# are no sound scenes are named at the end. Fails if a sound one is not written, or if what is written has an error.
set -euo pipefail
cd "$(dirname "$0")/.."
. benches/driver.sh
rtc=$(rtc)
out=${1:-target/side-by-side}
folders=("${@:2}")
[ "${#folders[@]}" -gt 0 ] || folders=(scenes ../shared/course ../shared/wild)
quick=(render -q --size "${SIZE:-200x150}" --supersampling 1 --aperture-samples 8 --light-samples 4 --glossy-samples 4 --spp 16)
mkdir -p "$out"

escape() { sed 's/&/\&amp;/g; s/</\&lt;/g; s/>/\&gt;/g'; }

failed=0 written=0 unsound=()
{
    echo '<!doctype html><html lang="en"><meta charset="utf-8"><title>Scenes beside their glTF</title>'
    echo '<meta name="viewport" content="width=device-width, initial-scale=1">'
    echo '<style>body{font:14px sans-serif;margin:1em;display:grid;gap:1em;grid-template-columns:repeat(auto-fill,32em)}'
    echo 'figure{margin:0}img{width:49%}pre{max-height:9em;overflow:auto;white-space:pre-wrap;font-size:.8em}</style>'
    while read -r scene; do
        name=$(sed 's|^\(\.\./\)*||; s|[^A-Za-z0-9._-]|-|g' <<<"${scene#/}")
        if ! "$rtc" check -q "$scene" >/dev/null 2>&1; then
            unsound+=("$scene")
            continue
        fi
        own=("$out/$name.png" "$out/$name.glb" "$out/$name.glb.png" "$out/$name.txt")
        if "$rtc" compile "$scene" -v --color never --message-format short -o "${own[1]}" 2>"${own[3]}" &&
            "$rtc" check -q "${own[1]}" 2>>"${own[3]}" >&2 &&
            "$rtc" "${quick[@]}" "$scene" -o "${own[0]}" 2>>"${own[3]}" &&
            "$rtc" "${quick[@]}" "${own[1]}" -o "${own[2]}" 2>>"${own[3]}"; then
            written=$((written + 1))
        else
            failed=1
            echo "$scene: $(tail -n 1 "${own[3]}")" >&2
        fi
        echo "<figure><img src=\"$name.png\" alt=\"$name\"> <img src=\"$name.glb.png\" alt=\"the same as glTF\">"
        echo "<figcaption><b>$name</b></figcaption><pre>$(escape <"${own[3]}")</pre></figure>"
    done < <(find "${folders[@]}" \( -name '*.yaml' -o -name '*.yml' \) | sort)
    echo "<p>No sound scenes: $(printf '%s ' "${unsound[@]}" | escape)</p></html>"
} >"$out/index.html.new"
mv "$out/index.html.new" "$out/index.html"
echo "$out/index.html: $written scenes beside their glTF, ${#unsound[@]} texts that are no sound scenes"
exit "$failed"
