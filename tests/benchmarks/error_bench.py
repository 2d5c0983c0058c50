"""`./dev bench --error`: `emax error` beside CloudCompare and MeshLab, as commands, in a minute; part of `./dev bench`,
whose meshes it takes.
"""

import json
import os
import re
import shutil
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import sections

HERE = Path("tests/benchmarks")
EMAX = Path("build/bench/bin/emax")
CASES = [("bunny-9k", Path("data/bunny00.off"), Path("build/bench/cases/bunny-quadric-9000.ply")),
         ("dragon-20k", Path("data/dragon.ply"), Path("build/bench/cases/dragon-quadric-20000.ply"))]
ROUNDS = 7
CLOUDCOMPARE, OFFSCREEN = ["CloudCompare", "-SILENT", "-AUTO_SAVE", "OFF"], {**os.environ, "QT_QPA_PLATFORM": "offscreen"}
TOLERANCE = 1e-5  # relative; peers compute in float


def emax(cloud, mesh, folder):
    answer = folder / "answer.json"
    subprocess.run([EMAX.resolve(), "error", cloud, mesh, "--json", answer], check=True, cwd=folder, capture_output=True)
    return json.loads(answer.read_text())["e_max"]


def cloudcompare(cloud, mesh, folder):
    said = subprocess.run([*CLOUDCOMPARE, "-O", cloud, "-O", mesh, "-C2M_DIST"], check=True, cwd=folder, env=OFFSCREEN,
                          capture_output=True, text=True).stdout
    if not re.search(r"Mean distance = \S+", said):
        raise RuntimeError("CloudCompare measured nothing:\n" + said)
    return None  # its command line tells the mean alone


def meshlab(python):
    def measure(cloud, mesh, folder):
        said = subprocess.run([python.absolute(), "-B", HERE.resolve() / "peers/meshlab.py", cloud, mesh], check=True, cwd=folder,
                              capture_output=True, text=True).stdout
        return json.loads(said)["max"]
    return measure


def timed(tool, cloud, mesh):
    with tempfile.TemporaryDirectory() as folder:
        before = time.perf_counter()
        answer = tool(cloud, mesh, Path(folder))
        return time.perf_counter() - before, answer


def version(package):
    said = subprocess.run(["dpkg-query", "-W", "-f", "${Version}", package], capture_output=True, text=True)
    return said.stdout or "not installed"


def measure(name, cloud, mesh, tools):
    """A line of the table for each tool; the tools take turns."""
    seconds, answers = {tool: [] for tool in tools}, {}
    for _ in range(ROUNDS):
        for tool, run in tools.items():
            took, answers[tool] = timed(run, cloud.resolve(), mesh.resolve())
            seconds[tool].append(took)
    own = answers["emax error"]
    for tool, answer in answers.items():
        if answer is not None and abs(answer - own) > TOLERANCE * own:
            raise RuntimeError(f"{name}: {tool} finds {answer}, emax error {own}")
    lines = []
    for tool, took in seconds.items():
        ratios = sorted(a / b for a, b in zip(took, seconds["emax error"]))
        told = "–" if answers[tool] is None else f"{answers[tool]:.6g}"
        lines.append(f"| {name} | {tool} | {told} | {statistics.median(took):.3f} | {statistics.median(ratios):.2f} "
                     f"({ratios[0]:.2f}–{ratios[-1]:.2f}) |")
    return lines


def main(python):
    for path in [mesh for _, _, mesh in CASES]:
        if not path.exists():
            sys.exit(f"bench: {path} is missing; `./dev bench` without options makes it")
    if python is None or not shutil.which("CloudCompare"):
        print("bench: MeshLab or CloudCompare is not installed; `emax error` is not measured beside them", flush=True)
        return
    tools = {"emax error": emax, "CloudCompare -C2M_DIST": cloudcompare, "MeshLab's Hausdorff distance": meshlab(python)}
    lines = []
    for name, cloud, mesh in CASES:
        lines += measure(name, cloud, mesh, tools)
    pymeshlab = subprocess.run([python, "-m", "pip", "show", "pymeshlab"], check=True, capture_output=True, text=True)
    sections.put("error", "\n".join([
        "## `emax error` beside other tools\n",
        "Written by `./dev bench --error`: the greatest distance of a cloud's points from a mesh. Wall time of the whole "
        "command, reading the files included. `emax error` also certifies the distance, checks the mesh and prints mean, "
        f"quantiles, histogram and worst points. The tools take turns for {ROUNDS} rounds; the time is the median, the ratio "
        f"to `emax error` the median with the least and the greatest. CloudCompare {version('cloudcompare')}, whose command line does not tell the maximum; "
        f"pymeshlab {re.search(r'Version: (.*)', pymeshlab.stdout)[1]}.\n",
        "| case | tool | maximum | s | of `emax error` |", "|---|---|---:|---:|---:|", *lines, ""]))
