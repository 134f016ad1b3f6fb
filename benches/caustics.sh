#!/usr/bin/env bash
# Caustics by plain path tracing and by manifold sampling (`caustics: true`) after about the same
# time, for the scenes of benches/caustics, as a table in Markdown: relMSE against a converged
# picture, relMSE per CPU-second, and fireflies per million values (above 10 times the reference and
# its mean). REFERENCE sets the samples of the converged pictures (4096), SIDE their pixels (128).
. "$(dirname "$0")/driver.sh"
paths=$(driver paths)
exec python3 benches/caustics.py "$paths" target/caustics
