"""`./dev bench --features`: planes found in scans beside CGAL's shape detection and PCL's RANSAC, and what decimation
makes of them, in forty minutes; writes the section "Planes" of docs/benchmarks.md.

The clouds are a hall whose planes are known, with outliers added, the corners of fandisk, and the scan of a building,
of which no truth is known. What is measured is kept in build/bench/features: remove it to measure again.
"""

import json
import resource
import signal
import subprocess
import sys
from pathlib import Path

import sections
from decimation_bench import Store, say

PROGRAMS = Path("build/bench/bin")
FOLDER = Path("build/bench/features")
TOOLS = {"emax": "emax, region growing", "emax-hough": "emax, Hough", "cgal-growing": "CGAL region growing",
         "cgal-ransac": "CGAL efficient RANSAC", "pcl-ransac": "PCL RANSAC, one by one"}
HALL_POINTS, HALL_NOISE, OUTLIERS = 10**6, 0.003, 0.05
LIMIT = 60  # seconds of the processor that a tool may take, with reading and the comparison with the truth
SMALL_HALL_POINTS = 200_000  # for decimation
MIXED_PIXELS = 0.002  # share of its points that lie between two surfaces
CHOICES = {"none": [], "planes, holes open": ["--features", "planes", "--hole-reach", "none"],
           "planes": ["--features", "planes"], "all": ["--features", "all"],
           "auto": ["--features", "auto"]}
WIDE = "planes, 2 m closed"
CHOICES_OF_HALL = {**CHOICES, WIDE: ["--features", "planes", "--hole-reach", "2"]}


def run(*words, limit=None):
    """The standard output; None after `limit` seconds of the processor."""
    def limited():
        resource.setrlimit(resource.RLIMIT_CPU, (limit, limit))
    done = subprocess.run([str(word) for word in words], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
                          preexec_fn=limited if limit else None)
    if limit and done.returncode in (-signal.SIGXCPU, -signal.SIGKILL):
        return None
    if done.returncode != 0:
        sys.exit(f"bench: {' '.join(map(str, words))} failed: {done.stderr[-500:]}")
    return done.stdout


def hall(name="hall", points=HALL_POINTS):
    cloud, truth = FOLDER / f"{name}.ply", FOLDER / f"{name}-truth.ply"
    if not (cloud.exists() and truth.exists()):
        run(PROGRAMS / "emax_scan", "hall", "--points", points, "--noise", HALL_NOISE, "-o", cloud, "--truth", truth)
    return cloud, truth


def cases():
    """[(name, options of the program)]"""
    cloud, truth = hall()
    known = ["--max-error", 0.015, "--truth", truth, "--outliers", OUTLIERS]
    return [("hall, 500 points a plane", [cloud, *known, "--least-points", 500, "--least-known", 1000]),
            ("hall, 100 points a plane", [cloud, *known, "--least-points", 100, "--least-known", 200]),
            ("fandisk", ["data/fandisk.off", "--max-error", 0.005, "--truth", "data/fandisk.off", "--flatness", 1e-4,
                         "--least-points", 30, "--least-known", 60]),
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


def surface(name, cloud, method="gp3"):
    mesh = FOLDER / f"{name}-{method}.ply"
    if not mesh.exists():
        run(PROGRAMS / "emax", "reconstruct", cloud, "--method", method, "-o", mesh, "--quiet")
    return mesh


def decimations():
    """[(name, mesh, cloud, epsilon in units, effort, truth or None for the meeting lines of planes, choices, options)]"""
    cloud, truth = hall("small-hall", SMALL_HALL_POINTS)
    fandisk, building = "data/fandisk.off", "data/building.ply"
    every, excluded = list(CHOICES), ["--exclude-outliers", f"{MIXED_PIXELS:%}"]
    large, _ = hall()
    return [("building, 0.5 %", surface("building", building), building, 0.274189, "normal", None, every, []),
            ("hall, 50 mm", surface("small-hall", cloud), cloud, 0.05, "quick", truth, every, []),
            ("hall from its shapes, 15 mm", surface("small-hall", cloud, "shapes"), cloud, 0.015, "normal", truth,
             ["none", "planes", "all", WIDE], excluded),
            ("hall of 10^6 points from its shapes, 15 mm", surface("hall", large, "shapes"), large, 0.015, "quick", truth,
             ["planes", WIDE], excluded),
            ("the hall's model, 15 mm", truth, truth, 0.015, "normal", truth, ["none"], []),
            ("fandisk, 0.5 %", fandisk, fandisk, 0.005, "normal", fandisk, every, []),
            ("fandisk, 0.1 %", fandisk, fandisk, 0.001, "normal", fandisk, every, [])]


def decimate(mesh, cloud, epsilon, effort, truth, choice, options):
    out, told = FOLDER / "out.ply", FOLDER / "out.json"
    given = [] if mesh == cloud else ["--cloud", cloud]
    (FOLDER / "out.ply.reference.ply").unlink(missing_ok=True)
    run(PROGRAMS / "emax", "decimate", mesh, *given, "--max-error", epsilon, "--effort", effort,
        *CHOICES_OF_HALL[choice], *options, "-o", out, "--json", told, "--quiet")
    result = json.loads(told.read_text())
    made = {"triangles": result["triangles"], "borders": result["topology"]["border_loops"]}
    written = FOLDER / "out.ply.reference.ply"
    compared = ["edges", "--truth", truth] if truth else [
        "meeting", "--least-points", 100, "--truth", written if written.exists() else mesh]
    tool, *known = compared
    made["edges"] = json.loads(run(PROGRAMS / "emax_features_benchmark", tool, cloud, "--max-error", epsilon, *known,
                                   "--mesh", out))
    return made


def decimated_line(case, effort, choice, made):
    edges = "– | – | –"
    if "edges" in made:
        e = made["edges"]
        edges = f"{e['mean'] / e['band']:.2f} | {e['p95'] / e['band']:.2f} | {100 * e['within_half']:.0f}"
    return f"| {case}, {effort} | {choice} | {made['triangles']} | {made['borders']} | {edges} |"


def section(lines, decimated):
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
        "|---|---|---:|---:|---:|---:|---:|---:|---:|", *lines, "",
        "What `emax decimate --features` makes of them, two-sided: building.ply and a hall of "
        f"{SMALL_HALL_POINTS} points, both by their greedy projections, and fandisk; with the effort that is named. The hall "
        f"is also made by `reconstruct --method shapes`, {MIXED_PIXELS:.1%} of its points excluded, and beside it stands the "
        "model that it was scanned from. Planes "
        "with holes open is `--hole-reach none`, with 2 m closed `--hole-reach 2m`: the scanner sees nothing of the floor below "
        "itself. A true edge turns by more than 40 degrees in the model and has a point of the "
        "scan within ε; its distance is that from the nearest edge of the result that turns by more than 20, as mean and of "
        "95 %, in multiples of ε, and the share of those within ε/2. Of building.ply no truth is known; there the lines count "
        "where two planes of the scan meet at more than 40 degrees, with points of both within 2 ε and the reference within "
        "ε.\n",
        "| mesh | features | triangles | borders | edges, of ε | 95 % | within ε/2, % |",
        "|---|---|---:|---:|---:|---:|---:|", *decimated, ""])


def main():
    FOLDER.mkdir(parents=True, exist_ok=True)
    store = Store(FOLDER / "results.jsonl")
    lines, decimated = [], []
    for name, mesh, cloud, epsilon, effort, truth, choices, options in decimations():
        for choice in choices:
            key = name, effort, choice
            if not store.get(*key):
                store.put(key, decimate(mesh, cloud, epsilon, effort, truth, choice, options))
            decimated.append(decimated_line(name, effort, choice, store.get(*key)))
            say(decimated[-1])
    for name, options in cases():
        for tool in TOOLS:
            if not store.get(name, tool):
                told = run(PROGRAMS / "emax_features_benchmark", tool, *options, limit=LIMIT)
                store.put((name, tool), json.loads(told) if told else {"late": True})
            told = store.get(name, tool)
            lines.append(line(name, tool, None if "late" in told else told))
            say(lines[-1])
    sections.put("features", section(lines, decimated))
