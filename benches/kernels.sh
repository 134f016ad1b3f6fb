#!/usr/bin/env bash
# What is in the machine code of each integrator, as Markdown: bytes, and whether it reaches `pow`, a texture or the torus,
# by the relocations of the release build without link-time optimization; then the instructions of pictures by the integrator
# planned, beside those by the one that can do everything. Fails where an effect left out is there, or a limit is passed.
# Needs objdump, c++filt, Python and valgrind. `benches/kernels.sh >benches/kernels.md` makes the table that is kept.
set -euo pipefail
cd "$(dirname "$0")/.."
mkdir -p target/kernels
CARGO_TARGET_DIR=target/kernels CARGO_PROFILE_RELEASE_LTO=off cargo rustc --quiet --release --lib -- \
    -C symbol-mangling-version=v0 --emit obj=target/kernels/rtc.o
cargo build --quiet --release --example kernels

cat <<'END'
# Integrators

`benches/kernels.sh`. Bytes are of all functions of the library that an integrator reaches from a row of pixels on, with
those of the machinery of threads; the share is of the integrator that can do everything for all shapes; ✓ marks what is
reached. Each integrator is there for the basic shapes, which are spheres, planes and triangles, and for all shapes.

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

features = {1 << int(bit or 0): text.lower() for text, bit in
            re.findall(r"pub const (\w+): Self = Self\(1(?: << (\d+))?\);", open(sys.argv[2]).read())}
EFFECTS = {"pow": ("highlight", r"math::pow::pow|^pow$"), "texture": ("maps", "bilinear::look_up"), "torus": (None, "Torus")}
WORLDS = {"basic": "World<rtc::render::shape::basic::Basic>>", "all": "World>"}
print("| integrator | shapes | bytes | share |", " | ".join(EFFECTS), "|\n| --- | --- | --: | --: | :-: | :-: | :-: |")
rows, wrong = [], []
for shapes, world in WORLDS.items():
    begin = f"<rtc::render::world::{world}::render_with<"
    kernels = {int(text.split(begin)[1].split(">")[0]) for text in names if begin in text}
    for kernel in sorted(kernels, key=lambda kernel: (kernel.bit_count(), kernel)):
        sections = reached([section for section, text in name.items() if section in size and f"{begin}{kernel}>" in text])
        reach = "\n".join(name.get(section, "") for section in sections)
        has = {effect: bool(re.search(code, reach, re.M)) for effect, (_, code) in EFFECTS.items()}
        can = {text for bit, text in features.items() if kernel & bit}
        wanted = {effect: need in can if need else shapes == "all" for effect, (need, _) in EFFECTS.items()}
        wrong += [f"{kernel} for {shapes} shapes: {effect}" for effect in EFFECTS if has[effect] != wanted[effect]]
        rows.append((", ".join(sorted(can)) or "first hit", shapes, sum(size.get(section, 0) for section in sections), has))
everything = max(count for can, _, count, _ in rows if "naive" not in can)
for can, shapes, count, has in rows:
    marks = " | ".join("✓" if has[effect] else "" for effect in has)
    print(f"| {can} | {shapes} | {count} | {100 * count / everything:.0f} % | {marks} |")
if rows[0][2] > 0.4 * everything:
    wrong.append("the smallest integrator has more than 40 % of the bytes of everything")
sys.exit("\n".join(wrong) or len(rows) != 24)
END
cat <<'END'

Instructions of 160 × 160 pixels: as planned; as planned, but by the integrator that can do everything for all shapes; with
no rule of the plan. The limit is of the last share.

| scene | planned | everything | share | no rule | share | limit |
| --- | --: | --: | --: | --: | --: | --: |
END
count() {
    valgrind --tool=callgrind --callgrind-out-file=/dev/null --toggle-collect='kernels::picture' \
        target/release/examples/kernels "$1" "scenes/$2.yaml" 2>&1 | sed -n 's/.*Collected : //p'
}
while read -r scene limit; do
    echo "$scene $(count planned "$scene") $(count everything "$scene") $(count unpruned "$scene") $limit" | awk '{
        printf "| `%s` | %d | %d | %.2f | %d | %.2f | %s |\n", $1, $2, $3, $2 / $3, $4, $2 / $4, $5
        exit $2 > $3 || $2 > $5 * $4
    }'
done <<'END'
normals 0.75
five-spheres 0.75
globe 0.72
END
