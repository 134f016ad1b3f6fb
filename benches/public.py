"""Public scenes by rtc and by Mitsuba: `public.py SCENES RESULTS`, with the program in RTC. Writes
benches/public.md.

A file is read if `rtc check` has no error, and rendered if `rtc render` makes a picture. A scene of
Mitsuba is rendered by Mitsuba (`scalar_rgb`) with the same size and samples and several seeds. Both
pictures are equal if their means differ by at most 0.5 %, or by less than three standard errors,
and if the means of at most 2 % of the blocks of 8 × 8 pixels differ by more than four standard
errors, all estimated from the seeds, and 1 % of the picture's mean. The variance of a block is at
least the mean of it and its neighbours, as few seeds estimate one block badly. How often Mitsuba's
last picture equals its others tells how good the rule is. The pictures have the file's integrator,
filter and bounces; where Mitsuba 3 has not an integrator, both have its path tracer."""

import concurrent.futures
import json
import os
import re
import shutil
import subprocess
import sys
import time
import xml.etree.ElementTree as tree

SIDE, SAMPLES, SEEDS = (
    int(os.environ.get(name, default))
    for name, default in (("SIDE", 48), ("SPP", 64), ("SEEDS", 4))
)
JOBS = int(os.environ.get("JOBS", os.cpu_count() or 1))
TIMEOUT = 120
COLLECTIONS = {
    "mitsuba/docs": (".xml",),
    "mitsuba/tests": (".xml",),
    "mitsuba/rooms": (".xml",),
    "pbrt/pbrt-v3-scenes": (".pbrt",),
    "pbrt/veach-ajar": (".pbrt",),
    "usd/test_assets": (".usd", ".usda", ".usdc", ".usdz"),
    "usd/full_assets": (".usd", ".usda", ".usdc", ".usdz"),
}


def scenes(folder):
    """The files of each collection; those that others include are no scenes."""
    for name, endings in COLLECTIONS.items():
        for place, folders, files in os.walk(os.path.join(folder, name)):
            folders.sort()
            for file in sorted(files):
                path = os.path.join(place, file)
                if file.endswith(endings) and is_scene(path):
                    yield name, path


def is_scene(path):
    """Whether a file is a scene, and not a part that others include."""
    if os.path.basename(os.path.dirname(path)) in ("include", "fragments"):
        return False
    with open(path, "rb") as file:
        data = file.read()
    if path.endswith(".xml"):
        return b"<scene" in data
    return not path.endswith(".pbrt") or b"WorldBegin" in data


def run(*command):
    """Whether a command succeeds, and what it says."""
    try:
        done = subprocess.run(command, capture_output=True, text=True, timeout=TIMEOUT)
    except subprocess.TimeoutExpired:
        return False, f"error: more than {TIMEOUT} s"
    return done.returncode == 0, done.stderr


def findings(text, kind):
    """The messages of a kind, each once."""
    found = re.findall(rf"^{kind}(?:\[\w+\])?: (.*)", text, re.MULTILINE)
    return list(dict.fromkeys(found))


def numbers(element, name, known):
    """The value of a property, where it may be a parameter of the scene."""
    found = [child for child in element if child.get("name") == name]
    value = found[0].get("value") if found else None
    value = known.get(value[1:], value) if value and value.startswith("$") else value
    return (found[0] if found else None), value


def make_small(path):
    """Gives the sensors of a Mitsuba file a small film and the samples of the comparison."""
    document = tree.parse(path)
    known = {node.get("name"): node.get("value") for node in document.iter("default")}
    make_readable(document)
    name = (
        "sampleCount" if document.getroot().get("version", "0").startswith("0") else "sample_count"
    )
    for sampler in document.iter("sampler"):
        sampler.set("type", "independent")
        set_integers(sampler, {name: SAMPLES}, known)
    for sensor in document.iter("sensor"):
        film = sensor.find("film")
        film = tree.SubElement(sensor, "film", type="hdrfilm") if film is None else film
        for child in [child for child in film if (child.get("name") or "").startswith("crop")]:
            film.remove(child)
        size = [
            numbers(film, side, known)[1] or default
            for side, default in (("width", 768), ("height", 576))
        ]
        try:
            width, height = (float(side) for side in size)
        except ValueError:
            # A parameter that the including file sets: a square.
            width = height = 1
        set_integers(film, {"width": SIDE, "height": max(1, round(SIDE * height / width))}, known)
        has_sampler = any(
            child.tag == "sampler" or "sampler" in (child.get("id") or "") for child in sensor
        )
        if not has_sampler:
            set_integers(
                tree.SubElement(sensor, "sampler", type="independent"), {name: SAMPLES}, known
            )
    document.write(path)


def make_readable(document):
    """Replaces what the variant `scalar_rgb` of Mitsuba 3 has not: colours in sRGB are written as
    linear ones, photon maps and their kin become the path tracer, and the integrator of Stokes
    vectors becomes the one inside it."""
    for color in document.iter("srgb"):
        color.tag = "rgb"
        channels = [float(channel) for channel in color.get("value").replace(",", " ").split()]
        linear = [
            channel / 12.92 if channel <= 0.04045 else ((channel + 0.055) / 1.055) ** 2.4
            for channel in channels
        ]
        color.set("value", " ".join(f"{channel:.9g}" for channel in linear))
    for parent in list(document.iter()):
        for index, child in enumerate(parent):
            if child.tag == "integrator" and child.get("type") == "stokes":
                parent[index] = child.find("integrator")
            elif child.tag == "integrator" and child.get("type") in (
                "$method",
                "sppm",
                "photonmapper",
            ):
                child.set("type", "path")
                for option in [
                    option
                    for option in child
                    if option.get("name") not in ("maxDepth", "max_depth")
                ]:
                    child.remove(option)


def is_xml(path):
    try:
        return tree.parse(path) is not None
    except tree.ParseError:
        return False


def set_integers(element, values, known):
    for name, value in values.items():
        found, _ = numbers(element, name, known)
        found = tree.SubElement(element, "integer", name=name) if found is None else found
        found.set("value", str(value))


def by_mitsuba(scene, out):
    """Renders a scene with several seeds, and writes their pictures; runs in a process of its own.
    """
    import mitsuba
    import numpy

    mitsuba.set_variant("scalar_rgb")
    mitsuba.set_log_level(mitsuba.LogLevel.Error)
    loaded = mitsuba.load_file(scene)
    pictures = [
        numpy.array(mitsuba.render(loaded, seed=seed), float)[:, :, :3] for seed in range(SEEDS)
    ]
    numpy.save(out, numpy.stack(pictures))


def blocks(picture):
    """The rows of the means of the blocks of 8 × 8 pixels; the last ones may be smaller."""
    height, width = picture.shape[:2]
    return [
        [picture[y : y + 8, x : x + 8].mean() for x in range(0, width, 8)]
        for y in range(0, height, 8)
    ]


def smoothed(blocks):
    """The mean of each block and its eight neighbours."""
    import numpy

    padded = numpy.pad(blocks, 1, mode="edge")
    height, width = blocks.shape
    return sum(padded[y : y + height, x : x + width] for y in range(3) for x in range(3)) / 9


def difference(pictures, ours):
    """How far a picture is from the mean of several, and whether it is equal."""
    import numpy

    means = pictures.mean((1, 2, 3))
    # The picture has the noise of one seed, the mean of the others that of all.
    factor = (1 + 1 / len(pictures)) ** 0.5
    error = means.std(ddof=1) * factor
    theirs = numpy.array([blocks(picture) for picture in pictures])
    variance = theirs.var(axis=0, ddof=1)
    noise = numpy.maximum(variance, smoothed(variance)) ** 0.5 * factor
    apart = numpy.abs(numpy.array(blocks(ours)) - theirs.mean(axis=0))
    least = 0.01 * means.mean()
    outside = float((apart > 4 * noise + least).mean())
    off = float(ours.mean() / max(means.mean(), 1e-9) - 1)
    is_near = abs(off) <= 0.005 or abs(ours.mean() - means.mean()) <= 3 * error
    return {"off": off, "outside": outside, "equal": bool(is_near and outside <= 0.02)}


def compared(pictures, ours):
    """How far two pictures are apart; reads the files of both."""
    import mitsuba
    import numpy

    mitsuba.set_variant("scalar_rgb")
    pictures = numpy.load(pictures)
    form = mitsuba.Bitmap.PixelFormat.RGB, mitsuba.Struct.Type.Float32, False
    ours = numpy.array(mitsuba.Bitmap(ours).convert(*form), float)
    if ours.shape != pictures.shape[1:]:
        return {"why": f"the size is {ours.shape[:2]}, and {pictures.shape[1:3]} of Mitsuba"}
    if not numpy.isfinite(pictures).all() or not numpy.isfinite(ours).all():
        return {"why": "a pixel is not finite"}
    return difference(pictures, ours) | {"itself": difference(pictures[:-1], pictures[-1])["equal"]}


def made(name, path, folder, results):
    """The result of one file, from the folder of results if it is there."""
    key = os.path.relpath(path, folder)
    stem = os.path.join(results, re.sub(r"\W", "_", key))
    if os.path.exists(f"{stem}.json"):
        with open(f"{stem}.json") as file:
            return json.load(file)
    rtc = os.environ["RTC"]
    root = "--asset-root", os.path.join(folder, os.path.dirname(name))
    result = {"collection": name, "file": key}
    result["read"], text = run(rtc, "check", *root, path)
    result["warnings"], result["errors"] = findings(text, "warning"), findings(text, "error")
    size = () if path.endswith(".xml") else ("--size", str(SIDE), "--spp", "4")
    result["rendered"], text = run(rtc, "render", "-q", *root, path, *size, "-o", f"{stem}.exr")
    result["errors"] += [
        message for message in findings(text, "error") if message not in result["errors"]
    ]
    if path.endswith(".xml") and result["rendered"]:
        # Mitsuba's picture stays where our own is made again.
        done, text = os.path.exists(f"{stem}.npy"), ""
        if not done:
            done, text = run(sys.executable, __file__, "mitsuba", path, f"{stem}.npy")
        lines = [line.strip() for line in text.splitlines() if line.strip()]
        result["twin"] = done
        if done:
            done, text = run(
                sys.executable,
                __file__,
                "compare",
                f"{stem}.npy",
                f"{stem}.exr",
                f"{stem}.twin.json",
            )
        if done:
            with open(f"{stem}.twin.json") as file:
                result.update(json.load(file))
        else:
            result["why"] = f"Mitsuba: {lines[-1][-120:] if lines else ''}"
    with open(f"{stem}.json", "w") as file:
        json.dump(result, file)
    return result


def reason(result):
    """Why a picture is missing or is not Mitsuba's."""
    if result["errors"]:
        return result["errors"][0]
    if "why" in result:
        return result["why"]
    # The first warning that is more than a note about where the picture is the same.
    return "; ".join(result["warnings"][:2]) or "no warning explains it"


def table(results):
    lines = [
        "# Public scenes",
        "",
        "How many public scenes of other renderers `rtc` reads and renders.",
        f"`benches/public.sh` writes this page. Pictures are {SIDE} pixels wide and have {SAMPLES}",
        f"samples per pixel. Mitsuba renders each of its scenes with {SEEDS} seeds.",
        "",
        os.environ["STATE"],
        "",
        "- *Read*: `rtc check` finds no error.",
        "- *By Mitsuba*: Mitsuba renders the file, too.",
        "- *Equal*: the means differ by at most 0.5 % or the noise, and the blocks of 8 × 8 pixels",
        "  differ by at most four standard errors and 1 % of the mean.",
        "- *Itself*: the last picture of Mitsuba is equal to its other pictures by this rule.",
        "",
        "| collection | files | read | rendered | by Mitsuba | itself | equal |",
        "| --- | --- | --- | --- | --- | --- | --- |",
    ]
    for name in COLLECTIONS:
        found = [result for result in results if result["collection"] == name]
        is_mitsuba = name.startswith("mitsuba")
        count = lambda key: sum(bool(result.get(key)) for result in found)
        twins = [count("twin"), count("itself"), count("equal")] if is_mitsuba else [""] * 3
        cells = [name, len(found), count("read"), count("rendered"), *twins]
        lines.append(f"| {' | '.join(str(cell) for cell in cells)} |")
    lines += [
        "",
        "## Files that are not equal, not rendered or not read",
        "",
        "*Off* is the difference of the means, *blocks* the share of blocks that differ.",
        "",
        "| file | off | blocks | why |",
        "| --- | --- | --- | --- |",
    ]
    for result in results:
        is_twin = result["file"].endswith(".xml")
        if result["read"] and result["rendered"] and (result.get("equal") or not is_twin):
            continue
        off = f"{100 * result['off']:+.1f} %" if "off" in result else ""
        outside = f"{100 * result['outside']:.0f} %" if "outside" in result else ""
        why = reason(result).replace("|", "\\|")
        lines.append(f"| {result['file']} | {off} | {outside} | {why[:160]} |")
    return "\n".join(lines) + "\n"


def main(folder, results):
    os.makedirs(results, exist_ok=True)
    copy = os.path.join(results, "scenes")
    if not os.path.exists(copy):
        # The scenes of Mitsuba become small in a copy.
        part = f"{copy}.part"
        shutil.rmtree(part, ignore_errors=True)
        shutil.copytree(folder, part, copy_function=shutil.copyfile)
        for place, _, files in os.walk(part):
            for file in files:
                if file.endswith(".xml") and is_xml(os.path.join(place, file)):
                    make_small(os.path.join(place, file))
        os.replace(part, copy)
    found = list(scenes(copy))
    start = time.monotonic()
    with concurrent.futures.ThreadPoolExecutor(JOBS) as pool:
        done = list(pool.map(lambda one: made(*one, copy, results), found))
    with open("benches/public.md", "w") as file:
        file.write(table(done))
    print(f"{len(done)} files in {time.monotonic() - start:.0f} s")


if __name__ == "__main__":
    match sys.argv[1:]:
        case ["mitsuba", scene, out]:
            by_mitsuba(scene, out)
        case ["compare", pictures, ours, out]:
            with open(f"{out}.part", "w") as file:
                json.dump(compared(pictures, ours), file)
            os.replace(f"{out}.part", out)
        case [folder, results]:
            main(folder, results)
        case _:
            sys.exit(__doc__)
