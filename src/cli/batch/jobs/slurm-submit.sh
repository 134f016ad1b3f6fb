#!/bin/sh
# @TITLE@
set -eu
cd "$(dirname "$0")"
parts=$(sbatch --parsable parts.sh)
sbatch --dependency="afterok:${parts%%;*}" --kill-on-invalid-dep=yes merge.sh
