#!/usr/bin/env bash
# What the rules of the plan save, as a table in Markdown: the rays of each scene of the course as
# planned and with `--no-prune`. Without ../shared/course it takes the scenes of the repository.
# Fails if a picture differs by a byte. (`kernels.sh` counts instructions.)
. "$(dirname "$0")/driver.sh"
rtc=$(rtc)
out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT
folder=../shared/course/scenes
[ -d "$folder" ] || folder=scenes

# `rays NAME SCENE [OPTION]`: the rays of a picture, which is NAME.png.
rays() {
    "$rtc" render "$2" -o "$out/$1.png" "${@:3}" 2>&1 |
        sed -n 's/.*, \([0-9,]*\) rays,.*/\1/p' | tr -d ,
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
