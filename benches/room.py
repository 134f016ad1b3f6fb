"""A room with a relief of millions of triangles in Mitsuba's XML: CPU seconds and memory from the start to a picture of one pixel, by
rtc and by Mitsuba (`scalar_rgb`), with one thread. `room.py [SIDE ...]`: reliefs of 2·SIDE² triangles. Needs Mitsuba's wheel; RTC is
the program. Prints a table."""
import os
import struct
import subprocess
import sys
import tempfile

SCENE = """<scene version="3.0.0"><integrator type="path"><integer name="max_depth" value="3"/></integrator>
<sensor type="perspective"><float name="fov" value="50"/>
<transform name="to_world"><lookat origin="0.5, -0.9, 0.8" target="0.5, 0.5, 0" up="0, 0, 1"/></transform>
<sampler type="independent"><integer name="sample_count" value="1"/></sampler>
<film type="hdrfilm"><integer name="width" value="1"/><integer name="height" value="1"/><rfilter type="box"/></film></sensor>
<bsdf type="twosided" id="wall"><bsdf type="diffuse"/></bsdf>
<shape type="ply"><string name="filename" value="relief.ply"/><ref id="wall"/></shape>
<shape type="cube"><transform name="to_world"><scale value="2"/></transform><ref id="wall"/></shape>
<emitter type="point"><point name="position" x="0.5" y="0.5" z="1"/><rgb name="intensity" value="1"/></emitter></scene>"""


def relief(path, side):
    """Writes a binary PLY whose heights are pseudo-random."""
    seed = 1
    with open(path, "wb") as file:
        head = f"ply\nformat binary_little_endian 1.0\nelement vertex {(side + 1) ** 2}\nproperty float x\nproperty float y\nproperty float z\n"
        file.write(f"{head}element face {2 * side * side}\nproperty list uchar int vertex_indices\nend_header\n".encode())
        rows = []
        for y in range(side + 1):
            for x in range(side + 1):
                seed = seed * 1103515245 + 12345 & 0x7FFFFFFF
                rows.append(struct.pack("<3f", x / side, y / side, seed / 2**31 * 0.5 / side))
        file.write(b"".join(rows))
        faces = []
        for y in range(side):
            for x in range(side):
                a = y * (side + 1) + x
                faces.append(struct.pack("<BiiiBiii", 3, a, a + 1, a + side + 1, 3, a + 1, a + side + 2, a + side + 1))
        file.write(b"".join(faces))


def measured(*command):
    """The CPU seconds and the MiB at the peak of a command with one thread."""
    program = (
        "import os, resource, subprocess, sys; subprocess.run(sys.argv[1:], check=True, stdout=subprocess.DEVNULL);"
        "used = resource.getrusage(resource.RUSAGE_CHILDREN); print(used.ru_utime + used.ru_stime, used.ru_maxrss / 1024)"
    )
    one = os.environ | {"RAYON_NUM_THREADS": "1"}
    done = subprocess.run([sys.executable, "-c", program, *command], env=one, check=True, capture_output=True, text=True)
    return [float(word) for word in done.stdout.split()]


def by_mitsuba(path):
    import drjit
    import mitsuba

    drjit.set_thread_count(1)
    mitsuba.set_variant("scalar_rgb")
    mitsuba.render(mitsuba.load_file(path))


def main(sides):
    print("| triangles | rtc, s | rtc, MiB | Mitsuba, s | Mitsuba, MiB |\n| ---: | ---: | ---: | ---: | ---: |")
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "scene.xml")
        with open(path, "w") as file:
            file.write(SCENE)
        for side in sides:
            relief(os.path.join(folder, "relief.ply"), side)
            ours = measured(os.environ["RTC"], "render", "-q", path, "-o", os.path.join(folder, "room.exr"))
            theirs = measured(sys.executable, __file__, "mitsuba", path)
            cells = [f"{2 * side * side}", f"{ours[0]:.2f}", f"{ours[1]:.0f}", f"{theirs[0]:.2f}", f"{theirs[1]:.0f}"]
            print(f"| {' | '.join(cells)} |", flush=True)


if __name__ == "__main__":
    if sys.argv[1:2] == ["mitsuba"]:
        by_mitsuba(sys.argv[2])
    else:
        main([int(side) for side in sys.argv[1:]] or [10, 1000, 2000])
