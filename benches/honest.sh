#!/usr/bin/env bash
# How often a picture keeps the error that `--target-error` prints, by families of scenes with many
# seeds each, against exact values or two references of a quarter of the error. The promise is 90 %.
# `honest.sh [PICTURES [FAMILY...]]`: at least so many pictures per family (200); by default all
# families.
. "$(dirname "$0")/driver.sh"
honest=$(driver honest)
exec "$honest" "$@"
