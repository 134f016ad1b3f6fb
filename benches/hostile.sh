#!/usr/bin/env bash
# What hostile files cost: `rtc` on each of tests/hostile with 256 MiB of address space, 10
# CPU-seconds and two threads, as a table in Markdown: what was tried, the bytes of its files, the
# outcome, CPU-seconds, and the peak of memory in MiB. Fails if a run takes a CPU-second or more, or
# does not end as expected.
. "$(dirname "$0")/driver.sh"
rtc=$(rtc)
hostile=$(driver hostile)
out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT
export RAYON_NUM_THREADS=2

"$hostile" "$out/files" >"$out/list"
echo '| what was tried | bytes | outcome | CPU seconds | peak MiB |'
echo '| --- | ---: | --- | ---: | ---: |'
faults=0
while IFS=$'\t' read -r folder expected name arguments; do
    IFS=$'\t' read -ra words <<<"$arguments"
    size=$(cat "$folder"/* | wc -c)
    code=0
    (
        cd "$folder"
        ulimit -v 262144 -t 10
        exec /usr/bin/time -o "$out/cost" -f '%U %S %M' "$rtc" "${words[@]}" \
            2>"$out/words" >"$out/output"
    ) || code=$?
    if [ "$expected" = - ] && [ "$code" = 0 ]; then
        outcome=harmless
    elif [ "$code" = 1 ] && grep -q "error\[$expected\]" "$out/words"; then
        outcome=$expected
    else
        outcome="**exit $code** $(grep -om1 'error\[[A-Z0-9]*\]' "$out/words" || true)"
    fi
    cost=$(tail -1 "$out/cost" | awk '{ printf "%.2f | %.0f", $1 + $2, $3 / 1024 }')
    echo "| $name | $size | $outcome | $cost |"
    if [[ $outcome == *exit* ]] || awk -v cost="${cost%% *}" 'BEGIN { exit !(cost >= 1) }'; then
        faults=$((faults + 1))
    fi
done <"$out/list"
[ "$faults" = 0 ] || { echo "$faults over their limits" >&2; exit 1; }
