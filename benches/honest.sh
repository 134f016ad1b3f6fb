#!/usr/bin/env bash
# How often a picture keeps the error that `--target-error` says: families of scenes, each scene with many seeds, against what is known
# of it or two references with a quarter of the error. The promise is 90 of 100. Arguments are how many pictures a family has at least
# (200 without), and families. HONEST is a driver that was built before.
set -euo pipefail
cd "$(dirname "$0")/.."
. benches/driver.sh
exec "${HONEST:-$(driver honest)}" "$@"
