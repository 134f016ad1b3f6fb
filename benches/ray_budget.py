"""Where the time of a picture goes, in nanoseconds a camera ray: `ray_budget.py`, with `perf`, a
program with symbols in RTC, and the scenes of `peers/scenes.py` in target/peers. One thread, vector
instructions by RTC_SIMD. Inlined functions count with those that called them."""

import os
import re
import subprocess
import sys
import tempfile

PARTS = [  # The first that a symbol matches; its own crate first, then what runs below it.
    (
        "tree and intersections",
        r"vectorize|accel::|closest_hit|any_hit|transmittance|intersect|::torus|::sphere|triangle::|::rescaled|small_scene",
    ),
    ("hit points", r"rtc_render::shape|rtc_render::ray|corner_values|column|plane"),
    ("textures", r"rtc_render::texture"),
    ("materials", r"rtc_render::(bsdf|material)|phong"),
    ("lights", r"rtc_render::light|discrete"),
    ("sample numbers", r"rtc_render::sampler"),
    ("camera, film and paths", r"rtc_render::(integrator|film|camera|frame|filter|lanes)"),
    ("functions", r"libm|rtc_math|memmove|memset|memcpy|exp|pow"),
    ("the rest", r""),  # Reading the scene, too.
]
SCENES = [
    ("camera", "scenes/camera.yaml", 400, None, 16),
    ("rings", "benches/peers/rings.yaml", 480, 270, 4),
    ("courtyard", "target/peers/Courtyard.yaml", 256, None, 64),
    ("FlightHelmet", "target/peers/FlightHelmet.yaml", 256, None, 32),
    ("a room", "../shared/public-scenes/mitsuba/rooms/living-room/scene.xml", 256, 144, 32),
]


def shares(command):
    """CPU-seconds, and by a second run under `perf` the share of each part."""
    with tempfile.TemporaryDirectory() as folder:
        data = f"{folder}/perf.data"
        recorder = ["perf", "record", "-q", "-e", "cpu-clock", "-F", "2000", "-o", data]
        command = [*command, f"{folder}/picture.png"]
        before = os.times()
        subprocess.run(command, check=True)
        after = os.times()
        subprocess.run([*recorder, *command], check=True)
        report = ["perf", "report", "-i", data, "--no-children", "--stdio", "-F", "overhead,symbol"]
        told = subprocess.run(report, capture_output=True, text=True, check=True).stdout
    found = dict.fromkeys((name for name, _ in PARTS), 0.0)
    for share, symbol in re.findall(r"^\s*([0-9.]+)%\s+\[.\]\s+(.*)$", told, re.M):
        part = next(name for name, pattern in PARTS if re.search(pattern, symbol))
        found[part] += float(share) / 100
    return (
        after.children_user + after.children_system - before.children_user - before.children_system,
        found,
    )


def main():
    rows = []
    for name, scene, width, height, samples in SCENES:
        if not os.path.exists(scene):
            print(f"no {scene}: it is left out", file=sys.stderr)
            continue
        size = f"{width}x{height or width}"
        paths = [] if name in ("camera", "rings") else ["--spp", str(samples)]
        command = [
            os.environ["RTC"],
            "render",
            scene,
            "--size",
            size,
            *paths,
            "--threads",
            "1",
            "-q",
            "--asset-root",
            "../shared",
            "-o",
        ]
        seconds, found = shares(command)
        each = 1e9 * seconds / (width * (height or width) * samples)
        rows.append((f"{name}, {samples} a pixel", each, found))
    print(
        "Nanoseconds per camera ray and all rays that follow it, one thread, "
        f"`RTC_SIMD={os.environ.get('RTC_SIMD', 'best')}`.\n"
    )
    print("| scene | all | " + " | ".join(name for name, _ in PARTS) + " |")
    print("| --- |" + " --: |" * (len(PARTS) + 1))
    for name, each, found in rows:
        cells = [f"{each * found[part]:.0f}" for part, _ in PARTS]
        print(f"| {name} | {each:.0f} | " + " | ".join(cells) + " |")


if __name__ == "__main__":
    main()
