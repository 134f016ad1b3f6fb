#!/usr/bin/env bash
# The kernels of both integrators, as a page in Markdown:
# - the bytes of the machine code of each, and whether it reaches `pow`, a texture, the torus, or
#   parts of a BSDF, by the relocations of a `release` build without link-time optimisation;
# - the instructions that each saves against the next larger kernel, and a kernel for the basic
#   shapes against the same one for all shapes;
# - instructions and times of pictures by the planned kernel and by the one with all features.
# Fails if a kernel reaches an effect that it leaves out, or if a limit is passed. Needs objdump,
# c++filt, Python and valgrind. `benches/kernels.sh >benches/kernels.md` writes the page.
. "$(dirname "$0")/driver.sh"
mkdir -p target/kernels
CARGO_TARGET_DIR=target/kernels cargo rustc --quiet --release -p rtc-render --lib -- \
    -C symbol-mangling-version=v0 --emit obj=target/kernels/rtc.o
kernels=$(driver kernels)

cat <<'END'
# Kernels

A kernel is an integrator that is compiled for a set of features. `benches/kernels.sh` writes this
page. Each kernel exists twice: for the basic shapes (spheres, planes and triangles) and for all
shapes.

END
printf '%s\n\n' "$STATE"
cat <<'END'
## Machine code

The bytes are those of all functions of the library that a kernel reaches from a picture on, with
those that start threads. The share is relative to the kernel with all features for all shapes. A ✓
marks what the code reaches.

END
python3 benches/kernels.py target/kernels/rtc.o src/plan/features.rs

# `count WHICH SCENE FUNCTIONS`: instructions of 40 × 40 pixels.
count() {
    instructions "$3" "$kernels" "$1" "$2" 40
}
picture=kernels::picture
cat <<'END'

## What each kernel saves

How many more instructions the next larger kernel takes for the same picture. For a kernel of the
basic shapes the last column compares it with the same kernel for all shapes. Pictures have 40 × 40
pixels, and 16 paths per pixel where they are path-traced. A kernel stays if it saves 2 % or more in
a scene that is planned for it.

| kernel | shapes | next larger | scene | instructions | over the next | over all shapes |
| --- | --- | --- | --- | --: | --: | --: |
END
while read -r scene; do
    [ -e "$scene" ] || continue
    names=$("$kernels" names "$scene")
    next=- all=-
    case $names in *'| ') ;; *) next=$(count next "$scene" "$picture") ;; esac
    case $names in *'| All |'*) ;; *) all=$(count all "$scene" "$picture") ;; esac
    echo "$(count planned "$scene" "$picture") $next $all" |
        awk -v names="${names,,}" -v scene="${scene##*/}" '
            function gain(other) {
                return other == "-" ? "" : sprintf("%.1f %%", 100 * (other / $1 - 1))
            }
            { printf "| %s | `%s` | %.0f | %s | %s |\n", names, scene, $1, gain($2), gain($3) }'
done <<'END'
scenes/five-spheres.yaml
scenes/grey-ball.yaml
tests/render/record/torus.yaml
tests/render/alpha/transparent.yaml
scenes/one-light-shadows.yaml
scenes/globe.yaml
scenes/camera.yaml
tests/render/camera/lens.yaml
scenes/shapes.yaml
../shared/course/scenes/mesh.yaml
../shared/gltf/refs/CornellLambert.json
scenes/vases.yaml
../shared/gltf/refs/FlightHelmet.json
../shared/gltf/refs/GlassSphere.json
END
cat <<'END'

## Pictures

Instructions of the same pictures by the planned kernel; by the kernel with all features for all
shapes (*everything*); and without any rule of the plan (*no rule*). Each share is that of the
planned kernel, and *limit* is the largest allowed share of the last kind. *Hits* is the part of
path tracing that finds what rays hit, which is the same work for all kernels. CPU-seconds are those
of 160 × 160 pixels on one thread, medians of nine pictures in turns.

| scene | planned | hits | everything | share | no rule | share | limit | planned, s | everything, s | gain |
| --- | --: | --: | --: | --: | --: | --: | --: | --: | --: | --: |
END
while read -r scene limit; do
    [ -e "$scene" ] || continue
    hits=$(($(count planned "$scene" '*PathTracer*next_hit') +
        $(count planned "$scene" '*PathTracer*visibility')))
    echo "$(basename "$scene") $(count planned "$scene" "$picture")" \
        "$(count everything "$scene" "$picture") $(count unpruned "$scene" "$picture") $limit" \
        "$("$kernels" time "$scene") $hits" | awk '{
        hits = $8 > 0 ? sprintf("%.0f %%", 100 * $8 / $2) : ""
        printf "| `%s` | %.0f | %s | %.0f | %.2f | ", $1, $2, hits, $3, $2 / $3
        printf "%.0f | %.2f | %s | %.3f | %.3f | %.2f |\n", $4, $2 / $4, $5, $6, $7, $7 / $6
        exit $2 > $3 || $2 > $5 * $4
    }'
done <<'END'
scenes/normals.yaml 0.75
scenes/five-spheres.yaml 0.75
scenes/globe.yaml 0.72
scenes/vases.yaml 1
../shared/gltf/refs/CornellLambert.json 1
../shared/gltf/refs/FlightHelmet.json 1
../shared/gltf/refs/GlassSphere.json 1
END
