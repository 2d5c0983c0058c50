"""`./dev bench --scale`: time and memory of clouds of 10^5 to 10^9 points; writes the section "Scale" of
docs/benchmarks.md.

The scans are of the generator's hall, whose surface is known. Each result is kept in
build/bench/scale/, so that a measurement can be interrupted and continued; --fresh begins anew,
--most N leaves larger clouds out (1e8: the one of 10^9 points, which is never stored), --only-write
writes from what is there. All of it takes two and a half hours of two cores and 12 GB of disk.
"""

import argparse
import json
import math
import os
import shutil
import statistics
import subprocess
import sys
import time
from pathlib import Path

import decimation_bench
import error_bench
import sections
from decimation_bench import say

PROGRAMS = Path("build/bench/bin")
FOLDER = Path("build/bench/scale")
RECONSTRUCTED, MEASURED = [10**5, 10**6, 10**7], [10**6, 10**7, 10**8]
BESIDE = [10**7, 10**8]  # of these, also by CloudCompare
OPTIMIZED = [10**5, 10**6, 10**7, 3 * 10**7]
EXTRAPOLATED, FITTED = 10**8, 3  # points of `optimize`, from the last so many sizes
STAGES = {"normals": "normals, oriented along the spanning tree", "holes": "holes closed, one for each hundred points",
          "far": "far points joined, one of a hundred"}
STAGED = [10**5, 10**6, 10**7]
TOLERANCE, OUTLIERS = "5mm", "3%"  # of the hall, whose edges have mixed pixels
STREAMED = [10**9]  # measured as they are drawn, and never stored
MEMORY, OPTIMIZE_MEMORY = "1GB", "2GB"
MESH_POINTS = 10**6  # of whose surface clouds are measured from, in cubes so coarse that it has about 10^6 triangles
MESH_CUBES = 2
DRAGON, PERCENT, TILE = Path("data/dragon.ply"), 0.2, 250000
HALL_OUTLIERS = "4%"  # as a whole, fewer points can be joined
# A surface of the hall as `optimize --tiles` makes it for its tolerance.
TILED_HALL, HALL_SURFACE = 2 * 10**6, ["--method", "imls", "--thin", "2.5mm", "--simplify", "0.625mm", "--set", "imls.cell=2"]


class Store(decimation_bench.Store):
    """The results of this benchmark, each told when it is known."""

    def __init__(self, folder):
        super().__init__(folder / "results.jsonl")

    def put(self, key, result):
        super().put(key, result)
        say(f"{' '.join(map(str, key))}: {result['seconds']:.0f} s, {result['bytes'] / 1e6:.0f} MB")


def wait(process, begun, awaited):
    """What the process used, and after how many seconds the awaited file was there."""
    first = None
    while True:
        ended, status, used = os.wait4(process.pid, os.WNOHANG if awaited else 0)
        if awaited and first is None and awaited.exists():
            first = time.monotonic() - begun
        if ended:
            process.returncode = os.waitstatus_to_exitcode(status)  # wait4 has taken it
            return used, first
        time.sleep(0.1)


def run(words, given=None, awaited=None):
    """Wall time and processor time, the greatest resident size of a process, as the system counts them, and the JSON;
    with a file that is awaited also when that was there."""
    answer = FOLDER / "answer.json"
    begun = time.monotonic()
    process = subprocess.Popen([str(word) for word in words] + ["--quiet", "--json", str(answer)], stdin=given)
    used, first = wait(process, begun, awaited)
    if process.returncode not in (0, 2):  # 2: the tolerance is exceeded
        sys.exit(f"bench: {' '.join(map(str, words))} failed")
    return {"seconds": time.monotonic() - begun, "processor": used.ru_utime + used.ru_stime,
            "bytes": 1024 * used.ru_maxrss, "answer": json.loads(answer.read_text())} | ({"first": first} if awaited else {})


def scan(points):
    file, truth = FOLDER / f"hall-{points}.las", FOLDER / "truth.ply"
    if not file.exists() or not truth.exists():
        say(f"drawing {points} points")
        partial = FOLDER / "partial.las"
        subprocess.run([PROGRAMS / "emax_scan", "hall", "--points", str(points), "-o", partial, "--truth", truth],
                       check=True, stderr=subprocess.DEVNULL)
        os.replace(partial, file)
    return file


def surface(points):
    return FOLDER / f"surface-{points}.ply"


def truth_of(mesh):
    truth = run([PROGRAMS / "emax", "error", mesh, FOLDER / "truth.ply"])["answer"]["errors"]["cloud_to_mesh"]
    return {"rms": truth["rms"], "greatest": truth["maximum"]}


def measure_reconstruction(store, points):
    if store.get("reconstruct", points):
        return
    result = run([PROGRAMS / "emax", "reconstruct", scan(points), "-o", surface(points), "--method", "imls",
                  "--tile-points", 1 << 18])
    told = {name: result["answer"][name] for name in ("points", "triangles", "tiles", "spacing")}
    told["truth"] = truth_of(surface(points))
    store.put(("reconstruct", points), {**{k: v for k, v in result.items() if k != "answer"}, **told})
    surface(points).unlink()


def measure_optimization(store, points):
    if store.get("optimize", points):
        return
    mesh = FOLDER / "hall.ply"
    certificate = FOLDER / "hall.ply.certificate.json"
    certificate.unlink(missing_ok=True)
    result = run([PROGRAMS / "emax", "optimize", scan(points), "--unit", "m", "--max-error", TOLERANCE,
                  "--exclude-outliers", OUTLIERS, "--tiles", TILE, "--effort", "quick", "--memory", OPTIMIZE_MEMORY,
                  "-o", mesh], awaited=certificate)
    answer = result.pop("answer")
    store.put(("optimize", points), {**result, "points": answer["points"], "triangles": answer["triangles"],
                                     "truth": truth_of(mesh)})


def measured_mesh(store):
    mesh = FOLDER / "mesh.ply"
    if not (mesh.exists() and store.get("mesh", MESH_POINTS)):
        result = run([PROGRAMS / "emax", "reconstruct", scan(MESH_POINTS), "-o", mesh, "--method", "imls",
                      "--tile-points", 1 << 18, "--set", f"imls.cell={MESH_CUBES}"])
        result["triangles"] = result.pop("answer")["triangles"]
        store.put(("mesh", MESH_POINTS), result)
    return mesh


def measure_error(store, points):
    if store.get("error", points):
        return
    result = run([PROGRAMS / "emax", "error", scan(points), measured_mesh(store), "--memory", MEMORY])
    result["triangles"] = store.get("mesh", MESH_POINTS)["triangles"]
    result["points"] = result.pop("answer")["points"]
    store.put(("error", points), result)
    if points > max(RECONSTRUCTED):
        scan(points).unlink()


def measure_peer(store, points):
    """CloudCompare beside `emax error`, both from PLY."""
    if store.get("peer", points) or not shutil.which("CloudCompare"):
        return
    mesh, cloud = measured_mesh(store).resolve(), (FOLDER / "cloud.ply").resolve()
    subprocess.run([PROGRAMS / "emax_scan", "hall", "--points", str(points), "-o", cloud], check=True, stderr=subprocess.DEVNULL)
    own = run([PROGRAMS / "emax", "error", cloud, mesh, "--memory", MEMORY])
    begun = time.monotonic()
    process = subprocess.Popen(error_bench.CLOUDCOMPARE + ["-O", cloud, "-O", mesh, "-C2M_DIST"], cwd=FOLDER,
                               env=error_bench.OFFSCREEN, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    used, _ = wait(process, begun, None)
    cloud.unlink()
    store.put(("peer", points), {"points": own.pop("answer")["points"], "emax": own, "failed": process.returncode != 0,
                                 "seconds": time.monotonic() - begun, "bytes": 1024 * used.ru_maxrss})


def measure_stream(store, points, mesh):
    if store.get("stream", points):
        return
    drawing = subprocess.Popen([PROGRAMS / "emax_scan", "hall", "--points", str(points), "-o", "-"],
                               stdout=subprocess.PIPE, stderr=subprocess.DEVNULL)
    with drawing:
        result = run([PROGRAMS / "emax", "error", "-", mesh, "--memory", MEMORY], drawing.stdout)
    if drawing.returncode:
        sys.exit("bench: emax_scan failed")
    result["points"] = result.pop("answer")["points"]
    store.put(("stream", points), result)


def measure_decimation(store, name, words):
    """As a whole and in tiles."""
    for way, more in (("whole", []), ("tiles", ["--tiles", TILE])):
        if store.get(name, way):
            continue
        result = run([PROGRAMS / "emax", "decimate", *words, "-o", FOLDER / f"{name}-{way}.ply", "--threads", 2, *more])
        result["triangles"] = result.pop("answer")["triangles"]
        store.put((name, way), result)


def measure_hall_in_tiles(store):
    if store.get("hall", "tiles"):
        return
    mesh = surface(TILED_HALL)
    if not mesh.exists():
        run([PROGRAMS / "emax", "reconstruct", scan(TILED_HALL), "-o", mesh, "--unit", "m", *HALL_SURFACE])
    measure_decimation(store, "hall", [mesh, "--cloud", scan(TILED_HALL), "--unit", "m", "--max-error", TOLERANCE,
                                       "--exclude-outliers", HALL_OUTLIERS, "--effort", "quick"])


def measure_stage(store, stage, points):
    if store.get(stage, points):
        return
    begun = time.monotonic()
    process = subprocess.Popen([PROGRAMS / "emax_growth_benchmark", stage, str(points)], stdout=subprocess.PIPE, text=True)
    with process.stdout:
        told = process.stdout.read()
    used, _ = wait(process, begun, None)
    if process.returncode:
        sys.exit(f"bench: emax_growth_benchmark {stage} {points} failed")
    told = json.loads(told)
    store.put((stage, points), {"points": told["points"], "seconds": told["seconds"], "processor": told["seconds"],
                                "bytes": 1024 * used.ru_maxrss})


def measure(store, most):
    for stage in STAGES:
        for points in STAGED:
            if points <= most:
                measure_stage(store, stage, points)
    for points in RECONSTRUCTED:
        if points <= most:
            measure_reconstruction(store, points)
    for points in OPTIMIZED:
        if points <= most:
            measure_optimization(store, points)
    for points in MEASURED:
        if points <= most:
            measure_error(store, points)
    for points in BESIDE:
        if points <= most:
            measure_peer(store, points)
    for points in STREAMED:
        if points <= most:
            measure_stream(store, points, measured_mesh(store))
    measure_hall_in_tiles(store)
    measure_decimation(store, "decimate", [DRAGON, "--max-error", f"{PERCENT}%"])


def exponent(small, large, unit):
    """Of the points, by which a time or a size grows."""
    return math.log(large[unit] / small[unit]) / math.log(large["points"] / small["points"])


def growth_table(found, titles, cells, digits):
    """Of results by ascending size; `titles` and `cells`: of two columns of the table's own; `digits`: of a point's time."""
    lines = [f"| points | {titles} | s | µs of processor a point | grows as n^ | MB of the largest process | "
             "from the true surface, mm: root mean square; greatest |",
             "|---:|---:|---:|---:|---:|---:|---:|---:|"]
    for i, r in enumerate(found):
        grows = f"{exponent(found[i - 1], r, 'processor'):.2f}" if i else "–"
        lines.append(f"| {r['points']} | {cells(r)} | {r['seconds']:.0f} | "
                     f"{1e6 * r['processor'] / r['points']:.{digits}f} | {grows} | {r['bytes'] / 1e6:.0f} | "
                     f"{1e3 * r['truth']['rms']:.2f}; {1e3 * r['truth']['greatest']:.0f} |")
    return "\n".join(lines) + "\n"


def reconstruction_table(store):
    found = [result for points in RECONSTRUCTED if (result := store.get("reconstruct", points))]
    if not found:
        return ""
    table = growth_table(found, "tiles | triangles", lambda r: f"{r['tiles']} | {r['triangles']}", 1)
    return ("`emax reconstruct` of a hall of 40 by 20 by 8 m, scanned from several stations, in tiles of 262,144 points on "
            "two cores. The exponent is that of the processor time from the row above; n log n grows as n^1.07 "
            "from 10^6 to 10^7. The resident size is the greatest of one process; two tiles are under way at a time, and "
            "the surface is checked as a whole in the end.\n\n" + table)


def optimization_table(store):
    found = [result for points in OPTIMIZED if (result := store.get("optimize", points))]
    if not found:
        return ""
    table = growth_table(found, "triangles | first certified mesh, s", lambda r: f"{r['triangles']} | {r['first']:.0f}", 0)
    return (f"`emax optimize --max-error {TOLERANCE} --exclude-outliers {OUTLIERS} --tiles {TILE} --effort quick "
            f"--memory {OPTIMIZE_MEMORY}` of the same scans: reconstruction in tiles, simplified, and decimation in tiles, "
            "two-sided and certified. The distances from the true surface are those of the mesh's vertices; mixed pixels "
            f"that are joined count.{extrapolation(found)}\n\n" + table)


def extrapolation(found):
    """By a power of the number of points, fitted to the last sizes."""
    if len(found) < FITTED:
        return ""
    last = found[-FITTED:]
    slope, intercept = statistics.linear_regression([math.log(r["points"]) for r in last],
                                                    [math.log(r["seconds"]) for r in last])
    hours = math.exp(intercept + slope * math.log(EXTRAPOLATED)) / 3600
    return (f" The last {FITTED} sizes grow as n^{slope:.2f} in wall time, by which {EXTRAPOLATED} points would take "
            f"{hours:.1f} hours.")


def stage_table(store):
    lines = []
    for stage, text in STAGES.items():
        found = [result for points in STAGED if (result := store.get(stage, points))]
        for i, r in enumerate(found):
            grows = f"{exponent(found[i - 1], r, 'processor'):.2f}" if i else "–"
            lines.append(f"| {text} | {r['points']} | {r['seconds']:.1f} | {1e6 * r['seconds'] / r['points']:.2f} | {grows} | "
                         f"{r['bytes'] / r['points']:.0f} |")
    if not lines:
        return ""
    return ("What comes before a decimation, of a wavy sheet as a whole, one thread.\n\n"
            "| | points | s | µs a point | grows as n^ | bytes a point, of the process |\n|---|---:|---:|---:|---:|---:|\n"
            + "\n".join(lines) + "\n")


def processor(result):
    """Nanoseconds of the processor a point."""
    return f"{1e9 * result['processor'] / result['points']:.0f}"


def error_table(store):
    found = [result for points in MEASURED if (result := store.get("error", points))]
    if not found:
        return ""
    lines = ["| points | s | ns a point | ns of processor a point | MB resident |", "|---|---:|---:|---:|---:|"]
    lines += [f"| {r['points']} | {r['seconds']:.1f} | {1e9 * r['seconds'] / r['points']:.0f} | {processor(r)} | "
              f"{r['bytes'] / 1e6:.0f} |" for r in found]
    streamed = [result for points in STREAMED if (result := store.get("stream", points))]
    lines += [f"| {r['points']}, streamed | – | – | {processor(r)} | {r['bytes'] / 1e6:.0f} |" for r in streamed]
    told = "".join(f" The {r['points']} points come through a pipe from the generator and are never stored. It draws them twice "
                   "on the same cores, once for the box in the header, so no wall time is given." for r in streamed)
    return (f"`emax error` of the hall's scans against the surface of the one of 10^6 points in cubes of two spacings, {found[0]['triangles']} "
            f"triangles, with `--memory {MEMORY}`: wall time of the whole command on two cores, which reads and checks the "
            f"mesh, and resident size as the system counts it.{told}{peer_text(store)}\n\n" + "\n".join(lines) + "\n")


def peer_text(store):
    told = ""
    for points in BESIDE:
        r = store.get("peer", points)
        if not r:
            continue
        if r["failed"]:
            told += f" CloudCompare ends with an error at {r['points']} points, after {r['seconds']:.0f} s."
            continue
        told += (f" CloudCompare {error_bench.version('cloudcompare')} takes {r['seconds']:.1f} s and {r['bytes'] / 1e6:.0f} MB for "
                 f"{r['points']} points from PLY, `emax error` {r['emax']['seconds']:.1f} s and {r['emax']['bytes'] / 1e6:.0f} MB.")
    return told


def tiles_text(store):
    told = []
    for name, text in (("decimate", f"the dragon at {PERCENT} % of the width"),
                       ("hall", f"a surface of {TILED_HALL} points of the hall at {TOLERANCE}, quick effort")):
        whole, tiles = store.get(name, "whole"), store.get(name, "tiles")
        if not whole or not tiles:
            continue
        more = 100 * tiles["triangles"] / whole["triangles"] - 100
        told.append(f"`emax decimate` of {text}, two-sided, two threads: {whole['triangles']} triangles as a whole in "
                    f"{whole['seconds']:.0f} s and {whole['bytes'] / 1e6:.0f} MB; {tiles['triangles']} ({more:+.1f} %) in "
                    f"tiles of {TILE} triangles in {tiles['seconds']:.0f} s and {tiles['bytes'] / 1e6:.0f} MB.\n")
    return "\n".join(told)


def section(store):
    return "\n".join(["## Scale\n", "Written by `./dev bench --scale`.\n",
                      *[part for part in (reconstruction_table(store), optimization_table(store), stage_table(store),
                                   error_table(store), tiles_text(store)) if part]])


def main(words, fetch_dragon):
    parser = argparse.ArgumentParser(prog="./dev bench --scale", description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--fresh", action="store_true", help="forget earlier results")
    parser.add_argument("--most", type=float, default=math.inf, metavar="N", help="leave out clouds of more points")
    parser.add_argument("--only-write", action="store_true", help="from the results that are there")
    options = parser.parse_args(words)
    if options.fresh:
        shutil.rmtree(FOLDER, ignore_errors=True)
    store = Store(FOLDER)
    if not options.only_write:
        fetch_dragon()
        measure(store, options.most)
    sections.put("scale", section(store))
