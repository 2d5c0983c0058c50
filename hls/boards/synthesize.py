"""`./dev synth`: synthesizes operators, the element, the filter and the forms of the distance with open tools.

Yosys and nextpnr place and route for ECP5-85F and the filter for Lattice Nexus; for 7-series and
UltraScale+ Yosys maps and counts alone.
Writes docs/synthesis.md and compares with the checked-in baseline.
"""

import argparse
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

from synthesis import baseline, comparison, contracts, designs, document, lowered, netlists
from synthesis.tools import FOLDER, Background, Failure, Runner, run_command

# The sections, the longest first, and their families.
SECTIONS = {"element": "ecp5", "forms": "ecp5", "operators": "ecp5", "filter": "ecp5", "nexus": "nexus", "xilinx": "xilinx"}
FORM_FIGURES = ["multiplications", "additions", "latency", "delay_bits"]
DATAPATH = designs.GENERATED / "emax_distance.sv"
BASELINE = Path("hls/boards/synthesis_baseline.json")
DOCUMENT = Path("docs/synthesis.md")
TARGET = 175.0  # MHz, of the element and the forms
OPERATOR_TARGET = 200.0  # in a crowded element an operator loses up to a seventh of its speed
NEXUS_TARGET = 120.0  # MHz, the clock of the ULX3S
# Minutes of one core for a section at one seed, from a run on a 2-core machine.
EXPECTED = {"element": 9, "forms": 36, "operators": 5, "filter": 12, "nexus": 6, "xilinx": 6}
SEED_MINUTES = 6
FILTER_ELEMENTS = [1, 4]
NEXTPNR = []


class Ecp5:
    """Places and routes a design in its register shell with several seeds."""

    family, make = "ecp5", staticmethod(netlists.ecp5)

    def __init__(self, runner, design, seeds, at_once):
        self.runner, self.design, self.seeds, self.at_once = runner, design, seeds, at_once
        self.folder = f"{self.family}/{netlists.slug(design.name)}"

    def run(self):
        design, runner = self.design, self.runner
        netlist, cells, _ = self.make(runner, design)
        # Seeds are judged in order, so that the result does not depend on how many run at once.
        tried = []
        for first in range(1, self.seeds + 1, self.at_once):
            batch = range(first, min(first + self.at_once, self.seeds + 1))
            with ThreadPoolExecutor(len(batch)) as pool:
                for seed, result in zip(batch, pool.map(lambda s: self._route(netlist, cells, s), batch)):
                    if not any(figures["fmax"] >= design.target for _, figures, _ in tried):
                        tried.append((seed, *result))
            if tried[-1][1]["fmax"] >= design.target:
                break
        seed, figures, detail = max(tried, key=lambda t: (t[1]["fmax"], -t[0]))
        return {"figures": figures, **detail, "target": design.target, "seed": seed,
                "tried": {str(seed): figures["fmax"] for seed, figures, _ in tried}}

    def _route(self, netlist, cells, seed):
        report, log = self.runner.step(
            "nextpnr", f"{self.design.name}, place and route with seed {seed}", f"{self.folder}/seed{seed}",
            ["--85k", "--speed", "6", "--package", "CABGA381", "--lpf-allow-unconstrained", "--timing-allow-fail",
             "--freq", f"{self.design.target:g}", "--seed", str(seed), *NEXTPNR, "--json", str(netlist),
             "--report", "{folder}/report.json"], [netlist], ["report.json", "nextpnr.log"])
        figures, detail = designs.ecp5_figures(report, log, cells)
        self.runner.say(f"{self.design.name}, seed {seed}: {figures['fmax']:.1f} MHz of {self.design.target:g}")
        return figures, detail


class Nexus(Ecp5):
    """The same for Lattice Nexus."""

    family, make = "nexus", staticmethod(netlists.nexus)

    def _route(self, netlist, cells, seed):
        constraints = FOLDER / self.folder / "shell.pdc"
        constraints.write_text(designs.nexus_constraints())
        (report,) = self.runner.step(
            "nextpnr-nexus", f"{self.design.name}, place and route with seed {seed}", f"{self.folder}/seed{seed}",
            ["--device", designs.NEXUS_DEVICE, "--pdc", str(constraints), "--timing-allow-fail",
             # The default, router2, of nextpnr 0.11.1 keeps a clock's way to its buffer from being routed.
             "--router", "router1",
             "--freq", f"{self.design.target:g}", "--seed", str(seed), "--json", str(netlist),
             "--report", "{folder}/report.json"], [netlist, constraints], ["report.json"])
        figures, detail = designs.nexus_figures(report, cells)
        self.runner.say(f"{self.design.name}, seed {seed}: {figures['fmax']:.1f} MHz of {self.design.target:g}")
        return figures, detail


def run_xilinx(runner, design, family):
    netlist, _ = netlists.xilinx(runner, design, family)
    figures, detail = designs.xilinx_figures(netlist)
    return {"figures": figures, **detail}


def place_form(runner, form, target):
    design, report = lowered.form(form, target)
    return {**Ecp5(runner, design, 1, 1).run(), "report": report}


def arguments():
    parser = argparse.ArgumentParser(
        prog="./dev synth", description="Synthesizes operators, element and forms with Yosys and nextpnr;"
        " a full run writes docs/synthesis.md, one of families their sections. Logs and results stay in build/synth, and what has not"
        " changed since is taken from there.")
    parser.add_argument("--only", choices=SECTIONS, action="append", help="this section alone; may be repeated")
    parser.add_argument("--family", choices=sorted(set(SECTIONS.values())), action="append",
                        help="the sections of this family alone; may be repeated")
    parser.add_argument("--seeds", type=int, default=6, metavar="N", help="at most N placements of the element (6)")
    parser.add_argument("--target", type=float, default=TARGET, metavar="MHZ",
                        help="of the element and the forms (175)")
    parser.add_argument("--jobs", type=int, default=2, metavar="N", help="tools at a time (2; each wants a core and 2 GB)")
    parser.add_argument("--quick", action="store_true", help="operators and the element, one seed; no document")
    parser.add_argument("--fresh", action="store_true", help="run every step again")
    parser.add_argument("--plan", action="store_true", help="say what would be done and how long it takes, and stop")
    parser.add_argument("--update-baseline", action="store_true", help="take the figures as the new baseline")
    options = parser.parse_args()
    if min(options.seeds, options.jobs) < 1 or options.target <= 0:
        parser.error("--seeds, --jobs and --target must be positive")
    if options.quick:
        options.only, options.seeds = options.only or ["element", "operators"], 1
    options.all_of_family = bool(options.family) and not options.only and options.target == TARGET
    options.complete = not options.only and not options.family and options.target == TARGET
    options.only = [name for name, family in SECTIONS.items()
                    if name in (options.only or SECTIONS) and family in (options.family or SECTIONS.values())]
    if not options.only:
        parser.error("no section of --only is of a --family that was given")
    return options


def measure(runner, options):
    """{section: {subject: result}}. Every subject has a thread of its own; the runner limits how many run
    at once, in the order of their start."""
    results = {section: {} for section in options.only}
    work = Background(runner)

    def start(section, name, function, *args):
        results[section][name] = None  # keeps the order
        work.start(lambda: results[section].update({name: function(*args)}))

    element = designs.element(options.target)
    operators = designs.operators(DATAPATH, OPERATOR_TARGET)
    if "element" in options.only:
        alone = options.jobs if len(options.only) == 1 else 1
        start("element", element.name, Ecp5(runner, element, options.seeds, alone).run)
    if "forms" in options.only:
        for form in lowered.FORMS:
            start("forms", form, place_form, runner, form, options.target)
    if "operators" in options.only:
        for operator in operators:
            start("operators", operator.name, Ecp5(runner, operator, 1, 1).run)
    if "filter" in options.only:
        for elements in FILTER_ELEMENTS:
            core = designs.filter_core(elements, options.target)
            start("filter", core.name, Ecp5(runner, core, 1, 1).run)
    if "nexus" in options.only:
        core = designs.filter_core(1, NEXUS_TARGET)
        start("nexus", core.name, Nexus(runner, core, 1, 1).run)
    if "xilinx" in options.only:
        for family in netlists.FAMILIES:
            for design in [lowered.xilinx_element(options.target), *operators]:
                start("xilinx", f"{design.name}, {netlists.FAMILIES[family]}", run_xilinx, runner, design, family)
    try:
        work.wait(30 if not sys.stdout.isatty() else 15)
    except KeyboardInterrupt:
        runner.stop()
        raise
    return results


def drive(runner, options):
    """Drives the netlists of the sections beside the model (comparison.drive): {name: verdict}."""
    operators = designs.operators(DATAPATH, OPERATOR_TARGET)
    element = designs.element(options.target)
    wanted = {}  # the program of testbench/netlists: the netlists that were placed or counted
    if "element" in options.only:
        wanted["element_ecp5"] = [(netlists.ecp5(runner, element)[-1], element.top)]
    if "operators" in options.only:
        wanted["operators_ecp5"] = [(netlists.ecp5(runner, o)[-1], f"{o.top}_netlist") for o in operators]
    if "filter" in options.only:
        for elements in FILTER_ELEMENTS:
            core = designs.filter_core(elements, options.target)
            wanted[f"filter{elements}_ecp5"] = [(netlists.ecp5(runner, core)[-1], core.top)]
    if "nexus" in options.only:
        core = designs.filter_core(1, NEXUS_TARGET)
        wanted["filter1_nexus"] = [(netlists.nexus(runner, core)[-1], core.top)]
    if "xilinx" in options.only:
        for family in netlists.FAMILIES:
            wanted[f"operators_{family}"] = [(netlists.xilinx(runner, o, family)[-1], f"{o.top}_netlist")
                                             for o in operators]
            counted = lowered.xilinx_element(options.target)
            wanted[f"element_{family}"] = [(netlists.xilinx(runner, counted, family)[-1], counted.top)]
    if "forms" in options.only:
        for name in lowered.FORMS:
            design, _ = lowered.form(name, options.target)
            wanted[f"form_{name}_ecp5"] = [(netlists.ecp5(runner, design)[-1], "form_netlist")]
    said = {}
    for name, parts in wanted.items():
        runner.say(f"{name}: driving the netlist beside the model")
        said[name] = comparison.drive(name)
        comparison.holds(name, [netlists.renamed(path, top) for path, top in parts])
        runner.say(f"{name}: {said[name]}")
    return said


def flat(results):
    """{subject: figures} for the baseline."""
    figures = {}
    for section, subjects in results.items():
        for name, result in subjects.items():
            figures[f"{section}: {name}"] = {
                **result["figures"],
                **{key: result["report"][key] for key in FORM_FIGURES if "report" in result}}
    return figures


def plan(options):
    """One line with the sections and the minutes that they take without results of earlier runs."""
    each = {section: EXPECTED[section] for section in options.only}
    total = max(max(each.values()), -(-sum(each.values()) // options.jobs))
    text = ", ".join(f"{section} {time} min" for section, time in each.items())
    if "element" in each and options.seeds > 1:
        text += f"; up to {options.seeds - 1} further seeds of the element, {SEED_MINUTES} min each"
    return f"{text}; together about {total} min, {options.jobs} at a time; what has not changed is not run again"


def write_document(runner, options, results, driven):
    """Writes the page after a full run, and after one of whole families their sections."""
    before = DOCUMENT.read_text() if DOCUMENT.exists() else ""
    if options.complete:
        text = document.page(results, runner.versions, baseline.TOLERANCES, driven, document.boards_of(before))
    elif options.all_of_family:
        text = document.with_sections(before, results, runner.versions, baseline.TOLERANCES, driven)
    else:
        return
    if text is None:
        runner.say(f"{DOCUMENT} is of other versions of the tools, and is left as it is; a full run writes it")
        return
    DOCUMENT.write_text(text)
    runner.say(f"{DOCUMENT} written")


def main():
    options = arguments()
    if options.plan:
        print(f"synth: {plan(options)}", flush=True)
        return 0
    runner = Runner(options.jobs, options.fresh)
    runner.prepare()
    contracts.check(runner)
    results = measure(runner, options)
    driven = drive(runner, options)
    print("\n" + document.tables(results))
    measured, versions = flat(results), runner.versions
    write_document(runner, options, results, driven)
    if options.update_baseline:
        baseline.write(BASELINE, versions, measured, options.complete)
        runner.say(f"{BASELINE} written")
        return 0
    known = baseline.read(BASELINE)
    if baseline.key(versions) not in known:
        raise Failure(f"{BASELINE} has no figures of {baseline.key(versions)};"
                      " ./dev synth --update-baseline takes these figures as the baseline")
    faults = baseline.compare(measured, known[baseline.key(versions)], options.complete)
    if faults:
        raise Failure("\n".join([*faults, "worse than the baseline: correct it, or take the new figures with"
                                 " ./dev synth --update-baseline"]))
    runner.say("no figure is worse than its baseline")
    return 0


if __name__ == "__main__":
    run_command("synth", main)
