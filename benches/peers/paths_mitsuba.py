"""A picture of a scene that rtc wrote, by Mitsuba's `scalar_rgb`, on one thread: `paths_mitsuba.py SCENE.xml SAMPLES SEED OUT SAMPLER`.
OUT has the pixels as `paths.rs` writes them. A line of JSON has the CPU-seconds of rendering and of the whole process."""
import json
import resource
import sys
import time

import drjit
import mitsuba
import numpy as np

mitsuba.set_variant("scalar_rgb")


def main(path, samples, seed, out, sampler):
    drjit.set_thread_count(1)
    made = mitsuba.load_file(path, sampler=sampler, spp=samples)
    start, clock = time.process_time(), time.perf_counter()
    picture = mitsuba.render(made, spp=int(samples), seed=int(seed))
    seconds, clock = time.process_time() - start, time.perf_counter() - clock
    np.array(picture, np.float32)[:, :, :3].tofile(out)
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
    row = {"render_s": clock, "render_cpu_s": seconds, "process_cpu_s": time.process_time(), "peak_mb": peak}
    print(json.dumps(row))


if __name__ == "__main__":
    main(*sys.argv[1:])
