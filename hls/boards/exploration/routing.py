"""Chosen designs as boards, placed and routed with the board's pins."""

import hashlib
import re

import bitstream
from synthesis import designs, netlists
from synthesis.tools import FOLDER, Failure, TookTooLong

from . import operators, pipelines

SEED = 1
# With a filter of two elements the static placer stops moving a fifth of the block RAMs, which overlap.
PLACER = "heap"
MODULES = {"exact": ("emax_distance", designs.GENERATED, designs.RTL / "emax_element.sv"),
           "filter": ("emax_filter", designs.RTL / "filter/generated", designs.RTL / "filter/filter_element.sv")}


def slug(candidate):
    """A name that tells candidates apart."""
    text = repr((candidate.exact, candidate.filter, candidate.exact_elements, candidate.filter_elements))
    return f"{candidate.exact_elements}_{candidate.filter_elements}_{hashlib.sha256(text.encode()).hexdigest()[:8]}"


def with_schedule(source, schedule):
    """The text of an element with the lines of a schedule's header in place of its `include`."""
    lines = source.splitlines(keepends=True)
    places = [i for i, line in enumerate(lines) if line.startswith("`include") and "_schedule.svh" in line]
    if len(places) != 1:
        raise Failure(f"an element includes {len(places)} schedules, not one")
    lines[places[0]] = "".join(line for line in schedule.splitlines(keepends=True) if line.startswith("`define"))
    return "".join(lines)


def replaced(options, core, folder, lower):
    """{source of hls/rtl: the file in the folder that is read in its place}."""
    module, generated, element = MODULES[core]
    texts = {f"{module}.sv": lower(options), f"{module}_unit.sv": lower(options, "--unit"),
             element.name: with_schedule(element.read_text(), lower(options, "--schedule"))}
    for name, text in texts.items():
        netlists.write(folder / name, text)
    return {element if name == element.name else generated / name: folder / name for name in texts}


def design(candidate, lower=pipelines.lower):
    """The candidate as a board."""
    folder = FOLDER / "explored" / slug(candidate)
    folder.mkdir(parents=True, exist_ok=True)
    board = designs.ulx3s(candidate.exact_elements, candidate.clock)
    board.name = f"ULX3S, explored {slug(candidate)}"
    board.parameters["FILTER_PE"] = candidate.filter_elements
    board.replaced = {**replaced(candidate.exact, "exact", folder, lower), **replaced(candidate.filter, "filter", folder, lower)}
    if candidate.exact.products == "lut":
        board.replaced.update(operators.in_luts(operators.FLOATING_PRODUCTS))
    if candidate.filter.products == "lut":
        board.replaced.update(operators.in_luts(operators.FIXED_PRODUCTS))
    return board


KINDS = {"TRELLIS_COMB": "cells", "TRELLIS_FF": "ff", "MULT18X18D": "dsp", "DP16KD": "ram"}


def packed(log):
    """Figures of a board that nextpnr packed, without a clock, by its log; None where it did not come so far."""
    text = log.read_text() if log.exists() else ""
    luts = re.search(r"Total LUT4s:\s+(\d+)/", text)
    used = {KINDS[kind]: int(count) for kind, count in re.findall(r"(\w+):\s+(\d+)/\s*\d+\s+\d+%", text) if kind in KINDS}
    return {"lut": int(luts[1]), **used, "fmax": None} if luts and used.keys() == set(KINDS.values()) else None


def route(runner, candidate, limit):
    """Figures of the routed board; without a clock where it was not routed within `limit` minutes, None where it
    was not even packed."""
    board = design(candidate)
    netlist, _ = netlists.ecp5_top(runner, board)
    folder = f"explored/{slug(candidate)}/seed{SEED}"
    try:
        report, log = runner.step(
            "nextpnr", f"{board.name}, place and route with seed {SEED}", folder,
            [*bitstream.placement(netlist, SEED, candidate.clock, PLACER), "--report", "{folder}/report.json"],
            [netlist, *bitstream.PINS["ulx3s"]], ["report.json", "nextpnr.log"], 60 * limit)
    except TookTooLong as failure:
        runner.say(str(failure))
        return packed(FOLDER / folder / "nextpnr.log")
    figures, detail = designs.board_figures(report, log)
    runner.say(f"{board.name}: {figures['fmax']:.1f} MHz, {candidate.fmax:.1f} predicted")
    return {**figures, "cells": detail["utilisation"]["cells"][0]}
