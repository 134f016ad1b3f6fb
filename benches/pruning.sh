#!/usr/bin/env bash
# What the rules of the plan save: rays of each scene of the course as planned and with --no-prune, and instructions where
# rays tell little. Reads ../shared/course; where that is absent, the scenes of the repo. Fails if a picture differs by a
# byte, or if fewer instructions are saved than promised.
set -euo pipefail
cd "$(dirname "$0")/.."
cargo build --release --quiet
rtc=target/release/rtc
out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT
folder=../shared/course/scenes
[ -d "$folder" ] || folder=scenes

rays() {
    "$rtc" render "$2" -o "$out/$1.png" "${@:3}" 2>&1 | sed -n 's/.*, \([0-9,]*\) rays,.*/\1/p' | tr -d ,
}

echo '| scene | rays planned | rays unpruned | saved |'
echo '| --- | ---: | ---: | ---: |'
for scene in "$folder"/*.yaml; do
    name=$(basename "$scene" .yaml)
    case "$folder/$name" in
    ../*/scene0* | ../*/blue-earth | scenes/*) ;;
    *) continue ;;
    esac
    planned=$(rays planned "$scene")
    unpruned=$(rays unpruned "$scene" --no-prune)
    cmp "$out/planned.png" "$out/unpruned.png"
    echo "| \`$name\` | $planned | $unpruned | $(((unpruned - planned) * 100 / unpruned)) % |"
done

# The instructions of a picture beyond those of one of 8 × 8 pixels: what starting and reading take is not counted.
collected() {
    valgrind --tool=callgrind --callgrind-out-file=/dev/null "$rtc" render -q --threads 1 "$@" -o "$out/small.png" 2>&1 |
        sed -n 's/.*Collected : //p'
}
instructions() {
    echo $(($(collected --size "$2" "$1" "${@:3}") - $(collected --size 8x8 "$1" "${@:3}")))
}
if command -v valgrind >/dev/null && [ "$folder" != scenes ]; then
    for limit in scene01:400x400:75 blue-earth:100x100:72; do
        IFS=: read -r name size most <<<"$limit"
        planned=$(instructions "$folder/$name.yaml" "$size")
        unpruned=$(instructions "$folder/$name.yaml" "$size" --no-prune)
        share=$((planned * 100 / unpruned))
        echo "$name: $share % of the instructions are left, at most $most % are promised"
        [ "$share" -le "$most" ]
    done
fi
