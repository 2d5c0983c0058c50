"""Writes netlists for simulation: netlists.py FOLDER NAME... writes FOLDER/NAME.v.

NAME is KIND_FAMILY. KIND is operators, element, form_FORM, core, board1 or board2 (with 1 or 2 elements),
board1at105 (with another clock in MHz), board1sdram or board1sdramat105
(with the store in SDRAM), filter1 or filter4, sdram120 (the SDRAM's controller at 120 MHz), sdrampins120 (the
same with the board's clock and pins).
FAMILY is one of these:
  ecp5, nexus, xc7, xcup   mapped to the family
  words             as the front end reads the sources, before anything is mapped
  mutated           with faults put in; their list is FOLDER/NAME.txt
  misread           unmapped, of sources with an expression that Yosys reads as another one
  routed            operators or sdrampins: as nextpnr places and routes them for ECP5
  misrouted         operators alone: the same with one bit of a LUT turned
  inverted          a filter: mapped to Nexus, with the entries of one LUT turned; sdrampins: mapped to ECP5, with
                    the clock of the chip inverted

The operators of a family are four modules, fp_add_netlist and so on. A form is form_netlist, with its
source in the same file. The other modules have the source's name.
"""

import fcntl
import io
import re
import sys
from dataclasses import replace
from pathlib import Path

from synthesis import designs, lowered, netlists, routed
from synthesis.tools import FOLDER, Failure, Runner, run_command

DATAPATH = designs.GENERATED / "emax_distance.sv"
MAPPED = {"ecp5": netlists.ecp5, "nexus": netlists.nexus}
MUTANTS, SEED = 500, 1
OPERATORS = Path("testbench/operators/emax_operators.sv")
BENCH = designs.Design("operators side by side", "emax_operators", 0, {"EXPONENT": 8}, more=[OPERATORS])


PINS = [designs.ULX3S / name for name in ("ulx3s.lpf", "ulx3s_sdram.lpf")]


def sdram_with_pins(clock):
    """The controller of the ULX3S's SDRAM with the board's clock and pins."""
    controller = designs.sdram_controller(clock)
    more = [*controller.more, *(designs.ULX3S / f"{name}.sv" for name in ("ulx3s_clock", "sdram_pins")),
            Path("testbench/netlists/sdram_with_pins.sv")]
    return replace(controller, name=f"sdram_controller with pins at {clock} MHz", top="sdram_with_pins",
                   parameters={"CLOCK_MHZ": clock}, more=more)


def with_an_inverted_clock(text):
    """The netlist with what the clock's pin gives in the two halves of a cycle exchanged."""
    right, wrong = (f".D0(1'h{first}),\n    .D1(1'h{second})" for first, second in ("10", "01"))
    if text.count(right) != 1:
        raise Failure(f"the netlist has {text.count(right)} pins that give a clock, not one")
    return text.replace(right, wrong)


def netlist_of(runner, design, family):
    """The path of a design's netlist for simulation."""
    if family == "words":
        return netlists.words(runner, design)
    if family == "misread":
        clock = "ulx3s_clock.sv"  # whose PLL is a cell of a family
        replaced = {**designs.misread(FOLDER / "misread"),
                    designs.ULX3S / clock: designs.ULX3S / "behavioural" / clock}
        return netlists.words(runner, replace(design, name=f"{design.name}, misread", replaced=replaced))
    if family == "ecp5" and design.top in ["emax_core", "emax_ulx3s", "emax_ulx3s_sdram"]:
        return netlists.ecp5_top(runner, design)[-1]
    if family in MAPPED:
        return MAPPED[family](runner, design)[-1]
    return netlists.xilinx(runner, design, family)[-1]


def text_of(runner, name):
    """{suffix: text} of the files that are written for a name."""
    kind, family = name.rsplit("_", 1)
    if family == "mutated":
        design = {"operators": BENCH, "core": designs.core(1)}[kind]
        netlist, mutants = netlists.mutated(runner, design, MUTANTS, SEED)
        return {".v": netlist.read_text(), ".txt": mutants.read_text()}
    if name in ["operators_routed", "operators_misrouted"]:
        module = routed.read(netlists.routed(runner, BENCH))
        if family == "misrouted":
            routed.turn_a_bit(module)
        return {".v": routed.verilog(module, BENCH.top)}
    pins = re.fullmatch(r"sdrampins(\d+)", kind)
    if pins:
        design = sdram_with_pins(int(pins[1]))
        if family == "routed":
            placed = netlists.routed(runner, design, "--85k", PINS)
            return {".v": routed.verilog(routed.read(placed), design.top)}
        text = netlists.renamed(netlists.ecp5_top(runner, design)[-1], design.top)
        return {".v": text if family == "ecp5" else with_an_inverted_clock(text)}
    if family == "inverted":
        return {".v": netlists.with_an_inverted_lut(text_of(runner, f"{kind}_nexus")[".v"])}
    if kind == "operators" and family != "misread":
        parts = [netlists.renamed(netlist_of(runner, design, family), f"{design.top}_netlist")
                 for design in designs.operators(DATAPATH, 0)]
        return {".v": "\n".join(parts)}
    if kind.startswith("form_"):
        design, _ = lowered.form(kind.removeprefix("form_"), 0)
        return {".v": "\n".join([*(path.read_text() for path in design.generated),
                                 netlists.renamed(netlist_of(runner, design, family), "form_netlist")])}
    if kind == "element" and family in netlists.FAMILIES:
        return {".v": netlists.renamed(netlist_of(runner, lowered.xilinx_element(0), family), "emax_element")}
    board = re.fullmatch(r"board(\d)(sdram)?(?:at(\d+))?", kind)
    sdram = re.fullmatch(r"sdram(\d+)", kind)
    if sdram:
        design = designs.sdram_controller(int(sdram[1]))
    elif board:
        design = designs.ulx3s(int(board[1]), int(board[3] or designs.ULX3S_CLOCK), bool(board[2]))
    else:
        design = {"operators": BENCH, "core": designs.core(1), "element": designs.element(0),
                  "filter1": designs.filter_core(1, 0), "filter4": designs.filter_core(4, 0)}[kind]
    return {".v": netlists.renamed(netlist_of(runner, design, family), design.top)}


def main():
    folder, names = Path(sys.argv[1]), sys.argv[2:]
    folder.mkdir(parents=True, exist_ok=True)
    FOLDER.mkdir(parents=True, exist_ok=True)
    with open(FOLDER / "netlists.lock", "w") as lock:  # two builds may want the same netlists
        fcntl.flock(lock, fcntl.LOCK_EX)
        runner = Runner(2, out=io.StringIO(), name="netlists")
        runner.prepare()
        for name in names:
            for suffix, text in text_of(runner, name).items():
                netlists.write(folder / f"{name}{suffix}", text)
    return 0


if __name__ == "__main__":
    try:
        run_command("netlists", main)
    except Failure as failure:
        sys.exit(f"netlists: {failure}")
