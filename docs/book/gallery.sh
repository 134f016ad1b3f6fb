#!/usr/bin/env bash
# Renders the pictures of the book into docs/book/src/pictures. With names as arguments it renders
# only those: `docs/book/gallery.sh glass metals`. RTC is the program; without it one is built.
set -euo pipefail
cd "$(dirname "$0")/../.."
if [[ -z ${RTC:-} ]]; then
    cargo build --release --quiet
    RTC=target/release/rtc
fi
own=docs/book/scenes out=docs/book/src/pictures
names=("$@")
mkdir -p "$out"

# picture NAME FILE OPTION...
picture() {
    local name=$1
    shift
    if ((${#names[@]})) && [[ " ${names[*]} " != *" $name "* ]]; then return; fi
    echo "$name"
    "$RTC" render -q "$@" -o "$out/$name.jpg"
}

# The tutorial.
for scene in "$own"/tutorial-0*.yaml; do
    picture "$(basename "$scene" .yaml)" "$scene"
done
for step in 10-model 11-lens; do
    picture "tutorial-$step" "$own/tutorial-$step.yaml" --clamp 4
done

# Scenes of rays and their mirror images.
picture mirrors scenes/mirrors.yaml --size 480 --supersampling 3
picture glass scenes/glass.yaml --size 480x360
picture mirror-box scenes/mirror-box.yaml --size 480x360
picture soft-light scenes/soft-light.yaml --size 480x300
picture depth-of-field scenes/depth-of-field.yaml --size 480
picture bokeh scenes/bokeh.yaml --size 480x360
picture globe scenes/globe.yaml --size 480
picture off-axis-eye scenes/off-axis-eye.yaml --size 480
picture gooch scenes/gooch.yaml --size 480 --supersampling 3
picture normals scenes/normals.yaml --size 480 --supersampling 3
picture zbuffer scenes/zbuffer.yaml --size 480 --supersampling 3
for name in bricks town; do
    picture "$name" "$own/$name.yaml"
done

# Scenes whose light is followed along all paths; the first is that of the README.
picture hero "$own/hero.yaml" --spp 32 --denoise
for name in lamp room spots sun-and-sky; do
    picture "$name" "$own/$name.yaml" --spp 32 --denoise
done
for name in anisotropy dispersion iridescence metals transmission; do
    picture "$name" "$own/$name.yaml" --spp 72 --clamp 2
done

# Assets by themselves.
picture vase scenes/vase.glb --size 360 --spp 32 --denoise
for set in light dark soft; do
    picture "studio-$set" scenes/vase.glb --size 240 --spp 64 --studio "$set" --denoise
done
for variant in red blue brass; do
    picture "top-$variant" "$own/top.glb" --size 320 --variant "$variant" --spp 32 --denoise
done
picture top-above "$own/top.glb" --size 320 --camera above --spp 32 --denoise
picture top-tilted "$own/top.glb" --size 320 --animation wobble --time 0.25 --spp 32 --denoise

# The scene of `mistakes` after its repair, and where the rays of a study go.
made=$(mktemp -d)
trap 'rm -r "$made"' EXIT
cp docs/book/mistakes/ball.yaml "$made"
"$RTC" check -q --fix --unsafe "$made/ball.yaml"
picture ball "$made/ball.yaml" --supersampling 3
if ((${#names[@]} == 0)) || [[ " ${names[*]} " == *" rays "* ]]; then
    echo rays
    "$RTC" cost -q scenes/glass.yaml --effort quick --maps "$made" -o "$made/study"
    cp "$made/rays-own.png" "$out/rays.png"
fi
if ((${#names[@]} == 0)) || [[ " ${names[*]} " == *" certify "* ]]; then
    echo certify
    "$RTC" certify -q scenes/bokeh.yaml -o "$made/bokeh.png" --flags "$out/certify.png"
fi
