"""The tables of a run, and docs/synthesis.md around them."""

import re

from . import power
from .tools import Failure

INTRODUCTION = """# Synthesis

Written by `./dev synth`; never edit. Tools: {tools}.

Measured: for ECP5 and Nexus Yosys maps a design, and nextpnr places and routes it. The clock is nextpnr's
static timing, for ECP5 over the worst corner of speed grade 6. Each design sits in a shell of serial shift
registers, so that pins do not limit it; the shell's cells are subtracted. For 7-series and UltraScale+
Yosys maps and counts; nothing is placed, so there is no clock.

Not measured: a bitstream on a board, power, temperature, and what the vendors' own tools would give.

| column | ECP5 | 7-series and UltraScale+ |
|--------|------|--------------------------|
| LUT    | what nextpnr counts as LUT4, carry chains and LUT RAM included | LUTs, SRLs and LUT RAM in LUTs |
| cells  | the TRELLIS_COMB cells that these occupy, those that only pass a signal on included | – |
| FF     | flip-flops | flip-flops |
| DSP    | MULT18X18D | DSP48E1, DSP48E2 |
| RAM    | block RAMs | block RAMs |

`./dev synth` fails when a figure is worse than `hls/boards/synthesis_baseline.json` by more than its
tolerance: {tolerances}.
"""

LUTS = 83_640  # LUT4s of an ECP5-85F

SECTIONS = {
    "element": ("The processing element on ECP5-85F, speed 6",
                "emax_element with 16 record slots. Seeds are tried in order until one meets the target."),
    "operators": ("Operators on ECP5-85F, speed 6", "Binary32, at the latencies of the generated datapath; one seed."),
    "forms": ("Forms of the distance on ECP5-85F, speed 6",
              "Datapath and record memory of each form alone, with the same lowering and the same operators; one seed."),
    "filter": ("The filtering core on ECP5-85F, speed 6",
               "filter_core: decoder, memories of 1,024 points, elements with 16 record slots, answers; one seed."),
    "nexus": ("The filtering core on Lattice Nexus",
              "filter_core on an LIFCL-40, speed 9, the largest Nexus of which nextpnr 0.11.1 has the data. LUT and"
              " cells are nextpnr's OXIDE_COMB, DSP is MULT18X18, of which the device has 56, one fewer than the exact"
              " element needs; one seed."),
    "xilinx": ("7-series and UltraScale+, counted by Yosys",
               "\"product\" counts the DSP blocks in which Yosys placed a register behind the multiplier (MREG or PREG),"
               " \"inputs\" those with registers at both inputs (AREG and BREG). The other registers are outside the block."),
}


def table(header, rows):
    """A Markdown table with aligned columns, which also reads well on a terminal."""
    rows = [[str(cell) for cell in row] for row in rows]
    widths = [max(len(row[i]) for row in [header, *rows]) for i in range(len(header))]
    line = lambda cells: "| " + " | ".join(cell.ljust(width) for cell, width in zip(cells, widths)) + " |"
    return "\n".join([line(header), "|" + "|".join("-" * (width + 2) for width in widths) + "|", *map(line, rows)])


def _placed(result):
    figures = result["figures"]
    verdict = "met" if figures["fmax"] >= result["target"] else "missed"
    return [f"{figures['lut']:,}", f"{result['cells']:,}", f"{figures['ff']:,}", figures["dsp"], figures["ram"],
            f"{figures['fmax']:.1f}", f"{result['target']:g} {verdict}", result["seed"]]


PLACED = ["LUT", "cells", "FF", "DSP", "RAM", "MHz", "target", "seed"]


def _paths(subjects):
    rows = []
    for name, result in subjects.items():
        path = result["path"]
        if path is not None:
            rows.append([name, path["from"], path["to"], f"{path['logic']:.2f}", f"{path['routing']:.2f}", path["levels"]])
    return table(["critical path of", "from", "to", "logic ns", "routing ns", "logic steps"], rows)


def _seeds(tried):
    return ", ".join(f"{seed}: {fmax:.1f} MHz" if fmax else f"{seed}: not routed" for seed, fmax in tried.items())


def _tried(subjects):
    lines = []
    for name, result in subjects.items():
        if len(result["tried"]) > 1:
            lines.append(f"Seeds tried for {name}: {_seeds(result['tried'])}.")
    return lines


def section_table(section, subjects):
    """The tables of a section, a blank line between them."""
    if section == "xilinx":
        rows = [[name, f"{r['figures']['lut']:,}", r["srl"], r["ram_luts"], f"{r['figures']['ff']:,}",
                 r["figures"]["dsp"], r["registered"], r["registered_inputs"], r["figures"]["ram"]]
                for name, r in subjects.items()]
        return table(["design, family", "LUT", "as SRL", "as RAM", "FF", "DSP", "product", "inputs", "RAM"], rows)
    if section == "forms":
        rows = [[name, r["report"]["multiplications"], r["report"]["additions"], r["report"]["latency"],
                 f"{r['report']['delay_bits']:,}", *_placed(r)] for name, r in subjects.items()]
        first = table(["form", "mul", "add", "latency", "delay bits", *PLACED], rows)
    else:
        first = table(["design", *PLACED], [[name, *_placed(r)] for name, r in subjects.items()])
    return "\n\n".join([first, *_tried(subjects), _paths(subjects)])


def tables(results):
    return "\n\n".join(f"{SECTIONS[section][0]}\n\n{section_table(section, subjects)}\n"
                       for section, subjects in results.items())


DRIVEN_TITLE = "## What was driven"
DRIVEN = DRIVEN_TITLE + """

A netlist is what Yosys made of the sources; it is the one that was placed or counted. Before this page was
written these netlists were simulated with the stimuli of the sources' co-simulation:

{table}

These designs were not simulated as nextpnr routes them.
"""


def _introduction(versions, tolerances):
    limits = ", ".join(f"{name} {'+' if more else '-'}{share:.0%}" for name, (share, more) in tolerances.items())
    return INTRODUCTION.format(tools=tools_text(versions), tolerances=limits)


def tools_text(versions):
    return ", ".join(f"{tool} {version}" for tool, version in versions.items())


def _section(name, subjects):
    title, note = SECTIONS[name]
    return f"## {title}\n\n{note}\n\n{section_table(name, subjects)}\n"


def _verdicts(driven):
    return {", ".join(name.removeprefix("form_").rsplit("_", 1)): verdict.removeprefix("netlist: ")
            for name, verdict in driven.items()}


def _driven_section(verdicts):
    return DRIVEN.format(table=table(["netlist", "compared"], verdicts.items()))


def page(results, versions, tolerances, driven, boards=""):
    """The whole page. `driven` is the verdict on each netlist that was driven, `boards` the sections of boards."""
    parts = [_introduction(versions, tolerances), *(_section(name, results[name]) for name in SECTIONS),
             _driven_section(_verdicts(driven))]
    return with_boards("\n".join(parts), boards)


def with_sections(before, results, versions, tolerances, driven):
    """The page with these sections anew and their netlists among those driven, or None where the page is of
    other versions of the tools."""
    head, titled = _sections(before)
    if f"Tools: {tools_text(versions)}." not in head:
        return None
    verdicts = dict(re.findall(r"^\| (\S.*?) +\| (\S.*?) +\|$", titled[DRIVEN_TITLE], flags=re.MULTILINE))
    verdicts.pop("netlist")
    verdicts.update(_verdicts(driven))
    titled[DRIVEN_TITLE] = _driven_section(verdicts)
    titled.update({f"## {SECTIONS[name][0]}": _section(name, subjects) for name, subjects in results.items()})
    order = [*(f"## {title}" for title, _ in SECTIONS.values()), DRIVEN_TITLE, *BOARDS.values()]
    return "\n".join([_introduction(versions, tolerances), *(titled[title] for title in order if title in titled)])


# A section for each board of ./dev bitstream.
BOARDS = {"ulx3s": "## The bitstream for ULX3S", "ulx3s-sdram": "## The bitstream for ULX3S with SDRAM"}


def _placements(promised, tried):
    """The placements, what was expected of each and what the router made of it."""
    rows = []
    for seed, (clock, length) in promised.items():
        routed = "not tried" if seed not in tried else f"{tried[seed]:.1f}" if tried[seed] else "not routed"
        rows.append([seed, f"{clock:.1f}", f"{length:,}", routed])
    return table(["seed", "MHz expected of the placement", "length of its wires", "MHz routed"], rows)


def power_line(utilisation, clock):
    idle, busy = power.estimated(utilisation, clock)
    return (f"Power of the FPGA, [estimated](decisions/0054-power-by-comparison.md): {idle:.1f} W idle,"
            f" at most {busy:.1f} W at work.")


def board_section(board, result, versions):
    """The section of the page on the result of ./dev bitstream."""
    figures = result["figures"]
    verdict = "met" if figures["fmax"] >= result["target"] else "missed"
    rows = [[name, f"{used:,}", f"{there:,}", f"{used / there:.0%}"]
            for name, (used, there) in {"LUT": (figures["lut"], LUTS), **result["utilisation"]}.items()]
    return "\n\n".join([
        BOARDS[board],
        f"Written by `./dev bitstream {board}`; never edit. The whole design, UART, link, store and cores"
        f" (elements: {result['elements']}) on ECP5-85F, speed 6, placed and routed with the board's pins; not yet run on a"
        f" board. Tools: {tools_text(versions)}.",
        "Simulated in lockstep with its source before it was written: "
        + "; ".join(f"as {stage}, {verdict}" for stage, verdict in result["driven"].items()) + ".",
        f"Clock: {figures['fmax']:.1f} MHz, target {result['target']:g} MHz {verdict}, seed {result['seed']}.",
        power_line(result["utilisation"], result["target"]),
        _placements(result["promised"], result["tried"]),
        table(["resource", "used", "there", "share"], rows),
        _paths({result["top"]: result}),
    ]) + "\n"


def _sections(page):
    """What stands before a page's first section, and {title: section} of the others."""
    head, *parts = re.split(r"^(?=## )", page, flags=re.MULTILINE)
    return head.rstrip("\n") + "\n", {part.partition("\n")[0]: part.rstrip("\n") + "\n" for part in parts}


class Bitstream:
    """The figures of a board's section; one that the section lacks is a Failure when it is asked for."""

    def __init__(self, board, section):
        self._board, self._section = board, section

    def _read(self, what, pattern):
        found = re.search(pattern, self._section, flags=re.MULTILINE)
        if found is None:
            raise Failure(f"docs/synthesis.md: the section of {self._board} does not say its {what};"
                          f" ./dev bitstream {self._board} writes it anew")
        return found

    @property
    def tools(self):
        return self._read("tools", r" Tools: (.*)\.$")[1]

    @property
    def elements(self):
        return int(self._read("elements", r"\(elements: (\d+)\)")[1])

    @property
    def clocks(self):
        """(MHz reached, MHz asked for)"""
        return tuple(map(float, self._read("clock", r"^Clock: ([\d.]+) MHz, target ([\d.]+) MHz (?:met|missed)").groups()))

    @property
    def power(self):
        return self._read("power", r"^Power of the FPGA, .*: ([\d.]+ W idle, at most [\d.]+ W at work)\.$")[1]

    @property
    def used(self):
        """{LUT, FF, DSP or RAM: how many}"""
        return {kind: int(self._read(kind, rf"^\| {kind} +\| ([\d,]+) +\| [\d,]+ +\| \d+% +\|$")[1].replace(",", ""))
                for kind in ("LUT", "FF", "DSP", "RAM")}


def _texts_of_boards(page):
    found = {}
    for title, section in _sections(page)[1].items():
        written = re.search(r"^Written by `\./dev bitstream (\S+)`", section, flags=re.MULTILINE)
        if written:
            found[written[1]] = section
        elif title in BOARDS.values():
            raise Failure(f"docs/synthesis.md: \"{title}\" does not say which board it is of")
    return found


def bitstreams(page):
    """{board: Bitstream} of the page's boards."""
    return {board: Bitstream(board, section) for board, section in _texts_of_boards(page).items()}


def board_of(page, board):
    """The board's section of a page, or nothing."""
    return _texts_of_boards(page).get(board, "")


def boards_of(page):
    """The sections of all boards."""
    return "\n".join(section for section in (board_of(page, board) for board in BOARDS) if section)


def with_boards(page, boards):
    """The page with these sections of boards, which are its last ones, in place of its own of the same boards."""
    head, sections = _sections(page)
    sections.update(_sections(boards)[1])
    last = [sections.pop(title) for title in BOARDS.values() if title in sections]
    return "\n".join([head, *sections.values(), *last])
