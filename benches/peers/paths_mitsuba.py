"""A picture of a scene that rtc wrote, by Mitsuba on one thread: `paths_mitsuba.py SCENE.xml
SAMPLES SEED OUT SAMPLER [VARIANT]`, where VARIANT is `scalar_rgb` or `llvm_ad_rgb`, which needs
LLVM (`DRJIT_LIBLLVM_PATH`). OUT has the pixels as `paths.rs` writes them. A line of JSON has the
CPU-seconds of rendering and of the whole process."""

import json
import resource
import sys
import time

import drjit
import mitsuba
import numpy as np


def main(path, samples, seed, out, sampler, variant="scalar_rgb"):
    mitsuba.set_variant(variant)
    drjit.set_thread_count(1)
    made = mitsuba.load_file(path, sampler=sampler, spp=samples)
    start, clock = time.process_time(), time.perf_counter()
    picture = np.array(mitsuba.render(made, spp=int(samples), seed=int(seed)), np.float32)
    seconds, clock = time.process_time() - start, time.perf_counter() - clock
    picture[:, :, :3].tofile(out)
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
    row = {
        "render_s": clock,
        "render_cpu_s": seconds,
        "process_cpu_s": time.process_time(),
        "peak_mb": peak,
    }
    print(json.dumps(row))


if __name__ == "__main__":
    main(*sys.argv[1:])
