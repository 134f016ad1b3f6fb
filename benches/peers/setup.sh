#!/usr/bin/env bash
# Installs the peers once: Embree, Mitsuba and Cycles into a Python environment in target/peers, for
# which bpy needs Python 3.11 (PYTHON names it); POV-Ray, f3d, and the LLVM that Mitsuba compiles
# with, from the packages of Debian.
. "$(dirname "$0")/../driver.sh"
venv=target/peers/venv
if [ ! -e "$venv/ready" ]; then
    "${PYTHON:-python3.11}" -m venv "$venv"
    "$venv/bin/pip" install --quiet --disable-pip-version-check \
        embreex==4.4.0.post1 mitsuba==3.9.1 bpy==4.5.0 numpy==1.26.4 pillow pyyaml
    touch "$venv/ready"
fi
if ! { command -v povray && command -v f3d && command -v xvfb-run &&
    compgen -G '/usr/lib/*/libLLVM.so.19.1'; } >/dev/null; then
    apt-get update -qq
    apt-get install -y -qq --no-install-recommends \
        povray f3d libllvm19 libgl1-mesa-dri xauth xvfb
fi
