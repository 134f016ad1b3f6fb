#!/usr/bin/env bash
# Caustics found by chance and by manifold sampling (`caustics: true`), at about the same time: relMSE against a converged picture,
# relMSE per CPU-second, and fireflies (values above 10 times the reference and its mean) per million, as Markdown, for the scenes of
# benches/caustics. REFERENCE sets the samples of the converged pictures (default 4096), SIDE the pixels of a side (128); PATHS, if set, is the program `paths`.
set -euo pipefail
cd "$(dirname "$0")/.."
. benches/driver.sh
exec python3 benches/caustics.py "${PATHS:-$(driver paths)}" target/caustics
