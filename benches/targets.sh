#!/usr/bin/env bash
# How many samples `--target-error` takes, beside those that the target needs: eight seeds of each scene, small, against two references of
# many equal samples in all pixels. Arguments are scenes (twelve of scenes/ without); SAMPLES are those of a reference, TARGETS the errors in
# grey levels, with commas between, HEIGHT the pixels. TARGETS_DRIVER is a driver that was built before.
set -euo pipefail
cd "$(dirname "$0")/.."
. benches/driver.sh
if [ $# -eq 0 ]; then
    set -- scenes/{glass,glossy,mirrors,soft-light,depth-of-field,bokeh,vases,five-spheres,globe,shapes,mirror-box,terminator}.yaml
fi
exec "${TARGETS_DRIVER:-$(driver targets)}" "${SAMPLES:-4096}" "${TARGETS:-2}" "${HEIGHT:-20}" "$@"
