#!/usr/bin/env bash
# Renders every scene of this folder into target/gallery/index.html, each with its source beside it.
set -euo pipefail
cd "$(dirname "$0")/.."
cargo build --release --quiet
out=target/gallery
mkdir -p "$out"

escape() { sed 's/&/\&amp;/g; s/</\&lt;/g; s/>/\&gt;/g' "$1"; }

{
    echo '<!doctype html><html lang="en"><meta charset="utf-8"><title>scenes of rtc</title>'
    echo '<meta name="viewport" content="width=device-width, initial-scale=1">'
    echo '<style>body{font:16px sans-serif;margin:1em auto;max-width:70em;padding:0 1em}section{display:flex;flex-wrap:wrap'
    echo ';gap:1em;margin:2em 0}img{align-self:flex-start;max-width:100%}pre{flex:1;min-width:18em;max-height:25em'
    echo ';overflow:auto;background:#eee;padding:1em;margin:0}h2{flex-basis:100%;margin:0}</style>'
    for scene in scenes/*.yaml; do
        name=$(basename "$scene" .yaml)
        ./target/release/rtc render -q "$scene" -o "$out/$name.png"
        echo "<section><h2>$name</h2><img src=\"$name.png\" alt=\"$name\"><pre>$(escape "$scene")</pre></section>"
    done
    echo '</html>'
} >"$out/index.html.new"
mv "$out/index.html.new" "$out/index.html"
echo "$out/index.html"
