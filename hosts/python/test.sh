#!/usr/bin/env bash
# Builds the wheel, installs it in a fresh environment and runs its tests there: `hosts/python/test.sh [PROFILE]`, the profile
# of cargo being `release` without a word. The wheel stays in target/wheels.
set -euo pipefail
cd "$(dirname "$0")"
profile=${1:-release}

python3 -m venv target/build
target/build/bin/pip install --quiet 'maturin>=1.9,<2'
rm -rf target/wheels target/fresh
target/build/bin/maturin build --quiet --locked --profile "$profile" --out target/wheels
python3 -m venv target/fresh
target/fresh/bin/pip install --quiet "$(ls target/wheels/*.whl)[test]"
# From elsewhere, so that what is tested is what was installed.
cd tests
../target/fresh/bin/python -m pytest -q -p no:cacheprovider .
../target/fresh/bin/python -m mypy --strict -p rtc
ls -l ../target/wheels
