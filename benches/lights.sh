#!/usr/bin/env bash
# Choice among many lights, before and after a change: `benches/lights.sh BEFORE`, where BEFORE is the program `rtc` of another commit;
# AFTER, if set, is that of this one. Prints relMSE, CPU time of the process and efficiency, 1 / (relMSE x time), of streets with so
# many lamps (benches/street.py) as Markdown, as in lights.md; COUNTS, SPP and REFERENCE set how much is measured. The reference is a
# picture of many paths by AFTER, the time the median of five turns on one thread.
set -euo pipefail
cd "$(dirname "$0")/.."
. benches/driver.sh
[ $# = 1 ] || { echo 'usage: benches/lights.sh BEFORE' >&2; exit 2; }
before=$(realpath "$1")
after=${AFTER:-$(rtc)}
work=$(mktemp -d)
trap 'rm -r "$work"' EXIT

render() { # PROGRAM SCENE SPP OUT
  "$1" render "$2" -o "$4" --spp "$3" --size 96x64 --threads 1 >"$work/log" 2>&1
}

relmse() { # PICTURE
  "$after" diff "$1" "$work/reference.exr" | awk '$1 == "relmse" { print $2 }'
}

seconds() { # PROGRAM SCENE
  local TIMEFORMAT='%U %S'
  { time render "$1" "$2" "$spp" "$work/timed.exr"; } 2>&1 | awk '{ print $1 + $2 }'
}

median() { sort -g | sed -n 3p; }

spp=${SPP:-16}
echo '| lights | relMSE before | after | CPU time, s, before | after | efficiency, × before |'
echo '| --: | --: | --: | --: | --: | --: |'
for count in ${COUNTS:-64 128 256 1000 4000}; do
  scene=$work/street.gltf
  python3 benches/street.py "$count" "$scene"
  render "$after" "$scene" "${REFERENCE:-2048}" "$work/reference.exr"
  render "$before" "$scene" "$spp" "$work/before.exr"
  render "$after" "$scene" "$spp" "$work/after.exr"
  for turn in 1 2 3 4 5; do
    seconds "$before" "$scene" >>"$work/before-$count"
    seconds "$after" "$scene" >>"$work/after-$count"
  done
  echo "$count $(relmse "$work/before.exr") $(relmse "$work/after.exr")" \
    "$(median <"$work/before-$count") $(median <"$work/after-$count")" |
    awk '{ printf "| %d | %.4f | %.4f | %.2f | %.2f | %.2f |\n", $1, $2, $3, $4, $5, $2 * $4 / ($3 * $5) }'
done
