"""The bytes of each kernel and what its machine code reaches, for kernels.sh: `kernels.py OBJECT
FEATURES.rs`. Fails where a kernel reaches an effect that it leaves out."""

import re
import subprocess
import sys
from collections import defaultdict

# Sections hold one function or one constant each: the place of each symbol, and the symbols that
# each section names.
place, size, named = {}, {}, defaultdict(set)
for line in subprocess.run(
    ["objdump", "-twr", sys.argv[1]], capture_output=True, text=True, check=True
).stdout.splitlines():
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
names = subprocess.run(
    ["c++filt"], input="\n".join(symbols), capture_output=True, text=True, check=True
).stdout
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
    return {
        1 << int(bit or 0): text.lower()
        for text, bit in re.findall(
            r"pub const (\w+): Self = Self\(1(?: << (\d+))?\);", block[: block.index("\n}")]
        )
    }


WORLDS = {"basic": "World<rtc_render::shape::basic::Basic>>", "all": "World>"}
wrong = []


def table(method, kind, effects, count):
    """The rows of the kernels that are instances of `method`."""
    features = features_of(kind)
    print(
        "| features | shapes | bytes | share |",
        " | ".join(effects),
        "|\n| --- | --- | --: | --: |" + " :-: |" * len(effects),
    )
    rows = []
    for shapes, world in WORLDS.items():
        begin = f"<rtc_render::world::{world}::{method}<"
        kernels = {int(text.split(begin)[1].split(">")[0]) for text in names if begin in text}
        for kernel in sorted(kernels, key=lambda kernel: (kernel.bit_count(), kernel)):
            sections = reached(
                [
                    section
                    for section, text in name.items()
                    if section in size and f"{begin}{kernel}>" in text
                ]
            )
            reach = "\n".join(name.get(section, "") for section in sections)
            has = {
                effect: bool(re.search(code, reach, re.M)) for effect, (_, code) in effects.items()
            }
            can = {text for bit, text in features.items() if kernel & bit}
            wanted = {
                effect: need in can if need else shapes == "all"
                for effect, (need, _) in effects.items()
            }
            wrong.extend(
                f"{kernel} for {shapes} shapes: {effect}"
                for effect in effects
                if has[effect] != wanted[effect]
            )
            rows.append(
                (
                    ", ".join(sorted(can)),
                    shapes,
                    sum(size.get(section, 0) for section in sections),
                    has,
                )
            )
    whole = max(bytes for _, _, bytes, _ in rows)
    for can, shapes, bytes, has in rows:
        marks = " | ".join("✓" if has[effect] else "" for effect in has)
        print(f"| {can} | {shapes} | {bytes} | {100 * bytes / whole:.0f} % | {marks} |")
    if len(rows) != count:
        wrong.append(f"{len(rows)} kernels, not {count}")


print("Whitted's integrator:\n")
table(
    "sum_with",
    "Features",
    {
        "pow": ("highlight", r"math::pow::pow|^pow$"),
        "texture": ("maps", "bilinear::look_up"),
        "torus": (None, "Torus"),
    },
    14,
)
print("\nPaths:\n")
table(
    "sum_paths_with",
    "PathFeatures",
    {
        "albedo tables": ("microfacets", "albedo::look_up"),
        "sheen": ("layers", "sheen::Fibres"),
        "coat": ("layers", "coat::Coat"),
        "torus": (None, "Torus"),
    },
    6,
)
sys.exit("\n".join(wrong) or 0)
