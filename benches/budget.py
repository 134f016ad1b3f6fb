"""Renders scenes with time budgets and measures how long each process takes: the work of budget.sh.

python3 budget.py RTC SHARED
"""

import pathlib
import re
import subprocess
import sys
import tempfile
import time

BUDGETS = [0.1, 0.5, 2.0]
OWN = ["camera", "glossy", "soft-light", "mirror-box", "glass", "depth-of-field", "vases", "globe"]
ASSETS = ["FlightHelmet/FlightHelmet.gltf", "own_MetalRoughGrid.glb"]


def within(asked, took):
    return took <= asked + max(0.02, 0.05 * asked)


def run(rtc, scene, budget, folder):
    """Seconds from start to end, the warning, and what is said of the error."""
    command = [rtc, "render", str(scene), "--time-budget", str(budget), "-o", f"{folder}/a.png"]
    begun = time.monotonic()
    ended = subprocess.run(command, capture_output=True, text=True, check=True)
    took = time.monotonic() - begun
    warning = re.search(r"warning\[RD011\]: (.*)", ended.stderr)
    said = ended.stderr.strip().splitlines()[-1].split(",")[0]
    return took, warning.group(1) if warning else "", said


def main(rtc, shared):
    scenes = [pathlib.Path("scenes") / f"{name}.yaml" for name in OWN]
    assets = [pathlib.Path(shared) / "gltf/assets" / name for name in ASSETS]
    scenes += [asset for asset in assets if asset.exists()]
    kept, warned, silent = 0, 0, 0
    print(
        "| scene | asked, s | took, s | kept | warning | of the error |\n| --- | --: | --: | --- | "
        "--- | --- |"
    )
    with tempfile.TemporaryDirectory() as folder:
        for scene in scenes:
            for budget in BUDGETS:
                took, warning, said = run(rtc, scene, budget, folder)
                is_kept = within(budget, took)
                kept += is_kept
                warned += not is_kept and bool(warning)
                silent += not is_kept and not warning
                print(
                    f"| {scene.stem} | {budget} | {took:.2f} | {'yes' if is_kept else 'no'} | "
                    f"{warning} | {said} |"
                )
    print(
        f"\nOf {kept + warned + silent}: {kept} kept to 5 % or 20 ms, {warned} late with a "
        f"warning, {silent} late without."
    )
    return 1 if silent else 0


sys.exit(main(*sys.argv[1:]))
