"""`./dev bench --features`: planes found in scans beside CGAL's shape detection and PCL's RANSAC, in ten minutes; writes
the section "Planes" of docs/benchmarks.md.

The clouds are a hall whose planes are known, with outliers added, the corners of fandisk, and the scan of a building,
of which no truth is known.
"""

import json
import subprocess
import sys
from pathlib import Path

import sections
from decimation_bench import say

PROGRAMS = Path("build/bench/bin")
FOLDER = Path("build/bench/features")
TOOLS = {"emax": "emax, region growing", "emax-hough": "emax, Hough", "cgal-growing": "CGAL region growing",
         "cgal-ransac": "CGAL efficient RANSAC", "pcl-ransac": "PCL RANSAC, one by one"}
HALL_POINTS, HALL_NOISE, OUTLIERS = 10**6, 0.003, 0.05
LIMIT = 120  # seconds that a tool may take, with reading and the comparison with the truth


def run(*words, limit=None):
    """The standard output; None after `limit` seconds."""
    try:
        done = subprocess.run([str(word) for word in words], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
                              timeout=limit)
    except subprocess.TimeoutExpired:
        return None
    if done.returncode != 0:
        sys.exit(f"bench: {' '.join(map(str, words))} failed: {done.stderr[-500:]}")
    return done.stdout


def hall():
    cloud, truth = FOLDER / "hall.ply", FOLDER / "hall-truth.ply"
    if not (cloud.exists() and truth.exists()):
        run(PROGRAMS / "emax_scan", "hall", "--points", HALL_POINTS, "--noise", HALL_NOISE, "-o", cloud, "--truth", truth)
    return cloud, truth


def cases():
    """[(name, options of the program)]"""
    cloud, truth = hall()
    known = ["--max-error", 0.015, "--truth", truth, "--outliers", OUTLIERS]
    return [("hall, 500 points a plane", [cloud, *known, "--least-points", 500, "--least-known", 1000]),
            ("hall, 100 points a plane", [cloud, *known, "--least-points", 100, "--least-known", 200]),
            ("fandisk", ["data/fandisk.off", "--max-error", 0.005, "--truth", "data/fandisk.off", "--least-points", 30,
                         "--least-known", 60]),
            ("building", ["data/building.ply", "--max-error", 0.2, "--least-points", 500])]


def line(case, tool, told):
    if told is None:
        return f"| {case} | {TOOLS[tool]} | – | – | – | – | – | – | more than {LIMIT} |"
    share = 100 * told["points_of_planes"] / told["points"]
    if "known" in told:
        truth = (f"{told['found']} of {told['known']} | {told['wrong']} of {told['planes']} | "
                 f"{told['angle']['mean']:.3f}; {told['angle']['greatest']:.3f} | "
                 f"{told['offset']['mean'] / told['band']:.4f}; {told['offset']['greatest'] / told['band']:.4f}")
    else:
        truth = f"{told['planes']}, truth not known | – | – | –"
    return (f"| {case} | {TOOLS[tool]} | {truth} | {share:.1f} | {told['rms'] / told['band']:.3f} | {told['seconds']:.1f} |")


def section(lines):
    return "\n".join([
        "## Planes\n",
        "Written by `./dev bench --features`: planes that each tool finds in a cloud, on one thread. The time is that of the "
        "processor for all that a tool does with the points in memory: normals, trees, the search, planes of least squares. "
        "All tools get the same greatest distance ε of a point from its plane, the same least number of points, and 16 "
        "neighbours for normals; CGAL's permit 20 degrees between normals, as emax does, and its RANSAC looks for cylinders, "
        "too, as emax does. The hall has "
        f"{HALL_POINTS:.0e} points of stations among columns, stairs and pipes, {1000 * HALL_NOISE:.0f} mm of noise, "
        f"{100 * OUTLIERS:.0f} % more points anywhere in its box, ε = 15 mm. Known planes are those of the model's facets, "
        "equal ones merged, without the facets of curved surfaces. A known plane is found where a reported one has half of its "
        "points and half of that one's points are its own. A reported plane is wrong where no known plane has half of its points. "
        "Known planes count from twice as many points as a reported plane needs. Angles in degrees, offsets at the middle of the "
        "known plane and the rms in multiples of ε; means, then the greatest. fandisk is its mesh's corners, ε = 0.005; "
        "building.ply has ε = 0.2.\n",
        "| cloud | tool | planes found | wrong | angle | offset, of ε | % of the points | rms, of ε | s |",
        "|---|---|---:|---:|---:|---:|---:|---:|---:|", *lines, ""])


def main():
    FOLDER.mkdir(parents=True, exist_ok=True)
    lines = []
    for name, options in cases():
        for tool in TOOLS:
            told = run(PROGRAMS / "emax_features_benchmark", tool, *options, limit=LIMIT)
            lines.append(line(name, tool, told and json.loads(told)))
            say(lines[-1])
    sections.put("features", section(lines))
