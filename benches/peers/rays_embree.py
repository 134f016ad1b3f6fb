"""Rays through the globe by Embree, in the same batches as `rays.rs`, and with the same output;
also with all rays sorted before, in time that does not count, and in Embree's robust mode:
`rays_embree.py FOLDER SET…`. All CPU time counts."""

import json
import sys
import time

import numpy as np
from embreex import rtcore_scene
from embreex.mesh_construction import TriangleMesh

BATCH = 1 << 14


def in_order(rays):
    """By the octant of the direction, then by the cell of the origin along Morton's curve, then by
    direction."""
    origins, directions = rays[:, :3], rays[:, 3:]
    low, high = origins.min(0), origins.max(0)
    cells = ((origins - low) / np.maximum(high - low, 1e-9) * 15.999).astype(np.uint64)
    aims = ((directions + 1) / 2 * 15.999).astype(np.uint64)
    key = ((directions < 0) @ np.array([1, 2, 4])).astype(np.uint64)
    for numbers in (cells, aims):
        for bit in range(3, -1, -1):
            for axis in range(3):
                key = key << np.uint64(1) | numbers[:, axis] >> np.uint64(bit) & np.uint64(1)
    return rays[np.argsort(key, kind="stable")]


def measure(scene, work, rays, query):
    origins, directions = np.ascontiguousarray(rays[:, :3]), np.ascontiguousarray(rays[:, 3:])
    seconds, hits, total = 0.0, 0, 0.0
    for first in range(0, len(rays), BATCH):
        batch = origins[first : first + BATCH], directions[first : first + BATCH]
        start = time.process_time()
        found = scene.run(*batch, query=query)
        seconds += time.process_time() - start
        if query == "DISTANCE":
            hits += int((found < 1e30).sum())
            total += float(found[found < 1e30].sum(dtype=np.float64))
        else:
            hits += int((found == 0).sum())
    more = {"sum_t": total} if query == "DISTANCE" else {}
    print(json.dumps({"work": work, "cpu_s": seconds, "rays": len(rays), "hits": hits, **more}))


def main(folder, *sets):
    points = np.fromfile(f"{folder}/globe.vertices.f32", np.float32).reshape(-1, 3)
    corners = np.fromfile(f"{folder}/globe.corners.u32", np.uint32).reshape(-1, 3).astype(np.int32)
    first = np.array([[0, 0, 9]], np.float32), np.array([[0, 1, 0]], np.float32)
    for robust, suffix in ((False, ""), (True, " robust")):
        start = time.process_time()
        scene = rtcore_scene.EmbreeScene(robust=robust)
        TriangleMesh(scene, points, corners)
        scene.run(*first)  # The first ray commits the scene.
        print(json.dumps({"work": "build" + suffix, "cpu_s": time.process_time() - start}))
        for path in sets:
            name = path.split("/")[-1].removesuffix(".f32")
            rays = np.fromfile(path, np.float32).reshape(-1, 6)
            ordered = in_order(rays)
            for kind, query in (("closest", "DISTANCE"), ("any", "OCCLUDED")):
                measure(scene, f"{name} {kind}{suffix}", rays, query)
                if not robust:
                    measure(scene, f"{name} {kind} sorted", ordered, query)


if __name__ == "__main__":
    main(*sys.argv[1:])
