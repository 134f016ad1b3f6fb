#!/usr/bin/env bash
# What is in the machine code of each kernel of both integrators, as Markdown: bytes, and whether it reaches `pow`, a texture or
# the torus, or the code of a BSDF, by the relocations of the release build without link-time optimization; then what each
# kernel gains over the next larger one, and each set of shapes over all shapes; then the instructions of pictures by the kernel
# planned, beside those by the one that can do everything, and the time of both, taken in turns. Fails where an effect left out
# is there, or a limit is passed. Needs objdump, c++filt, Python and valgrind.
# `benches/kernels.sh >benches/kernels.md` makes the table that is kept.
set -euo pipefail
cd "$(dirname "$0")/.."
. benches/driver.sh
mkdir -p target/kernels
CARGO_TARGET_DIR=target/kernels cargo rustc --quiet --release -p rtc-render --lib -- \
    -C symbol-mangling-version=v0 --emit obj=target/kernels/rtc.o
kernels=$(driver kernels)

cat <<'END'
# Kernels

`benches/kernels.sh`. A kernel is an integrator compiled for a set of features. Bytes are of all functions of the library that
it reaches from a picture on, with those of the machinery of threads; the share is of the kernel that can do everything for
all shapes; ✓ marks what is reached. Each kernel is there for the basic shapes, which are spheres, planes and triangles, and
for all shapes.

END
python3 - target/kernels/rtc.o src/plan/features.rs <<'END'
import re, subprocess, sys
from collections import defaultdict

# Sections hold one function or one constant each: the place of each symbol, and the symbols that each section names.
place, size, named = {}, {}, defaultdict(set)
for line in subprocess.run(["objdump", "-twr", sys.argv[1]], capture_output=True, text=True, check=True).stdout.splitlines():
    if match := re.match(r"RELOCATION RECORDS FOR \[(\S+)\]", line):
        section = match[1]
    elif match := re.match(r"[0-9a-f]{16} R_\S+ +(\S+?)([-+]0x[0-9a-f]+)?$", line):
        named[section].add(match[1])
    elif match := re.match(r"[0-9a-f]{16} (.{7}) (\S+)\t([0-9a-f]{16}) +(?:\.hidden )?(\S+)", line):
        flags, home, length, symbol = match.groups()
        place[symbol] = symbol if home == "*UND*" else home
        if "F" in flags:
            size[home] = int(length, 16)
symbols = list(place)
names = subprocess.run(["c++filt"], input="\n".join(symbols), capture_output=True, text=True, check=True).stdout
names = re.sub(r"\[[0-9a-f]+\]|: u32\b", "", names).splitlines()
name = {place[symbol]: text for symbol, text in zip(symbols, names) if not text.startswith(".")}

def reached(todo):
    seen = set()
    while todo:
        if (section := todo.pop()) not in seen:
            seen.add(section)
            todo += [place.get(symbol, symbol) for symbol in named[section]]
    return seen

source = open(sys.argv[2]).read()

def features_of(kind):
    block = source[source.index(f"impl {kind} {{") :]
    return {1 << int(bit or 0): text.lower() for text, bit in
            re.findall(r"pub const (\w+): Self = Self\(1(?: << (\d+))?\);", block[: block.index("\n}")])}

WORLDS = {"basic": "World<rtc_render::shape::basic::Basic>>", "all": "World>"}
wrong = []

def table(method, kind, effects, count):
    """The rows of the kernels that are instances of `method`."""
    features = features_of(kind)
    print("| features | shapes | bytes | share |", " | ".join(effects), "|\n| --- | --- | --: | --: |" + " :-: |" * len(effects))
    rows = []
    for shapes, world in WORLDS.items():
        begin = f"<rtc_render::world::{world}::{method}<"
        kernels = {int(text.split(begin)[1].split(">")[0]) for text in names if begin in text}
        for kernel in sorted(kernels, key=lambda kernel: (kernel.bit_count(), kernel)):
            sections = reached([section for section, text in name.items() if section in size and f"{begin}{kernel}>" in text])
            reach = "\n".join(name.get(section, "") for section in sections)
            has = {effect: bool(re.search(code, reach, re.M)) for effect, (_, code) in effects.items()}
            can = {text for bit, text in features.items() if kernel & bit}
            wanted = {effect: need in can if need else shapes == "all" for effect, (need, _) in effects.items()}
            wrong.extend(f"{kernel} for {shapes} shapes: {effect}" for effect in effects if has[effect] != wanted[effect])
            rows.append((", ".join(sorted(can)), shapes, sum(size.get(section, 0) for section in sections), has))
    whole = max(bytes for _, _, bytes, _ in rows)
    for can, shapes, bytes, has in rows:
        marks = " | ".join("✓" if has[effect] else "" for effect in has)
        print(f"| {can} | {shapes} | {bytes} | {100 * bytes / whole:.0f} % | {marks} |")
    if len(rows) != count:
        wrong.append(f"{len(rows)} kernels, not {count}")

print("Whitted's integrator:\n")
table("sum_with", "Features", {
    "pow": ("highlight", r"math::pow::pow|^pow$"), "texture": ("maps", "bilinear::look_up"), "torus": (None, "Torus"),
}, 14)
print("\nPaths:\n")
table("sum_paths_with", "PathFeatures", {
    "albedo tables": ("microfacets", "albedo::look_up"), "sheen": ("layers", "sheen::Fibres"), "coat": ("layers", "coat::Coat"),
    "torus": (None, "Torus"),
}, 6)
sys.exit("\n".join(wrong) or 0)
END
count() {
    valgrind --tool=callgrind --callgrind-out-file=/dev/null --toggle-collect="$4" \
        "$kernels" "$1" "$2" "$3" 2>&1 | sed -n 's/.*Collected : //p'
}
picture=kernels::picture
cat <<'END'

What a kernel gains over the next larger one, and, if it is for the basic shapes, over the same one for all shapes:
instructions of 40 × 40 pixels, 16 paths each where paths are traced. A kernel stays if a scene planned for it gains 2 % or more by it.

| kernel | shapes | next larger | scene | instructions | over the next | over all shapes |
| --- | --- | --- | --- | --: | --: | --: |
END
while read -r scene; do
    [ -e "$scene" ] || continue
    names=$("$kernels" names "$scene")
    next=- all=-
    case $names in *'| ') ;; *) next=$(count next "$scene" 40 "$picture") ;; esac
    case $names in *'| All |'*) ;; *) all=$(count all "$scene" 40 "$picture") ;; esac
    echo "$(count planned "$scene" 40 "$picture") $next $all" | awk -v names="${names,,}" -v scene="${scene##*/}" '
        function gain(other) { return other == "-" ? "" : sprintf("%.1f %%", 100 * (other / $1 - 1)) }
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

Instructions of 40 × 40 pixels, 16 paths each where paths are traced: as planned, and of traced paths the share of finding what
rays hit, which is the same work for all kernels; as planned, but by the kernel that can do everything for all shapes; with no
rule of the plan. The limit is of the last share. Then CPU seconds of 160 × 160 pixels as planned and by that kernel, each the
median of nine pictures made in turns by one thread, and how many times as fast the kernel planned is.

| scene | planned | hits | everything | share | no rule | share | limit | planned, s | everything, s | gain |
| --- | --: | --: | --: | --: | --: | --: | --: | --: | --: | --: |
END
while read -r scene limit; do
    [ -e "$scene" ] || continue
    hits=$(($(count planned "$scene" 40 '*PathTracer*next_hit') + $(count planned "$scene" 40 '*PathTracer*visibility')))
    echo "$(basename "$scene") $(count planned "$scene" 40 "$picture") $(count everything "$scene" 40 "$picture")" \
        "$(count unpruned "$scene" 40 "$picture") $limit $("$kernels" time "$scene") $hits" | awk '{
        hits = $8 > 0 ? sprintf("%.0f %%", 100 * $8 / $2) : ""
        printf "| `%s` | %.0f | %s | %.0f | %.2f | %.0f | %.2f | %s | %.3f | %.3f | %.2f |\n",
            $1, $2, hits, $3, $2 / $3, $4, $2 / $4, $5, $6, $7, $7 / $6
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
