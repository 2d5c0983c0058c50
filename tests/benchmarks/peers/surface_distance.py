"""Measures cascading_upper_bounds of PyPI (Sacht and Jacobson 2024) on one thread, in CPU time; writes JSON.

usage: surface_distance.py FOLDER GAP. The folder holds `mesh` and `reference` as arrays
(tests/benchmarks/decimation/raw_mesh.h); the search ends when both ends of the distance are GAP apart.
"""

import json
import os
import sys
import time
from pathlib import Path

# One thread: what the library starts beside it shares its processor.
os.sched_setaffinity(0, {min(os.sched_getaffinity(0))})

import cascading_upper_bounds
import numpy


def read(folder):
    return (numpy.fromfile(folder / "vertices.f64").reshape(-1, 3),
            numpy.fromfile(folder / "triangles.u32", numpy.uint32).reshape(-1, 3).astype(numpy.int32))


def main():
    folder, gap = Path(sys.argv[1]), float(sys.argv[2])
    mesh, reference = read(folder / "mesh"), read(folder / "reference")
    # Its own messages go to the standard error.
    answer = os.dup(1)
    os.dup2(2, 1)
    before = time.process_time()
    lower, upper = cascading_upper_bounds.pompeiu_hausdorff(*mesh, *reference, tol=gap)[:2]
    seconds = time.process_time() - before
    os.write(answer, json.dumps({"lower": lower, "upper": upper, "seconds": seconds}).encode())


main()
