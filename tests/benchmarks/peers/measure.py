"""Measures FCPW and Open3D once on every case folder named, one thread, in CPU time; writes JSON.

A case folder holds points.f32, vertices.f32 and triangles.i32 of three to a row. Both give every
point's distance; the time of a case is to build the tree and to query all points.
"""

import argparse
import json
import os
import time
from importlib.metadata import version
from pathlib import Path

# One thread: what the libraries start beside it shares its processor.
os.sched_setaffinity(0, {min(os.sched_getaffinity(0))})
for name in ["OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "TBB_NUM_THREADS"]:
    os.environ[name] = "1"

import numpy

LEAST_SECONDS = 0.1


class Fcpw:
    def __init__(self, points, vertices, triangles):
        import fcpw
        self.library = fcpw
        self.points, self.vertices, self.triangles = points, vertices, triangles
        self.radii = numpy.full(len(points), numpy.inf, numpy.float32)
        kinds = fcpw.aggregate_type
        self.modes = [kinds.bvh_surface_area, kinds.bvh_overlap_surface_area, kinds.bvh_longest_axis_center]

    def run(self, mode):
        scene = self.library.scene_3D()
        scene.set_object_count(1)
        scene.set_object_vertices(self.vertices, 0)
        scene.set_object_triangles(self.triangles, 0)
        scene.build(mode, True)
        self.found = self.library.interaction_3D_list()
        scene.find_closest_points(self.points, self.radii, self.found)

    def e_max(self):
        return max(self.found[i].d for i in range(len(self.points)))


class Open3d:
    def __init__(self, points, vertices, triangles):
        import open3d
        self.library = open3d
        tensor = open3d.core.Tensor.from_numpy
        self.points, self.vertices = tensor(points), tensor(vertices)
        self.triangles = tensor(triangles.astype(numpy.uint32))
        self.modes = [None]

    def run(self, mode):
        scene = self.library.t.geometry.RaycastingScene(nthreads=1)
        scene.add_triangles(self.vertices, self.triangles)
        self.distances = scene.compute_distance(self.points, nthreads=1)

    def e_max(self):
        return float(self.distances.numpy().max())


PEERS = {"fcpw": (Fcpw, "fcpw"), "open3d": (Open3d, "open3d-cpu")}


def read(folder):
    files = [("points.f32", numpy.float32), ("vertices.f32", numpy.float32), ("triangles.i32", numpy.int32)]
    return [numpy.fromfile(folder / name, kind).reshape(-1, 3) for name, kind in files]


def seconds(peer, mode):
    times = 0
    start = time.process_time()
    while True:
        peer.run(mode)
        times += 1
        spent = time.process_time() - start
        if spent >= LEAST_SECONDS:
            return spent / times


def measure(kind, arrays):
    """The peer's best mode; its e_max is the same in all of them."""
    try:
        peer = kind(*arrays)
        best = min(seconds(peer, mode) for mode in peer.modes)
        return {"seconds": best, "e_max": float(peer.e_max())}
    except Exception as error:  # whatever a package cannot do is said in the table
        return {"failure": " ".join(str(error).split())[:100]}


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--output", type=Path, required=True)
    parser.add_argument("cases", type=Path, nargs="+")
    arguments = parser.parse_args()
    results = {"versions": ", ".join(f"{package} {version(package)}" for _, package in PEERS.values()), "cases": {}}
    for case in arguments.cases:
        arrays = read(case)
        results["cases"][case.name] = {name: measure(kind, arrays) for name, (kind, _) in PEERS.items()}
    arguments.output.write_text(json.dumps(results))


if __name__ == "__main__":
    main()
