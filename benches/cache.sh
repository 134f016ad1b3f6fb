#!/usr/bin/env bash
# What `--cache` saves: a folder of 100 small models, rendered twice. And that a cache never gives a
# wrong picture: after 50 killed processes, with two processes at once, and on a full disk.
. "$(dirname "$0")/driver.sh"
rtc=$(rtc)
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
mkdir models

# A ball of 40 × 20 quads with another radius in each model.
python3 - <<'END'
from math import cos, pi, sin
for number in range(100):
    with open(f"models/ball-{number:03}.obj", "w") as out:
        for row in range(21):
            for column in range(40):
                radius = 1 + number / 100 + 0.1 * sin(number + 5 * row)
                up, around = 0.1 + (pi - 0.2) * row / 20, 2 * pi * column / 40
                x, y, z = sin(up) * cos(around), cos(up), sin(up) * sin(around)
                out.write(f"v {radius * x:.6f} {radius * y:.6f} {radius * z:.6f}\n")
        for row in range(20):
            for column in range(40):
                a, b = 40 * row + column + 1, 40 * row + (column + 1) % 40 + 1
                out.write(f"f {a} {b} {b + 40} {a + 40}\n")
END

now() { date +%s.%N; }
render() { "$rtc" render models -o "$1/" --cache cache -q --size 64x64; }
begin=$(now)
render first
middle=$(now)
render second
end=$(now)
diff -r first second
awk -v a="$begin" -v b="$middle" -v c="$end" 'BEGIN {
    printf "100 models: %.2f s, again %.2f s: %.0f times as fast\n", b - a, c - b, (b - a) / (c - b)
}'

# Processes that end at any moment: the next one makes the right picture.
for kill in $(seq 50); do
    rm -rf cache
    "$rtc" render models/ball-000.obj -o killed.png --cache cache -q --size 64x64 &
    process=$!
    sleep "0.0$((kill % 10))$((kill / 10))"
    kill -9 $process 2>/dev/null || true
    wait $process 2>/dev/null || true
    "$rtc" render models/ball-000.obj -o after.png --cache cache -q --size 64x64
    "$rtc" render models/ball-000.obj -o again.png --cache cache -q --size 64x64
    [ -e plain.png ] || "$rtc" render models/ball-000.obj -o plain.png -q --size 64x64
    cmp plain.png after.png
    cmp plain.png again.png
done
echo "50 killed processes: no wrong picture"

# Two processes at once over one folder: from an empty cache, and from the one that they made.
few() { "$rtc" render models/ball-00*.obj -o "$1/" --cache cache -q --size 64x64; }
rm -rf cache
for round in 1 2; do
    few "one-$round" & one=$!
    few "two-$round" & two=$!
    wait "$one"
    wait "$two"
    for picture in "one-$round"/* "two-$round"/*; do
        cmp "first/$(basename "$picture")" "$picture"
    done
done
echo "two processes at once: no wrong picture"

# A disk that is full: no file may have more blocks of 512 bytes than this (the unit of POSIX). It
# is about the size of the picture, so that either the picture or its entry does not fit.
picture=$(($(wc -c <plain.png) / 512))
for blocks in 1 $picture $((picture + 1)) $((picture + 2)) $((picture + 3)); do
    rm -rf cache
    for _ in 1 2; do
        (set -o posix && trap '' XFSZ && ulimit -f "$blocks" &&
            "$rtc" render models/ball-000.obj -o full.png --cache cache -q --size 64x64 2>said) ||
            grep -q full.png said
        [ ! -e full.png ] || cmp plain.png full.png
        rm -f full.png
    done
    "$rtc" render models/ball-000.obj -o after.png --cache cache -q --size 64x64
    cmp plain.png after.png
done
echo "a full disk: no wrong picture"
