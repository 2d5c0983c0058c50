"""`./dev bench --search`: Genocop III beside pagmo and NLopt on g01 to g11 and a staircase; writes the
section "Search" of docs/benchmarks.md.

Every run is kept in build/bench/search/, so that a measurement can be interrupted and continued;
--fresh begins anew. All budgets take about two hours of one core; --budgets 200 1000 5000 a quarter of it.
"""

import argparse
import json
import math
import shutil
import statistics
import subprocess
from pathlib import Path

import sections

HERE = Path("tests/benchmarks")
BUDGETS = [200, 1000, 5000, 50000]
PROBLEMS = [f"g{i:02}" for i in range(1, 12)] + ["staircase"]
PEERS = ["pagmo gaco", "pagmo cstrs_self_adaptive", "NLopt ISRES", "NLopt COBYLA"]
SEARCHES = ["emax", "emax, look-ahead 16"]
ABLATIONS = ["without finish", "without linear model", "without both", "without monotone step",
             "without adaptive frequencies", "without Sobol starts", "without first phase", "repair at random",
             "populations 70/70"]
ABLATION_BUDGETS = [200, 1000]
ORIGINAL = "original"
ORIGINAL_BUDGET = 350000
PUBLISHED = {"g02": ("0.80351", -0.80351), "g07": ("25.883", 25.883), "g09": ("680.640", 680.640),
             "g10": ("7286.650", 7286.650)}
OPTIMA = {"g02": -0.803619, "g07": 24.306209, "g09": 680.630057, "g10": 7049.248021, "g01": -15, "g03": -1.0005001,
          "g04": -30665.538672, "g05": 5126.496714, "g06": -6961.813876, "g08": -0.095825, "g11": 0.7499}


class Store:
    """Runs as JSON lines, one file a way."""

    def __init__(self, folder):
        self.folder = folder
        folder.mkdir(parents=True, exist_ok=True)
        self.gaps, self.versions = {}, ""
        for file in sorted(folder.glob("*.jsonl")):
            for line in file.read_text().splitlines():
                self.take(line)

    def take(self, line):
        try:
            run = json.loads(line)
        except ValueError:  # torn by an interruption
            return
        self.versions = run.get("versions", self.versions)
        if "way" in run:
            key = run["way"], run["problem"], run["budget"]
            self.gaps.setdefault(key, {})[run["seed"]] = math.inf if run["gap"] is None else run["gap"]

    def run(self, command, name):
        with (self.folder / f"{name}.jsonl").open("a") as file:
            process = subprocess.Popen([str(word) for word in command], stdout=subprocess.PIPE, text=True)
            for line in process.stdout:
                file.write(line)
                file.flush()
                self.take(line)
            return process.wait() == 0

    def has(self, way, problem, budget, seeds):
        return len(self.gaps.get((way, problem, budget), {})) >= seeds

    def of(self, way, problem, budget):
        return list(self.gaps.get((way, problem, budget), {}).values())


def measure(store, options):
    program, library = options.build / "bin/emax_search_benchmark", options.build / "lib/libemax_search_problems.so"
    plan = [(way, problem, budget) for budget in options.budgets for problem in PROBLEMS for way in SEARCHES]
    plan += [(way, problem, budget) for budget in ABLATION_BUDGETS for problem in PROBLEMS for way in ABLATIONS]
    plan += [(ORIGINAL, problem, ORIGINAL_BUDGET) for problem in PUBLISHED]
    for way, problem, budget in plan:
        if not store.has(way, problem, budget, options.seeds):
            store.run([program, "--ways", way, "--problems", problem, "--budgets", budget, "--seeds", options.seeds],
                      "emax")
    for budget in options.budgets:
        for problem in PROBLEMS:
            if options.python and not all(store.has(way, problem, budget, options.seeds) for way in PEERS):
                store.run([options.python, "-B", HERE / "peers/search_peers.py", "--library", library, "--problems",
                           problem, "--budgets", budget, "--seeds", options.seeds], "peers")


def text_of(gaps):
    """The median, and the share of feasible runs where it is not all of them."""
    if not gaps:
        return "–"
    median = sorted(gaps)[len(gaps) // 2]
    share = sum(math.isfinite(gap) for gap in gaps)
    body = "none" if not math.isfinite(median) else "0" if abs(median) < 1e-12 else f"{median:.2g}"
    return body if share == len(gaps) else f"{body} ({share}/{len(gaps)})"


def table(store, ways, budget):
    lines = ["| | " + " | ".join(PROBLEMS) + " |", "|---|" + "---:|" * len(PROBLEMS)]
    for way in ways:
        lines.append(f"| {way} | " + " | ".join(text_of(store.of(way, problem, budget)) for problem in PROBLEMS) + " |")
    return "\n".join(lines) + "\n"


def standing(store, budget):
    """On how many functions the search is best or tied, and how many it always solves feasibly."""
    best = feasible = 0
    for problem in PROBLEMS[:-1]:
        own = store.of("emax", problem, budget)
        if not own:
            return ""
        others = [sorted(gaps)[len(gaps) // 2] for way in PEERS if (gaps := store.of(way, problem, budget))]
        tie = 1e-4 * max(1, abs(OPTIMA[problem]))
        median = sorted(own)[len(own) // 2]
        best += math.isfinite(median) and all(median <= other + tie for other in others)
        feasible += all(math.isfinite(gap) for gap in own)
    stairs, others = store.of("emax", "staircase", budget), [store.of(way, "staircase", budget) for way in PEERS]
    text = f"emax is best or tied (within 1e-4·max(1, |f*|)) on {best} of the 11 functions and feasible in every run on {feasible}."
    if stairs and all(others):
        ratio = statistics.median(stairs) / min(statistics.median(gaps) for gaps in others)
        text += f" On the staircase its gap is {ratio:.2f} × the best peer's."
    return text + "\n"


def section(store, options):
    parts = ["## Search\n",
             "Written by `./dev bench --search`. Median (best feasible − optimum) of "
             f"{options.seeds} runs, every evaluation charged; in brackets the runs that ended feasible, where not all "
             "did; none: no feasible point in the median run; –: not measured. Functions as in "
             "`tests/host/genocop/benchmark_problems.h` and `staircase.h`, the same library for all; equalities hold "
             "within 1e-4, and a peer's inequalities within 1e-8. pagmo and NLopt get single constraint values, as "
             "emax does, the linear ones among them, and the staircase's start point. COBYLA restarts from random "
             f"points. Every optimizer knows every earlier result, but for the row that looks ahead. {store.versions}.\n"]
    for budget in options.budgets:
        parts += [f"### {budget} evaluations\n", standing(store, budget), table(store, SEARCHES + PEERS, budget)]
    parts += ["### Each strategy left out\n", "The last rows show what replaces one part by the published one.\n"]
    for budget in ABLATION_BUDGETS:
        parts += [f"{budget} evaluations:\n", table(store, ["emax"] + ABLATIONS, budget)]
    parts += ["### The published Genocop III\n",
              f"`Settings::original()`, {ORIGINAL_BUDGET} evaluations, a first feasible point found by the first phase.\n",
              "| | published best | best here | median | runs |\n|---|---:|---:|---:|---:|"]
    rows = []
    for problem, (published, _) in PUBLISHED.items():
        gaps = sorted(store.of(ORIGINAL, problem, ORIGINAL_BUDGET))
        values = [abs(gap + OPTIMA[problem]) for gap in gaps]
        rows.append(f"| {problem} | {published} | " + (f"{values[0]:.7g} | {values[len(values) // 2]:.7g} | {len(gaps)} |"
                                                    if gaps else "– | – | 0 |"))
    parts[-1] += "\n" + "\n".join(rows) + "\n"
    return "\n".join(parts)


def main(words, python):
    parser = argparse.ArgumentParser(prog="./dev bench --search", description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--budgets", nargs="+", type=int, default=BUDGETS)
    parser.add_argument("--seeds", type=int, default=11)
    parser.add_argument("--fresh", action="store_true", help="forget earlier runs")
    parser.add_argument("--build", type=Path, default=Path("build/bench"))
    parser.add_argument("--only-write", action="store_true", help="from the runs that are there")
    options = parser.parse_args(words)
    options.python = python
    folder = options.build / "search"
    if options.fresh:
        shutil.rmtree(folder, ignore_errors=True)
    store = Store(folder)
    if not options.only_write:
        measure(store, options)
    sections.put("search", section(store, options))
