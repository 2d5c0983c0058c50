"""`./dev bench --decimate`: the bounded decimator beside OpenMesh, VTK, meshoptimizer, CGAL and five
packages of PyPI and npm, on five scans and three known surfaces; writes the section "Decimation" of
docs/benchmarks.md, its plots and docs/benchmarks_decimation.md.

Every peer is bisected to its fewest triangles within the same one-sided bound. Each result is kept
in build/bench/decimation/, so that a measurement can be interrupted and continued; --fresh begins
anew, --fresh-own measures only emax anew, --scans and --tools measure some, --only-write writes
from what is there. All of it takes about three hours of one core; --quick, which prints one small
case without the packages and writes nothing, a minute.
"""

import argparse
import json
import math
import platform
import shlex
import shutil
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import sections

HERE = Path("tests/benchmarks")
PROGRAM = Path("build/bench/bin/emax_decimation_benchmark")
FOLDER = Path("build/bench/decimation")
PLOTS = Path("docs/plots")

# Percent of the width.
BOUNDS = {"bunny": [0.642, 0.321, 0.193, 0.0642], "fandisk": [0.5, 0.1, 0.02], "torus": [0.25], "building": [0.5],
          "dragon": [0.2], "sphere": [0.05], "smooth-torus": [0.037037], "ellipsoid": [0.05]}
QUICK = ("fandisk", 0.1)
LINKED = ["meshoptimizer", "vtk-pro", "vtk-quadric", "cgal-gh", "cgal-lt", "openmesh", "cgal-envelope"]
# In a process of their own: of peers/decimators.py, and npm's meshoptimizer.
PACKAGES = ["meshlab", "pyfqmr", "fast-simplification", "manifold"]
MESHOPTIMIZER = "meshoptimizer-npm"
PEERS = LINKED + [MESHOPTIMIZER] + PACKAGES
# The theory's fewest, of a smooth surface; of the known ones exactly. Not where edges are sharp.
FEWEST, SURFACES = "fewest", ["torus", "sphere", "smooth-torus", "ellipsoid"]
FEWEST_SCANS = ["bunny", "dragon"] + SURFACES
TWO, ONE = "emax-two-sided", "emax-one-sided"
FEATURES = TWO + "-features"
OWN = [TWO, FEATURES, TWO + "-deep", ONE, ONE + "-deep"]
# The envelope's test of every collapse would take hours elsewhere; scans have no sharp edges.
ENVELOPE, ENVELOPE_CASES = "cgal-envelope", [("fandisk", 0.1)]
# What one of the three directions takes; no tool, it has no triangles of its own.
THIRD, THIRD_CASES = "third-direction", [("bunny", 0.642), ("bunny", 0.321), ("bunny", 0.0642), ("fandisk", 0.1)]
ONLY = {ENVELOPE: ENVELOPE_CASES, THIRD: THIRD_CASES, FEATURES: [("fandisk", percent) for percent in BOUNDS["fandisk"]],
        FEWEST: [(scan, percent) for scan in FEWEST_SCANS for percent in BOUNDS[scan]]}
POINTS = [10000, 30000, 100000, 300000, 1000000]
POINTS_PERCENT = 0.25
POINTS_TOOLS = [TWO, ONE, "meshoptimizer", "vtk-pro", "vtk-quadric", "cgal-gh", "cgal-lt", "openmesh"]
ALL = OWN + PEERS + [FEWEST, THIRD]
DETAILS = "benchmarks_decimation.md"
TIME_LIMIT = 7200
NOTHING_GONE = 0.98  # of the triangles of the start: the tool found nothing to remove


def say(text):
    print(f"bench: {text}", flush=True)


class Store:
    """One JSON object a result; a later one of the same key stands."""

    def __init__(self, file):
        self.file, self.results = file, {}
        file.parent.mkdir(parents=True, exist_ok=True)
        for line in file.read_text().splitlines() if file.exists() else []:
            try:
                result = json.loads(line)
                self.results[tuple(result["key"])] = result
            except (ValueError, KeyError):  # torn by an interruption
                pass

    def get(self, *key):
        return self.results.get(key)

    def put(self, key, result):
        result["key"] = list(key)
        self.results[key] = result
        with self.file.open("a") as file:
            file.write(json.dumps(result) + "\n")

    def measure(self, key, arguments, refused=False):
        """Kept, whatever comes of it; a tool that crashes or hangs is told as that, and so is a mesh that is `refused`."""
        start = time.monotonic()
        try:
            ended = subprocess.run([PROGRAM, *map(str, arguments)], stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                                   text=True, timeout=TIME_LIMIT)
        except subprocess.TimeoutExpired:
            result = {"failure": f"not within {TIME_LIMIT / 60:.0f} minutes"}
        else:
            if ended.returncode < 0:
                result = {"failure": f"ended by signal {-ended.returncode}"}
            elif ended.returncode > 0 and refused:
                result = {"failure": ended.stderr.strip()}
            elif ended.returncode > 0:
                sys.exit(ended.stderr.strip() or f"bench: {PROGRAM} failed")
            else:
                result = json.loads(ended.stdout)
        result["wall"] = time.monotonic() - start
        self.put(key, result)
        say(f"{' '.join(map(str, key))}: {outcome(result)}, {result['wall']:.0f} s")


def outcome(result):
    if not succeeded(result):
        return why_not(result)
    return f"{result['triangles']} triangles" if "triangles" in result else "timed"


def choosing(tool, python, module):
    """The arguments that choose a tool, or None where it could not be installed."""
    if tool in PACKAGES:
        return python and ["--command", f"{shlex.quote(str(python))} -B {HERE / 'peers/decimators.py'} {tool}"]
    if tool == MESHOPTIMIZER:
        path, version = module or (None, None)
        return path and ["--command", f"node {HERE / 'peers/meshoptimizer.mjs'} {shlex.quote(str(path))} {version}"]
    return ["--tool", tool]


def measure(store, scans, tools, python, module):
    for scan in scans:
        for percent in BOUNDS[scan]:
            for tool in tools:
                key = scan, percent, tool
                if (scan, percent) not in ONLY.get(tool, [(scan, percent)]) or store.get(*key):
                    continue
                case = ["--scan", scan, "--percent", percent]
                if tool == FEWEST:
                    measure_fewest(store, key, case, python)
                elif chosen := choosing(tool, python, module):
                    store.measure(key, case + chosen)
    for points in POINTS:
        for tool in POINTS_TOOLS:
            key = "points", points, tool
            if "torus" in scans and tool in tools and not store.get(*key):
                store.measure(key, ["--points", points, "--percent", POINTS_PERCENT, "--tool", tool])


def measure_fewest(store, key, case, python):
    """In the interpreter with NumPy; nothing without one."""
    if not python:
        return
    with tempfile.TemporaryDirectory() as folder:
        told = json.loads(subprocess.run([PROGRAM, *map(str, case), "--write-start", folder], check=True,
                                         stdout=subprocess.PIPE, text=True).stdout)
        source = key[0] if key[0] in SURFACES else folder
        fewest = subprocess.run([python, "-B", HERE / "optimal_triangulation.py", str(told["epsilon"]), source], check=True,
                                stdout=subprocess.PIPE, text=True).stdout
    store.put(key, {**told, "name": "N*, the theory's fewest", "bound": json.loads(fewest)})
    say(f"{' '.join(map(str, key))}: {fewest.strip()}")


def succeeded(result):
    return result and "failure" not in result and (
        "triangles" not in result and "seconds" in result or
        result.get("triangles", math.inf) < NOTHING_GONE * result.get("start", math.inf))


def number(value, digits=3):
    """So many digits, never an exponent."""
    if value == 0:
        return "0"
    places = max(0, digits - 1 - math.floor(math.log10(abs(value))))
    return f"{value:.{min(places, 6)}f}"


def cut(text):
    """A reason as it fits into a cell."""
    return " ".join(text.replace("|", "/").split())[:100]


def why_not(result):
    least, reason = result.get("least_error"), result.get("reason")
    told = [f"its nearest is {number(least)}"] if least else []
    told += [cut(reason)] if reason else []
    return cut(result["failure"]) if "failure" in result else ": ".join(["cannot"] + ["; ".join(told)] * bool(told))


def bounds_told(bound):
    """N*, with its spread where it was estimated."""
    spread = f" ({bound['least']}–{bound['greatest']})" if bound["least"] < bound["greatest"] else ""
    return f"{bound['triangles']}{spread}"


def options_told(result):
    told = [result["options"]] if result.get("options") else []
    told += [f"{number(result['tolerance'], 2)} ε"] if "tolerance" in result else []
    failed = [f"{result['failed_calls']} calls failed: {cut(result['reason'])}"] if "failed_calls" in result else []
    return "; ".join([", ".join(told)] * bool(told) + failed)


def row(tool, result, compared, sharp):
    name = result.get("name", tool)
    if "bound" in result:
        cells = [bounds_told(result["bound"])] + ["–"] * (8 + compared + sharp)
    elif not succeeded(result):
        cells = [why_not(result)] + ["–"] * (8 + compared + sharp)
    else:
        cells = [str(result["triangles"]), number(result["e_max"]), number(result["back"]),
                 str(result["intersecting"]), str(result["non_manifold"])]
        if compared:
            cells += [f"{number(result['true_greatest'])}; {number(result['true_rms'])}"]
        if sharp:
            cells += [number(result["edges"]) if "edges" in result else "none left"]
        cells += [number(result["seconds"]), number(result["search_seconds"]), str(result["search_calls"]),
                  options_told(result)]
    return f"| {name} | " + " | ".join(cells) + " |"


def table(store, scan, percent, tools):
    results = [(tool, store.get(scan, percent, tool)) for tool in tools]
    results = [(tool, result) for tool, result in results if result]
    if not results:
        return ""
    told = next((result for _, result in results if "text" in result), {})
    compared = any("true_rms" in result for _, result in results)
    sharp = any("edges" in result for _, result in results)
    head = ["tool", "triangles", "e_max, %", "back, %", "self-intersecting triangles", "non-manifold edges"]
    head += ["to the true surface, %: greatest; root mean square"] if compared else []
    head += ["from sharp edges, %"] if sharp else []
    head += ["s", "s, all calls", "calls", "options"]
    lines = [f"## {scan}, {percent:g} % of the width\n"]
    if told:
        left = f", {told['left_out']} left out that cannot be joined to the mesh" if told["left_out"] else ""
        lines.append(f"{told['text']}: {told['points']} points{left}; the start has "
                     f"{told['start']} triangles.\n")
    lines += ["| " + " | ".join(head) + " |", "|---|" + "---:|" * (len(head) - 2) + "---|"]
    lines += [row(tool, result, compared, sharp) for tool, result in results]
    return "\n".join(lines) + "\n"


def best_peer(store, scan, percent):
    found = [store.get(scan, percent, tool) for tool in PEERS]
    return min((result for result in found if succeeded(result)), key=lambda result: result["triangles"], default=None)


def fewer(own, peer):
    if not succeeded(own) or not peer:
        return "–"
    return f"{own['triangles']} ({100 * own['triangles'] / peer['triangles'] - 100:+.0f} %)"


def summary(store):
    lines = ["| scan | ε, % | best peer | its triangles | its back, % | emax one-sided | deep | emax two-sided | deep |",
             "|---|---:|---|---:|---:|---:|---:|---:|---:|"]
    for scan, bounds in BOUNDS.items():
        for percent in bounds:
            if not any(store.get(scan, percent, tool) for tool in OWN + PEERS):
                continue
            peer = best_peer(store, scan, percent)
            told = [peer["name"], str(peer["triangles"]), number(peer["back"])] if peer else ["none", "–", "–"]
            own = [fewer(store.get(scan, percent, tool), peer) for tool in (ONE, ONE + "-deep", TWO, TWO + "-deep")]
            lines.append(f"| {scan} | {percent:g} | " + " | ".join(told + own) + " |")
    return "\n".join(lines) + "\n"


def missing(store):
    """What the tables lack because it was not measured, which is no failure of a tool."""
    lacks = []
    for scan, bounds in BOUNDS.items():
        for percent in bounds:
            tools = [tool for tool in OWN + PEERS + [FEWEST] if (scan, percent) in ONLY.get(tool, [(scan, percent)])]
            if unmeasured := [tool for tool in tools if not store.get(scan, percent, tool)]:
                lacks.append(f"{scan} at {percent:g} %: {', '.join(unmeasured)}")
    return f"Not measured: {'; '.join(lacks)}.\n" if lacks else ""


def line(title, at, values):
    return {"title": title, "at": at, "median": values, "least": values, "greatest": values}


def curves(store):
    plots = []
    for scan, bounds in BOUNDS.items():
        lines = []
        for tool in OWN + PEERS if len(bounds) > 2 else []:
            found = [(percent, store.get(scan, percent, tool)) for percent in sorted(bounds)]
            found = [(percent, result) for percent, result in found if succeeded(result)]
            if found:
                lines.append(line(found[0][1]["name"], [percent for percent, _ in found],
                                  [result["triangles"] for _, result in found]))
        found = [(percent, result) for percent in sorted(bounds) if (result := store.get(scan, percent, FEWEST))]
        if lines and found:
            told = {name: [result["bound"][name] for _, result in found] for name in ("triangles", "least", "greatest")}
            lines.append({**line("N*", [percent for percent, _ in found], told["triangles"]), "least": told["least"],
                          "greatest": told["greatest"]})
        if lines:
            plots.append({"name": f"decimation_{scan}", "axis": "ε, % of the width", "unit": "triangles",
                          "title": f"{scan}: triangles by ε", "lines": lines})
    lines = []
    for tool in POINTS_TOOLS:
        found = [result for points in POINTS if succeeded(result := store.get("points", points, tool))]
        if found:
            lines.append(line(found[0]["name"], [result["points"] for result in found],
                              [result["seconds"] for result in found]))
    own = [result for points in POINTS if succeeded(result := store.get("points", points, TWO))]
    if own:
        first = own[0]
        scale = first["seconds"] / (first["points"] * math.log(first["points"]))
        lines.append(line("n log n", [result["points"] for result in own],
                          [scale * result["points"] * math.log(result["points"]) for result in own]))
        plots.append({"name": "decimation_time", "axis": "points", "unit": "s", "title": "s by points", "lines": lines})
    return plots


def third(store):
    """What keeping the reference near the mesh takes, of whole calls."""
    told = []
    for scan, percent in THIRD_CASES:
        result = store.get(scan, percent, THIRD)
        if result and "share" in result:
            middle, least, greatest = (100 * (1 - 1 / (1 + share)) for share in result["share"])
            told.append(f"{scan} at {percent:g} % {middle:.0f} % ({least:.0f}–{greatest:.0f}) of "
                        f"{number(result['seconds'][0])} s")
    return ("The share of a two-sided call that keeping and certifying every point of the reference within ε takes "
            "(median of five calls with and without it in turn, least–greatest): " + "; ".join(told) + ".\n") if told else ""


def growth(store):
    """How the time of a point grows, beside that of n log n."""
    text = []
    for tool in (TWO, ONE):
        found = [result for points in POINTS if succeeded(result := store.get("points", points, tool))]
        if len(found) < 2:
            continue
        first, last = found[0], found[-1]
        ratio = last["seconds"] / first["seconds"]
        even = last["points"] * math.log(last["points"]) / (first["points"] * math.log(first["points"]))
        text.append(f"{first['name']} takes {number(first['seconds'])} s for {first['points']} points and "
                    f"{number(last['seconds'])} s for {last['points']}: {ratio / even:.2f} of what n log n would be")
    return "; ".join(text) + ".\n" if text else ""


def machine():
    for entry in Path("/proc/cpuinfo").read_text().splitlines():
        if entry.startswith("model name"):
            return entry.split(":")[1].strip()
    return platform.processor()


EXPLAINED = """\
Written by `./dev bench --decimate`. The table has the fewest triangles such that every point of the cloud is within ε
of the mesh (one-sided, e_max). emax is called once, and its time includes its certificate. For every peer a bisection
over the peer's own parameter, a number of triangles or a bound, finds the fewest triangles whose e_max, by our engine,
is within the same ε. Several sets of options are tried, and the table has the best. CGAL's AABB-tree confirms e_max of
every result. Packages of PyPI and npm run in a process of their own, with the same bisection and the same measurement;
their time is the processor time of their calls. All tools start from the mesh that emax starts from: manifold and free of self-intersections, with points
farther than ε/2 joined to it. No time here includes the making of that mesh.
"""


COLUMNS = """\
# Decimation, case by case

Written by `./dev bench --decimate`; [benchmarks.md](benchmarks.md#decimation) says how it is measured.

- "back": the greatest distance from any point of the result to the mesh it started from. Two-sided emax keeps it within
  ε too; the other tools do not bound it.
- "from sharp edges": the greatest distance from an edge of the start that turns by more than 40° to an edge of the
  result that turns by more than 25°.
- "N*": the fewest triangles of a free triangulation within ±ε of a smooth surface, as ε goes to 0: ∫ √K dA / (3√3 ε)
  where the Gaussian curvature K is positive, plus ∫ √|K| dA / (4.6 ε) where it is negative (Pottmann et al. 2000;
  Atariah, Rote and Wintraecken). Exact for the sphere, both tori (without the noise) and the ellipsoid. For scans K comes from
  quadrics fitted to neighbourhoods of two, three and four rings of vertices; in brackets the least and the greatest N*
  of the three. Noise and details finer than ε raise it; a one-sided result, or one far from the limit, may be below it.
- "options": those that gave the result. A number of ε is the tolerance or bound that the tool was given. Where it is
  below 1 ε, the tool's result with ε itself is farther than ε from some point.
- "s": the call that gave the result. "s, all calls": the whole bisection with these options. Processor time, one thread.
"""


def details(store):
    parts = [COLUMNS]
    for scan, bounds in BOUNDS.items():
        parts += [text for percent in bounds if (text := table(store, scan, percent, OWN + [FEWEST] + PEERS))]
    if succeeded(envelope := store.get(*ENVELOPE_CASES[0], ENVELOPE)):
        scan, percent = ENVELOPE_CASES[0]
        parts.append(f"CGAL's polyhedral envelope takes {number(envelope['seconds'])} s a call on {scan} at {percent:g} % and "
                     "is measured there alone.\n")
    return "\n".join(parts)


def section(store, plots):
    results = list(store.results.values())
    versions = {result["name"].split(",")[0]: result["version"] for result in results if "version" in result}
    seconds = sum(result.get("all_seconds", result.get("seconds", 0)) for result in results
                  if result["key"][-1] != THIRD)
    parts = ["## Decimation\n",
             EXPLAINED,
             f"{machine()}; " + ", ".join(f"{name} {version}" for name, version in sorted(versions.items())) +
             f"; {seconds / 60:.0f} minutes of the tools' own time in all.\n",
             "Triangles; in brackets the difference from the best peer, whose result is one-sided in every row:\n", summary(store), missing(store)]
    parts += [f"![{plot['title']}](plots/{plot['name']}.svg)" for plot in plots]
    if plots:
        parts.append("")
    if told := growth(store):
        parts.append(f"Time by points: one call on a torus with little noise, ε = {POINTS_PERCENT} % of the width. The "
                     f"peers decimate to 2000 triangles, OpenMesh to its own bound of ε. {told}")
    if told := third(store):
        parts.append(told)
    parts.append(f"Every tool in every case: [{DETAILS}]({DETAILS}).\n")
    return "\n".join(parts)


def quick():
    (scan, percent), tools = QUICK, [TWO, ONE] + [tool for tool in LINKED if tool != ENVELOPE]
    with tempfile.TemporaryDirectory() as folder:
        store = Store(Path(folder) / "quick.jsonl")
        for tool in tools:
            store.measure((scan, percent, tool), ["--scan", scan, "--percent", percent, "--tool", tool, "--quick"])
        print("\n" + table(store, scan, percent, tools))


def main(words, is_quick, fetch_dragon, install_python, fetch_meshoptimizer):
    """The last three make data/dragon.ply; an interpreter with Matplotlib and the packages, or None; npm's module with
    its version, or None."""
    parser = argparse.ArgumentParser(prog="./dev bench --decimate", description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--scans", nargs="+", choices=BOUNDS, default=list(BOUNDS))
    parser.add_argument("--tools", nargs="+", choices=ALL, default=ALL)
    parser.add_argument("--fresh", action="store_true", help="forget earlier results")
    parser.add_argument("--fresh-own", action="store_true", help="forget emax's own earlier results")
    parser.add_argument("--only-write", action="store_true", help="from the results that are there")
    options = parser.parse_args(words)
    if is_quick:
        quick()
        return
    if "dragon" in options.scans and not options.only_write:
        fetch_dragon()
    python = install_python()
    if options.fresh:
        shutil.rmtree(FOLDER, ignore_errors=True)
    store = Store(FOLDER / "results.jsonl")
    if options.fresh_own:
        store.results = {key: result for key, result in store.results.items() if key[2] not in OWN + [THIRD]}
    if not options.only_write:
        module = fetch_meshoptimizer() if MESHOPTIMIZER in options.tools else None
        measure(store, options.scans, options.tools, python, module)
    plots = curves(store)
    sections.put("decimation", section(store, plots))
    sections.write(sections.DOCUMENT.with_name(DETAILS), details(store))
    if python:
        file = FOLDER / "curves.json"
        file.write_text(json.dumps(plots))
        PLOTS.mkdir(exist_ok=True)
        subprocess.run([python, "-B", HERE / "peers/plot.py", file, PLOTS], check=True)
    else:
        say(f"{PLOTS} is left as it was: Matplotlib could not be installed")
