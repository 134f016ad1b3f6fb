"""A picture of a set-up by Mitsuba's `scalar_rgb`, on one thread: `paths_mitsuba.py SETUP.json SAMPLES SEED OUT SAMPLER`. OUT has
the pixels as `paths.rs` writes them. A line of JSON has the CPU-seconds of rendering and of the whole process."""
import json
import math
import os
import resource
import sys
import time

import drjit
import mitsuba
import numpy as np

mitsuba.set_variant("scalar_rgb")


def rgb(numbers):
    return {"type": "rgb", "value": list(numbers)}


def scene(path, samples, sampler):
    """Meshes by material, the sky, the suns, the camera; a path of n bounces has n + 1 edges after the first."""
    set_up, folder = json.load(open(path)), os.path.dirname(path)
    camera, lights = set_up["camera"], set_up["lights"]
    view = mitsuba.ScalarTransform4f().look_at(camera["position"], camera["look_at"], camera["up"])
    film = {"type": "hdrfilm", "width": set_up["width"], "height": set_up["height"], "rfilter": {"type": "box"}}
    film |= {"pixel_format": "rgb", "component_format": "float32"}
    sensor = {"type": "perspective", "to_world": view, "fov": camera["yfov_deg"], "fov_axis": "y", "film": film}
    sensor["sampler"] = {"type": sampler, "sample_count": samples}
    parts = {"type": "scene", "integrator": {"type": "path", "max_depth": set_up["max_bounces"] + 1}, "sensor": sensor}
    parts["sky"] = {"type": "constant", "radiance": rgb(lights["env_radiance"])}
    for k, sun in enumerate(lights["suns"]):
        away = [-x for x in sun["direction_to_light"]]
        parts[f"sun{k}"] = {"type": "directional", "direction": away, "irradiance": rgb(sun["irradiance"])}
    for k, mesh in enumerate(set_up["meshes"]):
        lambert = {"type": "twosided", "bsdf": {"type": "diffuse", "reflectance": rgb(mesh["reflectance"])}}
        ply = {"type": "ply", "filename": os.path.join(folder, mesh["ply"]), "face_normals": True, "bsdf": lambert}
        parts[f"mesh{k}"] = ply
    return mitsuba.load_dict(parts)


def main(path, samples, seed, out, sampler):
    drjit.set_thread_count(1)
    made = scene(path, int(samples), sampler)
    start, clock = time.process_time(), time.perf_counter()
    picture = mitsuba.render(made, spp=int(samples), seed=int(seed))
    seconds, clock = time.process_time() - start, time.perf_counter() - clock
    np.array(picture, np.float32)[:, :, :3].tofile(out)
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
    row = {"render_s": clock, "render_cpu_s": seconds, "process_cpu_s": time.process_time(), "peak_mb": peak}
    print(json.dumps(row))


if __name__ == "__main__":
    main(*sys.argv[1:])
