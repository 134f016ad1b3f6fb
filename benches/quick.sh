#!/usr/bin/env bash
# What `rtc cost --effort quick` takes beside one render of the scene on one thread, for scenes/:
# CPU-seconds, as a table in Markdown. The limit is 3, or 8 times the render if that is more. Fails
# if a study takes longer.
. "$(dirname "$0")/driver.sh"
rtc=$(rtc)
out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT
TIMEFORMAT='%U %S'
seconds() {
    { time "$rtc" "$@" >"$out/words" 2>&1; } 2>&1
}
echo '| scene | render | study | limit |'
echo '| --- | --: | --: | --: |'
for scene in scenes/*.yaml; do
    render=$(seconds render "$scene" --threads 1 -o "$out/picture.png")
    study=$(seconds cost "$scene" --effort quick)
    echo "$(basename "$scene" .yaml) $render $study"
done | awk '{
    render = $2 + $3; study = $4 + $5; limit = 8 * render > 3 ? 8 * render : 3
    printf "| %s | %.2f | %.2f | %.1f |\n", $1, render, study, limit
    if (study > limit) late = 1
} END { exit late }'
