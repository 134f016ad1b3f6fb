#!/usr/bin/env bash
# Brings the peers: Embree, Mitsuba and Cycles into a Python environment of their own in target/peers, which bpy wants to be
# Python 3.11 (PYTHON names another one); POV-Ray, f3d and the LLVM that Mitsuba compiles with by the packages of Debian. Done once;
# later it takes no time.
set -euo pipefail
cd "$(dirname "$0")/../.."
venv=target/peers/venv
if [ ! -e "$venv/ready" ]; then
    "${PYTHON:-python3.11}" -m venv "$venv"
    "$venv/bin/pip" install --quiet --disable-pip-version-check \
        embreex==4.4.0.post1 mitsuba==3.9.1 bpy==4.5.0 numpy==1.26.4 pillow pyyaml
    touch "$venv/ready"
fi
if ! { command -v povray && command -v f3d && command -v xvfb-run && [ -e /usr/lib/*/libLLVM.so.19.1 ]; } >/dev/null; then
    apt-get update -qq
    apt-get install -y -qq --no-install-recommends povray f3d libllvm19 libgl1-mesa-dri xauth xvfb
fi
