"""`./dev bitstream`: a board's bitstream with Yosys, nextpnr and ecppack.

Places the design with several seeds, gives up those placements of which nextpnr expects too little, and
routes the others, the best first, until the clock is met, 90 MHz or the one that is asked for. Writes the
bitstream to build/bitstream and its figures into docs/synthesis.md. It writes no bitstream that misses its
clock, and none of a design that differed from its source in simulation, as Yosys synthesized it or as nextpnr
routed it.
"""

import argparse
import re
import shutil
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

from synthesis import blocks, comparison, designs, document, netlists, routed, tools
from synthesis.tools import Background, Failure, Runner, TookTooLong, run_command

FOLDER = Path("build/bitstream")
DOCUMENT = Path("docs/synthesis.md")
# The files of a board's pins.
PINS = {"ulx3s": [designs.ULX3S / "ulx3s.lpf"], "ulx3s-sdram": [designs.ULX3S / "ulx3s.lpf", designs.ULX3S / "ulx3s_sdram.lpf"]}
FIRST_SEED, SEEDS = 2, 1
# Minutes of one core of a 2-core machine.
SYNTHESIS_MINUTES, LOCKSTEP_MINUTES, PLACEMENT_MINUTES, ROUTE_MINUTES = 3, 13, 7, 4
# Some placements are never routed.
SEED_LIMIT = 40
CLOCK = 90  # MHz; what is met with that seed
# Of the clock: a placement of which nextpnr expects less is given up.
LEAST_PROMISE = 0.6
# The router is asked for so much of the clock, because it ends as soon as it believes the clock to be met.
MARGIN = 1.006
# Sent into the netlist: frames, damaged ones included, and blocks whose answers must be right.
DRIVEN = ["--frames", 30, "--blocks", 6]


def device(target, board="ulx3s"):
    """nextpnr's arguments for the FPGA with the board's pins."""
    pins = [argument for path in PINS[board] for argument in ("--lpf", str(path))]
    return ["--85k", "--speed", "6", "--package", "CABGA381", "--timing-allow-fail", "--freq", f"{target:g}", *pins]


def placement(netlist, seed, target, placer="static", board="ulx3s"):
    """nextpnr's arguments for a placement with the board's pins. Its file tells the router too, which the
    arguments of the run that reads it do not."""
    return [*device(target, board), "--placer", placer,  # static: shorter wires than the default's (docs/decisions/0007)
            "--router", "router2",  # ten times as fast as router1 (docs/decisions/0044)
            "--seed", str(seed), "--json", str(netlist)]


def build(runner, options, results):
    sdram = options.board == "ulx3s-sdram"
    design = designs.ulx3s(options.elements, options.clock, sdram)
    clock = f"at{options.clock}" if options.clock != designs.ULX3S_CLOCK else ""
    name = f"board{options.elements}{'sdram' if sdram else ''}{clock}"
    folder = f"{options.board}/{options.elements}{clock}"
    netlist, text = netlists.ecp5_top(runner, design)
    driven = {"synthesized": drive(runner, f"{name}_ecp5", netlists.renamed(text, design.top))}

    def place(seed):
        """The placement with this seed, and what nextpnr expects of it."""
        given = with_blocks(netlist, f"{folder}/seed{seed}", seed)
        log, placed = runner.step(
            "nextpnr", f"{design.name}, placement with seed {seed}", f"{folder}/seed{seed}/placement",
            [*placement(given, seed, options.clock, board=options.board), "--no-route", "--write", "{folder}/placed.json"],
            [given, *PINS[options.board]], ["nextpnr.log", "placed.json"])
        promise = designs.promised(log)
        runner.say(f"{design.name}, seed {seed}: {promise[0]:.1f} MHz expected, wires of {promise[1]:,}")
        return {"seed": seed, "promise": promise, "placed": placed, "log": log}

    def route(placement):
        """The placement with the figures of its routing; None if it was not routed within the limit."""
        seed = placement["seed"]
        given = for_router(placement["placed"], MARGIN * options.clock)
        try:
            report, config, design_routed = runner.step(
                "nextpnr", f"{design.name}, route of seed {seed}", f"{folder}/seed{seed}/route",
                [*device(options.clock, options.board), "--json", str(given), "--no-pack", "--no-place",
                 "--tmg-ripup",  # routes again what is late (docs/decisions/0044)
                 "--textcfg", "{folder}/routed.config", "--report", "{folder}/report.json", "--write", "{folder}/routed.json"],
                [given, *PINS[options.board]], ["report.json", "routed.config", "routed.json"],
                60 * options.limit)
        except TookTooLong as failure:
            runner.say(f"{failure}; the router may never end with this placement")
            return None
        figures, detail = designs.board_figures(report, placement["log"])
        runner.say(f"{design.name}, seed {seed}: {figures['fmax']:.1f} MHz of {options.clock}")
        return {"figures": figures, **detail, **placement, "config": config, "routed": design_routed}

    seeds = range(options.first_seed, options.first_seed + options.seeds)
    with ThreadPoolExecutor(options.jobs) as pool:
        placements = list(pool.map(place, seeds))
    chosen = worth_routing(placements, options.clock)
    tried = first_that_meets(route, chosen, options.jobs, options.clock)
    if not any(tried):
        raise Failure(f"no placement of {len(placements)} was routed within {options.limit} min:"
                      " try more --seeds or a greater --limit")
    best = max(filter(None, tried), key=lambda result: result["figures"]["fmax"])
    best.update(elements=options.elements, target=options.clock, driven=driven, top=design.top,
                promised={str(each["seed"]): each["promise"] for each in placements},
                tried={str(each["seed"]): result and result["figures"]["fmax"] for each, result in zip(chosen, tried)})
    if best["figures"]["fmax"] >= options.clock:
        module = routed.rejoined(routed.read(best["routed"]), routed.read(best["placed"]))
        text = routed.verilog(module, design.top)
        netlists.write(tools.FOLDER / folder / "routed.v", text)
        driven["routed"] = drive(runner, f"{name}_routed", text)
        (best["bitstream"],) = runner.step(
            "ecppack", f"{design.name}, bitstream", f"{folder}/bitstream",
            ["--compress", "--input", str(best["config"]), "--bit", f"{{folder}}/{options.board}.bit"], [best["config"]],
            [f"{options.board}.bit"])
    results.append(best)


def with_blocks(netlist, folder, seed):
    """The path of the netlist with places for its multipliers and block RAMs."""
    given = tools.FOLDER / folder / "netlist.json"
    given.parent.mkdir(parents=True, exist_ok=True)
    netlists.write(given, blocks.with_places(netlist.read_text(), seed))
    return given


def for_router(placed, clock):
    """The path of the placement with this clock as what the router has to meet, which it takes from there and not
    from its arguments."""
    text, count = re.subn(r'"target_freq": "[\d.]+"', f'"target_freq": "{1e6 * clock:.6f}"', placed.read_text())
    if count != 1:
        raise Failure(f"{placed} names {count} clocks for the router, not one")
    given = placed.with_name("for_router.json")
    netlists.write(given, text)
    return given


def worth_routing(placements, clock):
    """The placements to be routed, the most promising first. Raises Failure where none is worth it."""
    chosen = sorted((each for each in placements if each["promise"][0] >= LEAST_PROMISE * clock),
                    key=lambda each: each["promise"], reverse=True)
    if not chosen:
        best = max(each["promise"][0] for each in placements)
        raise Failure(f"no placement is worth routing: {best:.1f} MHz is the most that nextpnr expects of {len(placements)},"
                      f" and the board's clock is {clock} MHz; try more --seeds or a slower --clock")
    return chosen


def drive(runner, name, text):
    """Drives a netlist of the board and returns what was compared. Raises Failure unless the netlist is
    this text and behaves as its source does."""
    runner.say(f"{name}: driving the whole netlist in lockstep with its source, about {LOCKSTEP_MINUTES} min")
    driven = comparison.drive(name, DRIVEN)
    comparison.holds(name, [text])
    runner.say(f"{name}: {driven}")
    return driven


def first_that_meets(route, placements, at_once, target):
    """Results of route(placement), in the order of the placements, up to the first whose fmax is the target.
    A result may be None."""
    tried = []
    for first in range(0, len(placements), at_once):
        batch = placements[first:first + at_once]
        with ThreadPoolExecutor(len(batch)) as pool:
            for result in pool.map(route, batch):
                tried.append(result)
                if result and result["figures"]["fmax"] >= target:
                    return tried
    return tried


def arguments():
    parser = argparse.ArgumentParser(
        prog="./dev bitstream", description="Makes build/bitstream/BOARD.bit with Yosys, nextpnr and ecppack and"
        " writes its figures into docs/synthesis.md. Before that the design is simulated in lockstep with its source,"
        " as synthesized and as routed. Logs and results stay in build/synth, and what has not"
        " changed since is taken from there.")
    parser.add_argument("board", choices=PINS, help="ULX3S with an ECP5-85F, its store in block RAM or in its SDRAM")
    parser.add_argument("--elements", type=int, default=1, metavar="N", help="exact elements, beside four of the filter (1)")
    parser.add_argument("--clock", type=int, choices=[90, 105, 120], default=CLOCK, metavar="MHZ",
                        help=f"the board's clock, 90, 105 or 120 ({CLOCK})")
    parser.add_argument("--seeds", type=int, default=SEEDS, metavar="N",
                        help=f"place N times, and route the best first ({SEEDS})")
    parser.add_argument("--first-seed", type=int, default=FIRST_SEED, metavar="S", help=f"and the seed of the first ({FIRST_SEED})")
    parser.add_argument("--limit", type=int, default=SEED_LIMIT, metavar="MIN", help="minutes after which a placement that is"
                        f" not routed is given up ({SEED_LIMIT})")
    parser.add_argument("--jobs", type=int, default=1, metavar="N", help="placements at a time (1; each wants a core and 3 GB)")
    parser.add_argument("--fresh", action="store_true", help="run every step again")
    parser.add_argument("--plan", action="store_true", help="say what would be done and how long it takes, and stop")
    options = parser.parse_args()
    most = 2 if options.board == "ulx3s" else 1
    if options.elements > most:
        parser.error(f"--elements must be at most {most}: testbench/netlists drives the netlists of these alone")
    if min(options.elements, options.seeds, options.first_seed, options.limit, options.jobs) < 1:
        parser.error("--elements, --seeds, --first-seed, --limit and --jobs must be positive")
    return options


def main():
    options = arguments()
    target = FOLDER / f"{options.board}.bit"
    if options.plan:
        print(f"bitstream: {target} with {options.elements} elements: synthesis about {SYNTHESIS_MINUTES} min,"
              f" its netlist in lockstep with the source {LOCKSTEP_MINUTES} min, then"
              f" {options.seeds} placements of about {PLACEMENT_MINUTES} min and up to as many routings of about {ROUTE_MINUTES} min,"
              f" {options.jobs} at a time, and the one that is used in lockstep with the source, {LOCKSTEP_MINUTES} min;"
              " what has not changed is not run again", flush=True)
        return 0
    runner = Runner(options.jobs, options.fresh, name="bitstream")
    runner.prepare()
    results = []
    work = Background(runner)
    work.start(build, runner, options, results)
    try:
        work.wait(30 if not sys.stdout.isatty() else 15)
    except KeyboardInterrupt:
        runner.stop()
        raise
    (result,) = results
    section = document.board_section(options.board, result, runner.versions)
    print("\n" + section)
    if "bitstream" not in result:
        target.unlink(missing_ok=True)
        raise Failure(f"no bitstream: {result['figures']['fmax']:.1f} MHz is the best of {len(result['tried'])} routed placements,"
                      f" and the board's clock is {options.clock} MHz; try more --seeds or a slower --clock")
    FOLDER.mkdir(parents=True, exist_ok=True)
    shutil.copyfile(result["bitstream"], target)
    DOCUMENT.write_text(document.with_boards(DOCUMENT.read_text(), section))
    runner.say(f"{target} and its section in {DOCUMENT} written")
    return 0


if __name__ == "__main__":
    run_command("bitstream", main)
