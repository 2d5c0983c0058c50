"""`./dev bench --search`: Genocop III beside pagmo, NLopt and COBYQA on the functions of
benchmark_problems.h and cec2006_problems.h, a staircase and scans; writes the sections "Search" and "Search on scans" of docs/benchmarks.md, their plot and
docs/benchmarks_search.md.

Every run is kept in build/bench/search/, so that a measurement can be interrupted and continued;
--fresh begins anew, --only PART measures one part, --only-write writes from what is there; a part
without runs keeps what stands there. On one core the functions beside the peers take about six
hours, each strategy left out there and the published setting some minutes, the scans four hours
and each strategy left out on one of them another.
"""

import argparse
import json
import math
import shutil
import subprocess
import sys
from pathlib import Path

import sections

HERE = Path("tests/benchmarks")
BUDGETS = [200, 1000, 5000, 50000]
SEEDS = 11
# Those that the search was developed with, and those that were kept apart.
FIRST = [f"g{i:02}" for i in range(1, 12)]
FURTHER = [f"g{i}" for i in (12, 13, 14, 15, 16, 17, 18, 19, 21, 23, 24)]
STAIRCASE = "staircase"
PROBLEMS = FIRST + FURTHER + [STAIRCASE]
PEERS = ["pagmo gaco", "pagmo cstrs_self_adaptive", "NLopt ISRES", "NLopt COBYLA", "NLopt SLSQP", "COBYQA"]
SLOW = {"COBYQA": 1000}  # the most evaluations, where a peer takes hours for more
RANDOM = "random search"
SEARCHES = ["emax", "emax, look-ahead 16"]
LOOK_AHEAD_BUDGETS = [200, 1000, 5000]  # where every evaluation is dear
ABLATIONS = ["without finish", "without linear model", "without both", "without monotone step",
             "without restarts", "without differential evolution", "without adaptive frequencies", "without Sobol starts", "without first phase", "without cache",
             "without uniform mutation", "replacement as published", "repair at random", "repair of every point",
             "populations 70/70"]
ABLATION_BUDGETS = [200, 1000]
ORIGINAL = "original"
ORIGINAL_BUDGET = 350000
PUBLISHED = {"g02": "0.80351", "g07": "25.883", "g09": "680.640", "g10": "7286.650"}

# Scan, percent of the width, decimator; beside fewer peers, as every run is dear.
SCANS = ["bunny 0.321 schroeder", "building 1 schroeder"]
SCAN_PEERS = ["pagmo gaco", "pagmo cstrs_self_adaptive", RANDOM]
SCAN_BUDGET, SCAN_SEEDS, RANGE_SEEDS, SCAN_ABLATION_SEEDS = 200, 3, 1, 1
SCAN_ABLATIONS = [way for way in ABLATIONS if way != "without both"] + [ORIGINAL]
# The paper's Fig. 3: the bunny at these percents of the width; 0.321 is its 0.5 mm.
RANGE = [0.193, 0.257, 0.321, 0.449, 0.642]
PAPER_PERCENT, PAPER_TRIANGLES = 0.321, 24161
DETAILS = "benchmarks_search.md"
PLOTS = Path("docs/plots")


class Store:
    """Runs as JSON lines, one file a way."""

    def __init__(self, folder):
        self.folder = folder
        folder.mkdir(parents=True, exist_ok=True)
        self.gaps, self.optima, self.versions = {}, {}, ""
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
            self.optima[run["problem"]] = run["optimum"]

    def run(self, command, name):
        with (self.folder / f"{name}.jsonl").open("a") as file:
            process = subprocess.Popen([str(word) for word in command], stdout=subprocess.PIPE, text=True)
            for line in process.stdout:
                file.write(line)
                file.flush()
                self.take(line)
            if process.wait() != 0:
                sys.exit(f"{' '.join(map(str, command))} ended with exit code {process.returncode}; the runs before are kept")

    def has(self, way, problem, budget, seeds):
        return len(self.gaps.get((way, problem, budget), {})) >= seeds

    def of(self, way, problem, budget):
        """The runs of a scan; those of a function where all are there."""
        gaps = list(self.gaps.get((way, problem, budget), {}).values())
        return gaps if len(gaps) >= (SEEDS if problem in PROBLEMS else 1) else []


def by_percent(percent):
    return f"bunny {percent:g} schroeder"


def peers_of(budget):
    return [way for way in PEERS if budget <= SLOW.get(way, budget)]


def measure_functions(store, options):
    library = options.build / "lib/libemax_search_problems.so"
    plan = [(way, problem, budget) for budget in BUDGETS for problem in PROBLEMS
            for way in SEARCHES if way == "emax" or budget in LOOK_AHEAD_BUDGETS]
    for way, problem, budget in plan:
        run_own(store, options, way, problem, budget, SEEDS)
    for budget in BUDGETS:
        for problem in PROBLEMS:
            run_peers(store, options.python, ["--library", library], peers_of(budget), problem, budget, SEEDS)


def measure_ablations(store, options):
    for budget in ABLATION_BUDGETS:
        for problem in PROBLEMS:
            for way in ["emax"] + ABLATIONS:
                run_own(store, options, way, problem, budget, SEEDS)


def measure_published(store, options):
    for problem in PUBLISHED:
        run_own(store, options, ORIGINAL, problem, ORIGINAL_BUDGET, SEEDS)


def measure_scans(store, options):
    for scan in SCANS:
        run_own(store, options, "emax", scan, SCAN_BUDGET, SCAN_SEEDS)
        run_peers(store, options.python, ["--program", own_program(options)], SCAN_PEERS, scan, SCAN_BUDGET, SCAN_SEEDS)
    for percent in RANGE:
        run_own(store, options, "emax", by_percent(percent), SCAN_BUDGET, RANGE_SEEDS)


def measure_scan_ablations(store, options):
    for way in ["emax"] + SCAN_ABLATIONS:
        run_own(store, options, way, SCANS[0], SCAN_BUDGET, SCAN_ABLATION_SEEDS)


def own_program(options):
    return options.build / "bin/emax_search_benchmark"


def run_own(store, options, way, problem, budget, seeds):
    if not store.has(way, problem, budget, seeds):
        store.run([own_program(options), "--ways", way, "--problems", problem, "--budgets", budget, "--seeds", seeds], "emax")


def run_peers(store, python, source, ways, problem, budget, seeds):
    missing = [way for way in ways if not store.has(way, problem, budget, seeds)]
    if python and missing:
        store.run([python, "-B", HERE / "peers/search_peers.py", *source, "--problems", problem, "--ways", *missing,
                   "--budgets", budget, "--seeds", seeds], "peers")


def median(gaps):
    return sorted(gaps)[len(gaps) // 2]


def text_of(gaps):
    """The median, and the share of feasible runs where it is not all of them."""
    if not gaps:
        return "–"
    middle, feasible = median(gaps), sum(math.isfinite(gap) for gap in gaps)
    body = "none" if not math.isfinite(middle) else "0" if abs(middle) < 1e-12 else f"{middle:.2g}"
    return body if feasible == len(gaps) else f"{body} ({feasible}/{len(gaps)})"


def table(store, ways, budget):
    parts = []
    for problems in (FIRST + [STAIRCASE], FURTHER):
        lines = ["| | " + " | ".join(problems) + " |", "|---|" + "---:|" * len(problems)]
        for way in ways:
            cells = [text_of(store.of(way, problem, budget)) for problem in problems]
            lines.append(f"| {way} | " + " | ".join(cells) + " |")
        parts.append("\n".join(lines) + "\n")
    return "\n".join(parts)


def medians_of_peers(store, problem, budget):
    return [median(gaps) for way in PEERS if (gaps := store.of(way, problem, budget))]


def best_or_tied(store, problems, budget):
    """On how many; nothing where runs are missing."""
    count = 0
    for problem in problems:
        own, others = store.of("emax", problem, budget), medians_of_peers(store, problem, budget)
        if not own or len(others) < len(peers_of(budget)):
            return None
        tie = 1e-4 * max(1, abs(store.optima[problem]))
        count += math.isfinite(median(own)) and all(median(own) <= other + tie for other in others)
    return count


def standing(store):
    """On how many functions the search is best or tied, and how many it always solves feasibly."""
    lines = ["| evaluations | best or tied on, of 11 | of the 11 kept apart | feasible in every run on, of 22 | gap on the staircase, of the best peer's |",
             "|---:|---:|---:|---:|---:|"]
    for budget in BUDGETS:
        counts = [best_or_tied(store, problems, budget) for problems in (FIRST, FURTHER)]
        if None in counts:
            continue
        feasible = sum(all(math.isfinite(gap) for gap in store.of("emax", problem, budget)) for problem in FIRST + FURTHER)
        stairs, others = store.of("emax", STAIRCASE, budget), medians_of_peers(store, STAIRCASE, budget)
        ratio = f"{median(stairs) / min(others):.2f}" if stairs and others and min(others) > 0 else "–"
        lines.append(f"| {budget} | {counts[0]} | {counts[1]} | {feasible} | {ratio} |")
    return "\n".join(lines) + "\n"


def triangles(gaps):
    """Median, least and greatest; how many runs were feasible where not all were."""
    if not gaps:
        return "–"
    found = sorted(gap for gap in gaps if math.isfinite(gap))
    if not found:
        return "none"
    if len(gaps) == 1:
        return f"{median(gaps):.0f} (1 run)"
    share = "" if len(found) == len(gaps) else f", {len(found)}/{len(gaps)} feasible"
    runs = "" if len(gaps) == SCAN_SEEDS else f", {len(gaps)} runs"
    return f"{median(gaps):.0f} ({found[0]:.0f}–{found[-1]:.0f}{share}{runs})"


def scan_table(store, ways, scans):
    scans = [scan for scan in scans if store.of("emax", scan, SCAN_BUDGET)]
    lines = ["| | " + " | ".join(scans) + " |", "|---|" + "---:|" * len(scans)]
    for way in ways:
        cells = [triangles(store.of(way, scan, SCAN_BUDGET)) for scan in scans]
        if any(cell != "–" for cell in cells):
            lines.append(f"| {way} | " + " | ".join(cells) + " |")
    return "\n".join(lines) + "\n"


def scan_ablations(store):
    """Run by run, beside the search itself with the same seed; nothing where none was run."""
    def one_run(gap):
        return f"{gap:.0f}" if math.isfinite(gap) else "none"

    gaps = {way: store.gaps.get((way, SCANS[0], SCAN_BUDGET), {}) for way in ["emax"] + SCAN_ABLATIONS}
    seeds = sorted({seed for way in SCAN_ABLATIONS for seed in gaps[way]})
    lines = ["| " + SCANS[0] + " | " + " | ".join(f"seed {seed}" for seed in seeds) + " |", "|---|" + "---:|" * len(seeds)]
    for way, found in gaps.items():
        cells = [one_run(found[seed]) if seed in found else "–" for seed in seeds]
        if any(cell != "–" for cell in cells):
            lines.append(f"| {way} | " + " | ".join(cells) + " |")
    return "\n".join(lines) + "\n" if seeds else ""


def curve(store):
    """The paper's Fig. 3: triangles by the bound."""
    found = [(percent, gaps) for percent in RANGE if (gaps := store.of("emax", by_percent(percent), SCAN_BUDGET))
             if all(math.isfinite(gap) for gap in gaps)]
    if len(found) < 2:
        return []
    line = {"title": f"emax, {SCAN_BUDGET} evaluations", "at": [percent for percent, _ in found],
            "median": [median(gaps) for _, gaps in found], "least": [min(gaps) for _, gaps in found],
            "greatest": [max(gaps) for _, gaps in found]}
    paper = {"title": "the paper's result", "at": [PAPER_PERCENT],
             **{key: [PAPER_TRIANGLES] for key in ("median", "least", "greatest")}}
    return [{"name": "search_bound", "axis": "ε, % of the width", "unit": "triangles",
             "title": "the bunny by its bound", "lines": [line, paper]}]


def published(store):
    lines = ["| | published best | best here | median | runs |", "|---|---:|---:|---:|---:|"]
    for problem, value in PUBLISHED.items():
        gaps = store.of(ORIGINAL, problem, ORIGINAL_BUDGET)
        values = [abs(gap + store.optima[problem]) for gap in (min(gaps), median(gaps))] if gaps else []
        told = " | ".join(f"{value:.7g}" for value in values) or "– | –"
        lines.append(f"| {problem} | {value} | {told} | {len(gaps)} |")
    return "\n".join(lines) + "\n"


EXPLAINED = f"""\
Written by `./dev bench --search`. Every evaluation counts. The functions are g01 to g11, eleven of CEC 2006 that \
were kept apart while the search was developed, and a staircase shaped like the real job, with {SEEDS} runs each, \
beside pagmo's gaco and cstrs_self_adaptive, NLopt's ISRES, COBYLA and SLSQP, and COBYQA. "Tied" is within \
1e-4·max(1, |f*|) of the best peer's median. [{DETAILS}]({DETAILS}) has every median, each strategy left out, and the \
published setting.
"""

SCANS_EXPLAINED = f"""\
Written by `./dev bench --search`: the paper's chain (greedy projection, holes filled, Schroeder's decimation, \
bounded on the points). Each search has {SCAN_BUDGET} evaluations, one after the other, in {SCAN_SEEDS} runs \
unless said. The table has the median of the least triangles within the bound, in brackets the least and the \
greatest. A name gives the scan and ε in percent of the width; of the building 0.5 % of the points may be \
excluded. All searches begin with the standard values. [{DETAILS}]({DETAILS}) has each strategy left out.
"""

SCAN_ABLATIONS_EXPLAINED = f"""\
Triangles after {SCAN_BUDGET} evaluations, run by run. The finish and the first phase have no effect there: no local
search begins where a gene is monotone, and the standard values are feasible.
"""

HEAD = f"""\
# Search, function by function

Written by `./dev bench --search`; [benchmarks.md](benchmarks.md#search) has the summary.

A cell is the median of best feasible − optimum over {SEEDS} runs, in brackets the number of runs that ended feasible, where
not all did. "none": no feasible point in the median run. "–": not measured.

The functions are those of `tests/host/genocop/benchmark_problems.h`, `cec2006_problems.h` and `staircase.h`, in one
library for all optimizers. Equalities hold within 1e-4, a peer's inequalities within 1e-8. Each peer gets the value of
each constraint, linear ones included, as emax does, and the staircase's start point. COBYLA (a start has at most
50 evaluations for each gene and one more), SLSQP (its derivatives are differences, which are evaluations) and COBYQA
begin anew at random points until all evaluations are spent; COBYQA takes hours for more than 1,000.
Every optimizer knows every earlier result, except in the row that looks ahead.
"""


def functions_section(store):
    return "\n".join(["## Search\n", EXPLAINED, standing(store)])


def scans_section(store, plots):
    parts = ["## Search on scans\n", SCANS_EXPLAINED, scan_table(store, ["emax"] + SCAN_PEERS, SCANS)]
    if plots:
        parts.append(f"The paper's chain on the bunny by its bound (the paper's Fig. 3; it gives {PAPER_TRIANGLES} triangles at "
                     f"{PAPER_PERCENT} %):\n\n![{plots[0]['title']}](plots/{plots[0]['name']}.svg)\n")
    return "\n".join(parts)


def functions_details(store):
    parts = [f"{store.versions}.\n"]
    for budget in BUDGETS:
        ways = SEARCHES if budget in LOOK_AHEAD_BUDGETS else SEARCHES[:1]
        parts += [f"## {budget} evaluations\n", table(store, ways + PEERS, budget)]
    return "\n".join(parts)


def ablations_details(store):
    parts = ["## Each strategy left out\n", "The last rows replace one part by its published form.\n"]
    for budget in ABLATION_BUDGETS:
        parts += [f"{budget} evaluations:\n", table(store, ["emax"] + ABLATIONS, budget)]
    return "\n".join(parts)


def published_details(store):
    return "\n".join(["## The published Genocop III\n",
                      f"`Settings::original()`, {ORIGINAL_BUDGET} evaluations; the first phase finds the first feasible point.\n",
                      published(store)])


def scan_ablations_details(store):
    return "\n".join(["## Each strategy left out on a scan\n", SCAN_ABLATIONS_EXPLAINED, scan_ablations(store)])


# What is measured on its own: how, the ways and problems whose runs show that it was, and its part of the details.
PARTS = {
    "functions": (measure_functions, PEERS, PROBLEMS, functions_details),
    "ablations": (measure_ablations, ABLATIONS, PROBLEMS, ablations_details),
    "published": (measure_published, [ORIGINAL], PROBLEMS, published_details),
    "scans": (measure_scans, SCAN_PEERS, SCANS, None),
    "scan-ablations": (measure_scan_ablations, SCAN_ABLATIONS, SCANS, scan_ablations_details),
}


def main(words, python):
    parser = argparse.ArgumentParser(prog="./dev bench --search", description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--only", choices=PARTS, help="measure this part")
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
        for part in [options.only] if options.only else PARTS:
            PARTS[part][0](store, options)
    write(store, python)


def write(store, python):
    """The parts that were measured; what stands of another one stays."""
    measured = [part for part, (_, ways, problems, _) in PARTS.items()
                if any(store.of(way, problem, budget) for way in ways for problem in problems
                       for budget in BUDGETS + [ORIGINAL_BUDGET])]
    if not measured:
        sys.exit(f"{store.folder} holds no whole set of runs, so nothing is written; ./dev bench --search measures them")
    if "functions" in measured:
        sections.put("search", functions_section(store))
    file = sections.DOCUMENT.with_name(DETAILS)
    details = [sections.marked(part, write_details(store)) if part in measured else sections.existing(part, file)
               for part, (*_, write_details) in PARTS.items() if write_details]
    sections.write(file, "\n".join([HEAD] + [part for part in details if part]))
    if "scans" not in measured:
        return
    plots = curve(store)
    sections.put("scans", scans_section(store, plots))
    if plots and python:
        file = store.folder / "curves.json"
        file.write_text(json.dumps(plots))
        PLOTS.mkdir(exist_ok=True)
        subprocess.run([python, "-B", HERE / "peers/plot.py", file, PLOTS], check=True)
