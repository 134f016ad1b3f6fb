"""Pictures of scenes in Mitsuba's XML by rtc (left) and by Mitsuba (right), into docs/book/src/pictures/beside-NAME.jpg; prints a
table of the differences. `beside.py [NAME ...]`: these scenes, or all. Run from the root of the repo with Mitsuba's wheel installed;
RTC is the program. The rule of equality is that of benches/public.py."""
import os
import subprocess
import sys
import tempfile

sys.path.insert(0, "benches")
import mitsuba
import numpy
import public

WIDTH, HEIGHT, SAMPLES, SEEDS = 200, 150, 256, 4


def transform(steps):
    return f'<transform name="to_world">{steps}</transform>'


def bsdf(kind, more=""):
    return f'<bsdf type="{kind}" id="it">{more}</bsdf>'


def rgb(name, value):
    return f'<rgb name="{name}" value="{value}"/>'


def number(name, value):
    return f'<float name="{name}" value="{value}"/>'


def stacked(step):
    place = f'<translate x="{step % 3 - 1}" y="{0.3 + step // 3 * 0.7}"/>'
    return transform(f'<scale value="0.3"/><rotate y="1" angle="{20 * step}"/>{place}')


BALL = '<shape type="sphere"><point name="center" x="0" y="1" z="0"/><ref id="it"/></shape>'
FLOOR = """<shape type="rectangle">
    <transform name="to_world"><scale value="9"/><rotate x="1" angle="-90"/></transform>
    <bsdf type="twosided"><bsdf type="diffuse"><texture type="checkerboard" name="reflectance">
        <rgb name="color0" value="0.5 0.5 0.45"/><rgb name="color1" value="0.2 0.2 0.25"/>
        <transform name="to_uv"><scale x="9" y="9"/></transform>
    </texture></bsdf></bsdf></shape>"""
LAMP = """<shape type="sphere"><point name="center" x="3" y="6" z="4"/><float name="radius" value="0.7"/>
    <emitter type="area"><rgb name="radiance" value="24 22 18"/></emitter></shape>
    <emitter type="constant"><rgb name="radiance" value="0.25 0.3 0.4"/></emitter>"""
DIM = '<emitter type="constant"><rgb name="radiance" value="0.05"/></emitter>'
PANE = transform('<scale x="1.4" y="1" z="0.05"/><translate y="1" z="1.2"/>')
ABOVE = transform('<lookat origin="2, 6, 3" target="0, 0.6, 0" up="0, 1, 0"/>')
SQUARES = """<texture type="checkerboard" name="{}"><rgb name="color0" value="0.9 0.3 0.1"/>
    <rgb name="color1" value="0.1 0.4 0.9"/><transform name="to_uv"><scale x="3" y="3"/></transform></texture>"""

# A name, what the scene holds, and the type of its sensor.
SCENES = {
    "diffuse": (bsdf("diffuse", rgb("reflectance", "0.7 0.3 0.2")) + BALL + FLOOR + LAMP, ""),
    "plastic": (bsdf("plastic", rgb("diffuse_reflectance", "0.1 0.3 0.5")) + BALL + FLOOR + LAMP, ""),
    "rough-plastic": (
        bsdf("roughplastic", rgb("diffuse_reflectance", "0.5 0.1 0.1") + number("alpha", 0.2)) + BALL + FLOOR + LAMP,
        "",
    ),
    "gold": (bsdf("conductor", '<string name="material" value="Au"/>') + BALL + FLOOR + LAMP, ""),
    "rough-copper": (
        bsdf("roughconductor", '<string name="material" value="Cu"/><string name="distribution" value="ggx"/>' + number("alpha", 0.3))
        + BALL
        + FLOOR
        + LAMP,
        "",
    ),
    "glass": (bsdf("dielectric") + BALL + FLOOR + LAMP, ""),
    "rough-glass": (
        bsdf("roughdielectric", '<string name="distribution" value="ggx"/>' + number("alpha", 0.25)) + BALL + FLOOR + LAMP,
        "",
    ),
    "window": (
        bsdf("thindielectric")
        + f'<shape type="cube">{PANE}<ref id="it"/></shape>'
        + '<shape type="sphere"><point name="center" x="0" y="0.7" z="-0.6"/><float name="radius" value="0.7"/>'
        + '<bsdf type="diffuse"><rgb name="reflectance" value="0.6 0.5 0.1"/></bsdf></shape>'
        + FLOOR
        + LAMP,
        "",
    ),
    "spot": (
        bsdf("diffuse", rgb("reflectance", "0.7"))
        + BALL
        + FLOOR
        + DIM
        + f'<emitter type="spot">{ABOVE}{rgb("intensity", "90")}{number("cutoff_angle", 24)}{SQUARES.format("texture")}</emitter>',
        "",
    ),
    "projector": (
        bsdf("diffuse", rgb("reflectance", "0.7"))
        + BALL
        + FLOOR
        + DIM
        + f'<emitter type="projector">{ABOVE}{number("scale", 40)}{number("fov", 40)}{SQUARES.format("irradiance")}</emitter>',
        "",
    ),
    "instances": (
        bsdf("diffuse", rgb("reflectance", "0.3 0.6 0.3"))
        + '<shape type="shapegroup" id="group"><shape type="cube"><ref id="it"/></shape></shape>'
        + "".join(
            f'<shape type="instance"><ref id="group"/>{stacked(step)}</shape>'
            for step in range(9)
        )
        + FLOOR
        + LAMP,
        "",
    ),
    "lens": (
        "".join(
            f'<shape type="sphere"><point name="center" x="{step - 1}" y="0.4" z="{2 - 2 * step}"/><float name="radius" value="0.4"/>'
            f'<bsdf type="diffuse"><rgb name="reflectance" value="{0.8 - 0.3 * step} 0.3 {0.2 + 0.3 * step}"/></bsdf></shape>'
            for step in range(3)
        )
        + FLOOR
        + LAMP,
        "lens",
    ),
}


def scene(body, lens):
    kind = "thinlens" if lens else "perspective"
    more = number("aperture_radius", 0.25) + number("focus_distance", 7.0) if lens else ""
    return f"""<scene version="3.0.0"><integrator type="path"><integer name="max_depth" value="12"/></integrator>
    <sensor type="{kind}"><float name="fov" value="32"/>{more}
    {transform('<lookat origin="0, 3, 7" target="0, 0.8, 0" up="0, 1, 0"/>')}
    <sampler type="independent"><integer name="sample_count" value="{SAMPLES}"/></sampler>
    <film type="hdrfilm"><integer name="width" value="{WIDTH}"/><integer name="height" value="{HEIGHT}"/>
    <string name="pixel_format" value="rgb"/><rfilter type="box"/></film></sensor>{body}</scene>"""


def main():
    mitsuba.set_variant("scalar_rgb")
    form = mitsuba.Bitmap.PixelFormat.RGB, mitsuba.Struct.Type.Float32, False
    print("| scene | mean | blocks outside | equal |\n| --- | --- | --- | --- |")
    with tempfile.TemporaryDirectory() as folder:
        for name in sys.argv[1:] or SCENES:
            body, lens = SCENES[name]
            path, out = os.path.join(folder, f"{name}.xml"), os.path.join(folder, f"{name}.exr")
            with open(path, "w") as file:
                file.write(scene(body, lens))
            subprocess.run([os.environ["RTC"], "render", "-q", path, "-o", out], check=True)
            ours = numpy.array(mitsuba.Bitmap(out).convert(*form), float)
            loaded = mitsuba.load_file(path)
            theirs = numpy.stack([numpy.array(mitsuba.render(loaded, seed=seed), float)[:, :, :3] for seed in range(SEEDS)])
            result = public.difference(theirs, ours)
            both = numpy.hstack([ours, theirs[0]]).astype(numpy.float32)
            shown = mitsuba.Bitmap(both).convert(mitsuba.Bitmap.PixelFormat.RGB, mitsuba.Struct.Type.UInt8, True)
            shown.write(f"docs/book/src/pictures/beside-{name}.jpg", quality=90)
            equal = "yes" if result["equal"] else "no"
            print(f"| {name} | {100 * result['off']:+.2f} % | {100 * result['outside']:.1f} % | {equal} |", flush=True)


if __name__ == "__main__":
    main()
