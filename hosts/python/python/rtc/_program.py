"""The command line, called in a process of its own."""

from __future__ import annotations

import subprocess
import sys


def ask(words: list[str], stdin: bytes | None = None) -> str:
    """What `rtc` prints for these words; a ValueError with what it says if it ends with a fault."""
    program = [sys.executable, "-m", "rtc", *words]
    done = subprocess.run(program, input=stdin, capture_output=True, check=False)
    if done.returncode != 0:
        raise ValueError(done.stderr.decode(errors="replace").strip())
    return done.stdout.decode()
