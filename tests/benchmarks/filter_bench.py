"""`./dev bench --filter`: the points that the fixed-point filter leaves to the kernel, on the bunny decimated at 0.2 % of
its width, in some minutes; writes the section "The fixed-point filter" of docs/benchmarks.md.
"""

import json
import subprocess
import sys
from pathlib import Path

import sections

PROGRAMS = Path("build/bench/bin")
CLOUD = Path("data/bunny00.off")
MESH = Path("build/bench/filter_bunny.ply")


def run(*words):
    done = subprocess.run([str(word) for word in words], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    if done.returncode != 0:
        sys.exit(f"bench: {' '.join(map(str, words))} failed: {done.stderr[-500:]}")
    return done.stdout


def line(row):
    return (f"| {row['bits']} | 2^{2 - row['bits'] - row['exponent']} | {row['points_left']} | {row['triangles_without']} "
            f"| {row['greatest_too_small']:.2f} | {row['greatest_too_large']:.2f} | {row['greatest_bound']:.2f} |\n")


def body(result):
    return ("## The fixed-point filter\n\n"
            f"Written by `./dev bench --filter`: the {result['points']} vertices of the bunny and its mesh decimated at 0.2 % of the "
            f"width, {result['triangles']} triangles, every pair. Each width gave brute force's answer. A point that is left meets the "
            "kernel with all triangles. Errors are those of a point's minimum beside the kernel's, in steps of the filter; the greatest "
            "bound is what is proven of the filter's being too small ([numerics](numerics.md#the-fixed-point-filter)).\n\n"
            "| bits | step, normalised | points left | triangles that do not fit | greatest too small | greatest too large | greatest bound |\n"
            "|---:|---:|---:|---:|---:|---:|---:|\n" + "".join(line(row) for row in result["rows"]))


def main():
    run(PROGRAMS / "emax", "decimate", CLOUD, "--max-error", "0.2%", "-o", MESH)
    result = json.loads(run(PROGRAMS / "emax_filter_benchmark", CLOUD, MESH))
    sections.put("filter", body(result))
