#!/usr/bin/env bash
# What checking costs: instructions from text to proof for 5 000 spheres, and peak memory above the text for 50 000; what
# planning the picture of those costs: instructions of 5 000, time of 50 000. Goals: 450 million instructions (it
# takes 519 in the profile that users get, 945 in `release`) and 60 MB.
# Needs valgrind; builds the driver `check_cost`.
set -euo pipefail
cd "$(dirname "$0")/.."
. benches/driver.sh
driver=$(driver check_cost)
out=$(mktemp)
trap 'rm -f "$out"' EXIT
instructions() {
    valgrind --tool=callgrind --callgrind-out-file=/dev/null --toggle-collect="*check_cost*$1*" "$driver" 5000 2>"$out" >/dev/null
    sed -n 's/.*Collected : //p' "$out"
}
echo "instructions, 5000 spheres: $(instructions text_to_proof)"
echo "instructions of the plan, 5000 spheres: $(instructions proof_to_plan)"
"$driver" 50000
