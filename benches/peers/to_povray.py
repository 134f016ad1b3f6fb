"""A scene of the course for POV-Ray: `to_povray.py SCENE.yaml >SCENE.pov`: spheres, tori and planes of one colour each, point lights, a
camera. The sum over the lights that the course's ambient term is becomes one colour of POV-Ray's."""
import math
import sys

import yaml


def vector(numbers):
    return "<" + ", ".join(f"{number:.9g}" for number in numbers) + ">"


def finish(material, light):
    """Reflection stays what POV-Ray calls so: as much of the mirrored light as of the highlight."""
    ambient, ks = vector(material["ka"] * light[k] for k in range(3)), material["ks"]
    phong = f"phong {ks} phong_size {material['n']} reflection {ks}"
    return f"pigment {{ rgb {vector(material['color'])} }} finish {{ ambient {ambient} diffuse {material['kd']} {phong} }}"


def shape(record):
    if record["type"] == "sphere":
        return f"sphere {{ {vector(record['position'])}, {record['radius']}"
    if record["type"] == "torus":  # POV-Ray's stands on the y-axis.
        return f"torus {{ {record['radius']}, {record['alpha']} rotate x*90 translate {vector(record['position'])}"
    normal, center = record["N"], record["center"]
    return f"plane {{ {vector(normal)}, {sum(a * b for a, b in zip(normal, center)):.9g}"


def main(path):
    scene = yaml.safe_load(open(path))
    camera, lights = scene["Camera"], scene["Lights"]
    (eye, center, up), (width, height) = (camera[key] for key in ("eye", "center", "up")), camera["viewSize"]
    # A pixel is as high as `up` is long, at the distance of `center`; the view is along -z, as in all scenes here.
    angle = 2 * math.degrees(math.atan2(width / 2 * math.hypot(*up), math.dist(eye, center)))
    bounces = scene.get("MaxRecursionDepth", 0)
    print(f"#version 3.7;\nglobal_settings {{ assumed_gamma 1 ambient_light rgb 1 max_trace_level {bounces + 1} }}")
    print(f"camera {{ location {vector(eye)} direction -z up y right x*{width / height:.9g} angle {angle:.9g} }}")
    for light in lights:
        print(f"light_source {{ {vector(light['position'])}, rgb {vector(light['color'])} }}")
    total = [sum(light["color"][k] for light in lights) for k in range(3)]
    for record in scene["Objects"]:
        print(f"{shape(record)} {finish(record['material'], total)} }}")


if __name__ == "__main__":
    main(*sys.argv[1:])
