#!/usr/bin/env bash
# What hostile files cost. Runs `rtc` on each of tests/hostile with 256 MiB of addresses, 10 CPU-seconds and two threads,
# and prints a table: what was tried, the bytes of its files, how it ended, CPU seconds, and the peak of memory in MiB.
# Exits with 1 if a run took a CPU-second or more, or ended otherwise than expected.
set -euo pipefail
cd "$(dirname "$0")/.."
. benches/driver.sh
rtc=$(rtc)
hostile=$(driver hostile)
out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT
export RAYON_NUM_THREADS=2

"$hostile" "$out/files" >"$out/list"
echo "| what was tried | bytes | outcome | CPU seconds | peak MiB |"
echo "| --- | ---: | --- | ---: | ---: |"
faults=0
while IFS=$'\t' read -r folder expected name arguments; do
    IFS=$'\t' read -ra words <<<"$arguments"
    size=$(cat "$folder"/* | wc -c)
    code=0
    (
        cd "$folder"
        ulimit -v 262144 -t 10
        exec /usr/bin/time -o "$out/cost" -f '%U %S %M' "$rtc" "${words[@]}" 2>"$out/words" >"$out/output"
    ) || code=$?
    found=$(grep -om1 'error\[[A-Z0-9]*\]' "$out/words" || true)
    case "$expected" in
        -) [ "$code" = 0 ] && outcome=harmless || outcome="**exit $code** $found" ;;
        *) grep -q "error\[$expected\]" "$out/words" && [ "$code" = 1 ] && outcome=$expected || outcome="**exit $code** $found" ;;
    esac
    cost=$(tail -1 "$out/cost" | awk '{ printf "%.2f | %.0f", $1 + $2, $3 / 1024 }')
    echo "| $name | $size | $outcome | $cost |"
    if [[ $outcome == *exit* ]] || awk -v cost="${cost%% *}" 'BEGIN { exit !(cost >= 1) }'; then
        faults=$((faults + 1))
    fi
done <"$out/list"
[ "$faults" = 0 ] || { echo "$faults over their limits" >&2; exit 1; }
