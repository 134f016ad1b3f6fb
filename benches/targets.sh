#!/usr/bin/env bash
# How many samples `--target-error` takes, beside those that the target needs, as a table in
# Markdown: eight seeds of each scene, against two references with equal samples in all pixels.
# `targets.sh [SCENE...]`; by default twelve of scenes/. SAMPLES are those of a reference (4096),
# ERRORS the targets in grey levels, separated by commas (2), HEIGHT the pixels (20).
. "$(dirname "$0")/driver.sh"
if [ $# -eq 0 ]; then
    set -- scenes/{glass,glossy,mirrors,soft-light,depth-of-field,bokeh}.yaml \
        scenes/{vases,five-spheres,globe,shapes,mirror-box,terminator}.yaml
fi
targets=$(driver targets)
exec "$targets" "${SAMPLES:-4096}" "${ERRORS:-2}" "${HEIGHT:-20}" "$@"
