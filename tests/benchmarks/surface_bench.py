"""`./dev bench --surfaces`: the certified distance of one surface from another beside
cascading_upper_bounds of PyPI, in five minutes; writes the section "Distances of surfaces" of
docs/benchmarks.md.

The surfaces are bunny, fandisk and dragon with what `emax decimate` makes of them.
"""

import json
import statistics
import subprocess
import sys
from pathlib import Path

import sections
from decimation_bench import say

HERE = Path("tests/benchmarks")
PROGRAMS = Path("build/bench/bin")
FOLDER = Path("build/bench/surfaces")
CASES = [("bunny", "data/bunny00.off", 0.321), ("fandisk", "data/fandisk.off", 0.1), ("dragon", "data/dragon.ply", 0.2)]
# The greatest gap between the two ends of a distance, of epsilon: what a person reads, and nearly exact.
GAPS = [0.01, 0.0001]
ROUNDS = 5
AGREEMENT = 1e-9  # of the distance, beside the gaps


def run(*words):
    done = subprocess.run([str(word) for word in words], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    if done.returncode != 0:
        sys.exit(f"bench: {' '.join(map(str, words))} failed: {done.stderr[-500:]}")
    return done.stdout


def decimated(name, scan, percent):
    """The mesh and epsilon."""
    mesh, answer = FOLDER / f"{name}.ply", FOLDER / f"{name}.json"
    if not (mesh.exists() and answer.exists()):
        say(f"decimating {scan}")
        run(PROGRAMS / "emax", "decimate", scan, "--max-error", f"{percent}%", "-o", mesh, "--json", answer, "--quiet")
    return mesh, json.loads(answer.read_text())["epsilon"]


def agree(a, b):
    """Whether two proven intervals can hold the same distance."""
    slack = AGREEMENT * max(a["upper"], b["upper"])
    return a["lower"] <= b["upper"] + slack and b["lower"] <= a["upper"] + slack


def measure(mesh, reference, epsilon, gap, python):
    """The answers of both tools and the ratios of their times, round by round; and what a decision takes."""
    own, peer, decisions = [], [], []
    program, arrays = PROGRAMS / "emax_surface_distance_benchmark", FOLDER / "arrays"
    for part in ["mesh", "reference"]:
        (arrays / part).mkdir(parents=True, exist_ok=True)
    for _ in range(ROUNDS):
        own.append(json.loads(run(program, mesh, reference, "--gap", gap * epsilon, "--arrays", arrays)))
        peer.append(json.loads(run(python, "-B", HERE / "peers/surface_distance.py", arrays, gap * epsilon)))
        decisions.append(json.loads(run(program, mesh, reference, "--limit", epsilon))["seconds"])
    if not agree(own[0], peer[0]):
        sys.exit(f"bench: {mesh} from {reference}: emax finds {own[0]['lower']} to {own[0]['upper']}, cascading_upper_bounds "
                 f"{peer[0]['lower']} to {peer[0]['upper']}; find out which is wrong")
    return own, peer, decisions


def line(name, direction, epsilon, gap, own, peer, decisions):
    ratios = sorted(b["seconds"] / a["seconds"] for a, b in zip(own, peer))
    sizes = f"{own[0]['triangles']} from {own[0]['reference_triangles']}"
    seconds = [statistics.median(answer["seconds"] for answer in answers) for answers in (own, peer)]
    return (f"| {name}, {direction} | {sizes} | {gap:g} | {own[0]['upper'] / epsilon:.4f} | {seconds[0]:.3f} | {seconds[1]:.3f} | "
            f"{statistics.median(ratios):.2f} ({ratios[0]:.2f}–{ratios[-1]:.2f}) | {statistics.median(decisions):.3f} |")


def section(lines, version):
    return "\n".join([
        "## Distances of surfaces\n",
        "Written by `./dev bench --surfaces`: the greatest distance of any point of one surface, the insides of its triangles "
        "included, from another, as an interval with two proven ends. Both tools search until the ends are the given part of ε "
        "apart, on one thread, in processor time with the building of trees and without reading files; they take turns for "
        f"{ROUNDS} rounds, and the ratio is the median with the least and the greatest. The intervals of both must overlap, or "
        "the benchmark ends. Forth is the decimated surface from its reference, back the reference from the decimated surface. "
        "The last column is what a decimation asks, whether the distance is within ε; the peer has no such question. "
        f"cascading_upper_bounds {version} (Sacht and Jacobson 2024).\n",
        "| surfaces | triangles | gap, of ε | distance, of ε | emax, s | cascading_upper_bounds, s | of emax's time | only decided, s |",
        "|---|---:|---:|---:|---:|---:|---:|---:|", *lines, ""])


def main(python, fetch_dragon):
    if python is None:
        sys.exit("bench: cascading_upper_bounds could not be installed")
    fetch_dragon()
    FOLDER.mkdir(parents=True, exist_ok=True)
    lines = []
    for name, scan, percent in CASES:
        mesh, epsilon = decimated(name, scan, percent)
        for direction, of, to in [("forth", mesh, scan), ("back", scan, mesh)]:
            for gap in GAPS:
                lines.append(line(name, direction, epsilon, gap, *measure(of, to, epsilon, gap, python)))
                say(lines[-1])
    version = run(python, "-c", "from importlib.metadata import version; print(version('cascading_upper_bounds'))").strip()
    sections.put("surfaces", section(lines, version))
