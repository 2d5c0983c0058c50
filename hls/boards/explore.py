"""`./dev explore`: searches the designs of a board by a model, and routes the best few.

Single operators are placed and routed with Yosys and nextpnr; a model of area and clock is fitted to them and
to the designs of `./dev synth`; every design of the space is predicted; docs/exploration.md gets what no
other design surpasses. What has not changed is not measured again.
"""

import argparse
import re
import sys
import threading
import time
from dataclasses import replace
from pathlib import Path

from exploration import anchors, candidates, document, frontier, model, operators, pipelines, routing, space
from synthesis.tools import Background, Failure, Runner, minutes, run_command
from synthesize import Ecp5

BASELINE = Path("hls/boards/synthesis_baseline.json")
DOCUMENT, SYNTHESIS = Path("docs/exploration.md"), Path("docs/synthesis.md")
TARGET = 200.0  # MHz asked of an operator, as by ./dev synth
# Of one core of a 2-core machine: an operator, in the mean; the exact core and the board, mapped by Yosys.
OPERATOR_SECONDS, MAPPING_MINUTES = 20, 5
OPERATORS = {"full": 29, "quick": 15}  # about as many as the pipelines of the space have
STEP = 0.02  # by which pairs a second rise from row to row of the page
ROUTED, LIMIT = 2, 60  # boards, and minutes after which one is given up


class Countdown:
    """Says after each measurement how many there are and how long the others take, by those that were not
    taken from an earlier run."""

    def __init__(self, runner, total, at_once):
        self.runner, self.total, self.at_once = runner, total, at_once
        self.lock = threading.Lock()
        self.done, self.took, self.ran = 0, 0.0, 0

    def count(self, seconds):
        with self.lock:
            self.done += 1
            if seconds > 1:
                self.took, self.ran = self.took + seconds, self.ran + 1
            self.runner.say(f"{self.done} of {self.total} operators measured, about {minutes(self.left())} left")

    def left(self):
        each = self.took / self.ran if self.ran else OPERATOR_SECONDS
        return (self.total - self.done) * each / self.at_once


def wanted(axes, lowered):
    """The operators that the pipelines of the space and of the anchors have, whatever their delays and widths."""
    axes = replace(axes, delays=(space.STANDARD_DELAYS,), widths=(space.BUILT_WIDTH,))
    options = [*space.exact_options(axes), *space.filter_options(axes), anchors.EXACT, anchors.FILTER,
               *(space.Options(form) for form in anchors.lowered.FORMS)]
    found = {operator for each in options for operator, _ in lowered(each).operators}
    return [*sorted(found), *operators.DELAYS]


def in_background(runner, *functions):
    """Runs the functions beside each other, until all have ended or one has failed."""
    work = Background(runner)
    for function in functions:
        work.start(function)
    try:
        work.wait(30 if not sys.stdout.isatty() else 15)
    except KeyboardInterrupt:
        runner.stop()
        raise


def measure(runner, options, lowered):
    """({operator: figures}, anchors)."""
    whole = anchors.placed(BASELINE, runner.versions, lowered)  # first, as it fails before anything takes time
    runner.say("reading the operators of the lowered pipelines")
    chosen = wanted(options.axes, lowered)
    runner.say(f"{len(chosen)} operators to measure, with seed {operators.SEED}")
    countdown = Countdown(runner, len(chosen), options.jobs)
    measured = dict.fromkeys(chosen)  # in this order, whichever ends first
    pending = iter(chosen)

    def work():
        for operator in pending:
            start = time.monotonic()
            result = Ecp5(runner, operators.design(operator, TARGET), 1, 1).run()
            measured[operator] = {**result["figures"], "cells": result["cells"]}
            countdown.count(time.monotonic() - start)

    in_background(runner, *[work] * options.jobs)
    in_background(runner, lambda: whole.extend(anchors.mapped(runner, lowered)))
    of_bitstream = anchors.of_bitstream(SYNTHESIS.read_text(), runner.versions, lowered, measured)
    if not of_bitstream:
        runner.say(f"{SYNTHESIS} has no board of these tools, so no clock of a full device is fitted; ./dev bitstream makes one")
    return measured, [*whole, *of_bitstream]


def fitted(measured, measured_designs, board):
    """The model. Raises Failure where it and a measurement are too far apart."""
    result = model.fit(measured_designs, measured, board.capacity)
    faults = model.doubts(result, measured_designs)
    if faults:
        raise Failure("\n".join([*faults, "a measurement or the model is wrong; ./dev explore --fresh measures again"]))
    return result


def route(runner, chosen, limit):
    """[(candidate, figures or None)]"""
    found = []
    for number, each in enumerate(chosen):
        runner.say(f"board {number + 1} of {len(chosen)}: {each.exact_elements} exact, {each.filter_elements} of the filter;"
                   f" at most about {(len(chosen) - number) * (MAPPING_MINUTES + limit)} min left")
        in_background(runner, lambda each=each: found.append((each, routing.route(runner, each, limit))))
    return found


def numbers(text):
    """1+2 as (1, 2)."""
    found = re.fullmatch(r"(\d+)\+(\d+)", text)
    if found is None:
        raise argparse.ArgumentTypeError(f"'{text}' is not E+F, as 1+2")
    return int(found[1]), int(found[2])


def arguments():
    parser = argparse.ArgumentParser(
        prog="./dev explore", description="Measures single operators with Yosys and nextpnr, fits a model of area and clock to"
        " them and to the designs of ./dev synth, predicts every design of the space, routes the best few, and writes"
        " docs/exploration.md. Logs and results stay in build/synth, and what has not changed since is taken from"
        " there.")
    parser.add_argument("board", choices=sorted(space.BOARDS), help="ULX3S with an ECP5-85F")
    parser.add_argument("--route", type=int, default=ROUTED, metavar="N", help=f"place and route the best N ({ROUTED})")
    parser.add_argument("--elements", type=numbers, action="append", default=[], metavar="E+F", help="route the best board of E"
                        " exact elements and F of the filter instead, as 1+2; may be repeated")
    parser.add_argument("--limit", type=int, default=LIMIT, metavar="MIN",
                        help=f"minutes after which a placement is given up ({LIMIT})")
    parser.add_argument("--jobs", type=int, default=2, metavar="N", help="tools run at a time (2; each wants a core and 2 GB)")
    parser.add_argument("--quick", action="store_true", help="few operators, no routing; prints, and writes no document")
    parser.add_argument("--fresh", action="store_true", help="run every step again")
    parser.add_argument("--plan", action="store_true", help="say what would be measured and how long it takes, and stop")
    options = parser.parse_args()
    if min(options.limit, options.jobs) < 1 or options.route < 0:
        parser.error("--limit and --jobs must be positive, --route 0 or more")
    options.axes = space.QUICK if options.quick else space.FULL
    options.route = 0 if options.quick else len(options.elements) or options.route
    return options


def plan(options):
    count = OPERATORS["quick" if options.quick else "full"]
    measuring = -(-count * OPERATOR_SECONDS // (60 * options.jobs))
    text = (f"about {count} operators, {measuring} min with {options.jobs} at a time; the exact core and the board, mapped,"
            f" {MAPPING_MINUTES} min; {space.size(options.axes):,} designs predicted, 1 min")
    if options.route:
        text += f"; {options.route} boards placed and routed, at most {MAPPING_MINUTES} + {options.limit} min each"
    return f"{text}; what has not changed is not run again"


def main():
    options = arguments()
    if options.plan:
        print(f"explore: {plan(options)}", flush=True)
        return 0
    board = space.BOARDS[options.board]
    lowered = pipelines.Lowered()
    runner = Runner(options.jobs, options.fresh, name="explore")
    runner.prepare()
    measured, whole = measure(runner, options, lowered)
    made = fitted(measured, whole, board)
    runner.say(f"predicting {space.size(options.axes):,} designs")
    found, fitting = candidates.frontier(options.axes, lowered, board, made)
    if not found:
        raise Failure(f"no design fits the {board.device} and meets a clock of {board.clocks[0]} MHz")
    shown = frontier.thinned(found, lambda each: each.pairs, STEP)
    print(f"\n{document.frontier_table(shown)}\n\n{document.anchor_section(made, whole)}", flush=True)
    chosen = frontier.best_few(found, options.route, options.elements if options.route else ())
    if options.quick:
        runner.say(f"quick: {DOCUMENT} is not written")
        return 0
    routed = route(runner, chosen, options.limit)
    DOCUMENT.write_text(document.page(options.board, board, options.axes, made, whole, (found, fitting), shown, routed,
                                      options.limit, runner.versions, STEP))
    runner.say(f"{DOCUMENT} written")
    return 0


if __name__ == "__main__":
    run_command("explore", main)
