#!/usr/bin/env bash
# What an asset of a million triangles costs. `big-asset.sh [TRIANGLES]` prints
# - the CPU-seconds of `rtc compile` to a container, and its peak of memory over the size of the
#   file (limits: 2 s and 3),
# - the CPU-milliseconds from the container to the start of building the BVH (limit: 100),
# - the same with a stored BVH, and from glTF.
. "$(dirname "$0")/driver.sh"
rtc=$(rtc)
asset=$(driver big_asset)
out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT

"$asset" write "$out/big.glb" "${1:-1e6}"
size=$(wc -c <"$out/big.glb")
for _ in 1 2 3; do
    /usr/bin/time -f '%U %S %M' "$rtc" compile "$out/big.glb" -o "$out/big.rtir" 2>"$out/cost"
    awk -v size="$size" '{
        form = "compile: %.2f CPU-seconds, peak %.2f × the file of %.1f MB\n"
        printf form, $1 + $2, $3 * 1024 / size, size / 1e6
    }' "$out/cost"
done
echo "container: $(wc -c <"$out/big.rtir") bytes"
"$rtc" compile "$out/big.glb" --with-bvh -o "$out/tree.rtir"
echo "with a stored hierarchy: $(wc -c <"$out/tree.rtir") bytes"
for file in big.rtir tree.rtir big.rtir tree.rtir big.glb; do
    echo "$file: $("$asset" start "$out/$file" | paste -sd, | sed 's/,/, /g')"
done
for file in big.glb big.rtir tree.rtir; do
    "$rtc" render -q --spp 1 --size 64x64 "$out/$file" -o "$out/$file.png"
done
cmp "$out/big.glb.png" "$out/big.rtir.png"
cmp "$out/big.glb.png" "$out/tree.rtir.png"
echo "the same picture from all"
