"""Pictures of a set-up by Cycles, on one thread: `paths_cycles.py SETUP.json SAMPLES` reads lines
`SEED OUT` and answers each, once OUT is written, by a line of JSON, after `READY `. OUT has the
pixels as `paths.rs` writes them.

As near to rtc as Cycles goes: single scattering in all microfacets, exact absorption, a box filter,
no clamping, no denoiser, no adaptive sampling, no light left out. Scenes are prepared anew for each
picture; the seconds are of sampling alone."""

import json
import math
import os
import re
import resource
import sys
import tempfile
import time

import bpy
import numpy as np
from mathutils import Matrix, Vector


def upright(v):
    """From y up, as glTF has it, to z up."""
    return Vector((v[0], -v[2], v[1]))


def put_camera(scene, camera):
    lens = bpy.data.cameras.new("camera")
    thing = bpy.data.objects.new("camera", lens)
    scene.collection.objects.link(thing)
    scene.camera = thing
    eye, center, up = (upright(camera[key]) for key in ("position", "look_at", "up"))
    back = (eye - center).normalized()
    right = up.cross(back).normalized()
    thing.matrix_world = Matrix((*zip(right, back.cross(right), back, eye), (0, 0, 0, 1)))
    lens.sensor_fit, lens.lens_unit, lens.angle = (
        "VERTICAL",
        "FOV",
        math.radians(camera["yfov_deg"]),
    )
    lens.clip_start, lens.clip_end = 1e-3, 1e6


def put_lights(scene, lights):
    world = bpy.data.worlds.new("world")
    scene.world, world.use_nodes = world, True
    world.node_tree.nodes["Background"].inputs["Color"].default_value = (*lights["env_radiance"], 1)
    for sun in lights["suns"]:
        light = bpy.data.lights.new("sun", "SUN")
        light.energy, light.angle = max(sun["irradiance"]), 0
        light.color = [part / light.energy for part in sun["irradiance"]]
        thing = bpy.data.objects.new("sun", light)
        scene.collection.objects.link(thing)
        thing.rotation_mode = "QUATERNION"
        thing.rotation_quaternion = upright(sun["direction_to_light"]).to_track_quat("Z", "Y")


def set_materials():
    for material in bpy.data.materials:
        for node in material.node_tree.nodes if material.node_tree else []:
            if hasattr(node, "distribution"):
                node.distribution = "GGX"
            if (
                node.bl_idname == "ShaderNodeVolumeAbsorption"
            ):  # The importer takes 1 - c for -ln c.
                color, density = (
                    node.inputs["Color"].default_value,
                    node.inputs["Density"].default_value,
                )
                sigma = [-math.log(max(part, 1e-6)) * density for part in color[:3]]
                most = max(*sigma, 1e-9)
                node.inputs["Density"].default_value = most
                node.inputs["Color"].default_value = [1 - part / most for part in sigma] + [1]


def set_cycles(scene, set_up, samples):
    render, cycles = scene.render, scene.cycles
    render.engine, cycles.device, cycles.samples = "CYCLES", "CPU", samples
    cycles.use_adaptive_sampling = cycles.use_denoising = cycles.use_auto_tile = (
        cycles.use_fast_gi
    ) = False
    cycles.sample_clamp_direct = cycles.sample_clamp_indirect = cycles.blur_glossy = (
        cycles.light_sampling_threshold
    ) = 0
    cycles.caustics_reflective = cycles.caustics_refractive = True
    for kind in ("max", "diffuse", "glossy", "transmission"):
        setattr(cycles, f"{kind}_bounces", set_up["max_bounces"])
    cycles.volume_bounces, cycles.transparent_max_bounces, cycles.pixel_filter_type = 0, 256, "BOX"
    render.threads_mode, render.threads, render.use_persistent_data = "FIXED", 1, False
    render.resolution_x, render.resolution_y, render.resolution_percentage = (
        set_up["width"],
        set_up["height"],
        100,
    )
    settings = render.image_settings
    settings.file_format, settings.color_mode, settings.color_depth = "OPEN_EXR", "RGB", "32"


def load(path, samples):
    set_up = json.load(open(path))
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.ops.import_scene.gltf(
        filepath=os.path.join(os.path.dirname(os.path.abspath(path)), set_up["asset"])
    )
    for thing in list(bpy.data.objects):
        thing.animation_data_clear()
        if thing.type in ("CAMERA", "LIGHT"):
            bpy.data.objects.remove(thing)
    scene = bpy.context.scene
    put_camera(scene, set_up["camera"])
    put_lights(scene, set_up["lights"])
    set_materials()
    set_cycles(scene, set_up, samples)
    return scene


def render(scene, seed, out, log):
    """The seconds of the whole, and those from before the first sample to the last, by Blender's
    own clock, to a hundredth."""
    scene.cycles.seed = seed
    scene.render.filepath = out + ".exr"
    log.seek(0)
    log.truncate()
    start, cpu = time.perf_counter(), time.process_time()
    bpy.ops.render.render(write_still=True)
    whole, cpu = time.perf_counter() - start, time.process_time() - cpu
    told = open(log.name).read()
    stamps = re.findall(r"Time:(?:(\d+):)?(\d+):(\d+\.\d+).*Sample \d", told)
    sampled = [
        int(hours or 0) * 3600 + int(minutes) * 60 + float(seconds)
        for hours, minutes, seconds in stamps
    ]
    picture = bpy.data.images.load(out + ".exr")
    picture.colorspace_settings.name = "Non-Color"
    pixels = np.array(picture.pixels[:], np.float32).reshape(*reversed(picture.size), 4)
    bpy.data.images.remove(picture)
    os.remove(out + ".exr")
    pixels[::-1, :, :3].tofile(out)
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
    told_s = (
        sampled[-1] - sampled[0] if sampled else None
    )  # Only some versions of Blender tell of samples.
    return {"render_s": told_s, "whole_s": whole, "whole_cpu_s": cpu, "peak_mb": peak}


def main(path, samples):
    # Blender writes to its output as it likes: that goes to a file, and answers to where the output
    # was.
    answers = os.fdopen(os.dup(1), "w")
    with tempfile.NamedTemporaryFile("w+") as log:
        os.dup2(log.fileno(), 1)
        scene = load(path, int(samples))
        print("READY", file=answers, flush=True)
        for line in sys.stdin:
            seed, out = line.split()
            print(
                json.dumps(render(scene, int(seed), os.path.abspath(out), log)),
                file=answers,
                flush=True,
            )


if __name__ == "__main__":
    main(*sys.argv[1:])
