#!/usr/bin/env bash
# What checking costs: instructions from text to `ValidScene` for 5 000 spheres, and the peak of
# memory above the text for 50 000. What planning their picture costs: instructions for 5 000, time
# for 50 000. The goals are 450 million instructions (it takes 519 in `dist`, 945 in `release`) and
# 60 MB. Needs valgrind.
. "$(dirname "$0")/driver.sh"
driver=$(driver check_cost)
echo "instructions, 5000 spheres: $(instructions '*check_cost*text_to_proof*' "$driver" 5000)"
echo "instructions of the plan, 5000 spheres:" \
    "$(instructions '*check_cost*proof_to_plan*' "$driver" 5000)"
"$driver" 50000
