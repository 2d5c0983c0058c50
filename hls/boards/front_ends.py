"""Reads the SystemVerilog with two front ends and proves that they make the same circuits of it.

Yosys has two front ends: its own, which synthesis uses, and slang. A remark of either is a fault,
except for the remarks that are listed here with their reason. Both elaborate each module below, and
every register and output of one circuit is proven equal to that of the other, by induction over the
clock.

  front_ends.py [--misread]

--misread proves fp_add alone, with an expression that Yosys's own front end reads as another one
(designs.MISREAD): it must fail.
"""

import io
import re
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

from synthesis import designs
from synthesis.tools import FOLDER, Failure, Runner, run_command

RTL = designs.RTL
ECP5_BLOCKS = Path("testbench/netlists/ecp5_blocks.sv")
NEXUS_CELLS = Path("testbench/netlists/nexus_cells.sv")
# Remarks of Yosys that are no fault, each with its reason.
PERMITTED = [
    r"Warning: Replacing memory \S+ with list of registers\.",  # a chain of registers in an array
]
# The parameters with which a module is proven, where its defaults do not suit the proof.
PARAMETERS = {
    "fp_add": [{"LATENCY": 12}, {"LATENCY": 12, "SUBTRACT": 1}, {"LATENCY": 1}, {"LATENCY": 14}],
    "fp_less": [{"LATENCY": 3}, {"LATENCY": 1}],
    "fp_multiply": [{"LATENCY": 10}],
    "fp_square": [{"LATENCY": 10}],
    "fixed_add": [{"LATENCY": 3}, {"LATENCY": 1, "SUBTRACT": 1, "SATURATE": 0}],
    "fixed_fit": [{"LATENCY": 3}, {"SHIFT": 0, "WIDTH": 40}, {"HALF_UP": 0, "SATURATE": 0}],
    "fixed_less": [{"LATENCY": 2}],
    "fixed_multiply": [{"WIDTH_A": 8, "WIDTH_B": 9}],
    "fixed_negate": [{"LATENCY": 3}, {"LATENCY": 1, "MAGNITUDE": 1}],
    "pipeline_stream": [{"LATENCY": 3, "WIDTH": 5}],
    "record_stream": [{"SLOT_BITS": 2, "LAST_READ": 3, "LATENCY": 3, "RECORD_WIDTH": 6, "WIDTH": 5}],
    "signed_multiply": [{"WIDTH_A": 8, "WIDTH_B": 9}],
    "delay_line": [{"WIDTH": 5, "DEPTH": 1}, {"WIDTH": 5, "DEPTH": 6}],
    "axis_fifo": [{"WIDTH": 5, "DEPTH_BITS": 3}],
    "ring_memory": [{"WIDTH": 5, "ADDRESS_BITS": 3}],
    "field_memory": [{"WIDTH": 5, "SLOT_BITS": 3}],
    "block_memory": [{"WIDTH": 5, "ADDRESS_BITS": 3}],
    "mantissa_multiply": [{"WIDTH_A": 24, "WIDTH_B": 24, "LATENCY": 7}],
    "mantissa_square": [{"WIDTH": 24, "LATENCY": 7}],
    "command_decoder": [{"NUM_PE": 1}, {"NUM_PE": 2}],
    "pair_sequencer": [{"NUM_PE": 1}, {"NUM_PE": 2}],
    "block_answer": [{"NUM_PE": 1}, {"NUM_PE": 2}],
    "link_command_ring": [{"ROOM_BITS": 3}],
    "running_minimum": [{"POINT_BITS": 3}],
}
# Modules that join others and have memories too large to become registers. Their parts are proven, and
# the netlists that are driven show how they are joined.
PARTS_PROVEN = ["emax_element", "emax_distance", "emax_distance_unit", "emax_core", "filter_element", "emax_filter", "emax_filter_unit",
                "filter_core", "command_store", "emax_device", "emax_link", "emax_board", "link_answers", "link_sender", "emax_ulx3s"]
# Modules of a family without cells of the family: their other parts are driven in a simulation.
FAMILY_PROOFS = [("signed_multiply", {"WIDTH_A": 8, "WIDTH_B": 19, "LATENCY": 4}, family) for family in ("ecp5", "xilinx")]
PACKAGES = ["mutation"]  # no module
SOURCES = ["", "core", "link", "board", "sdram", "filter", "filter/generated", "fixed", "stream", "generated", "behavioural"]


def script(top, parameters, files):
    """The Yosys script that reads one module with both front ends and proves the circuits equal."""
    include = f"-I {RTL} -I {RTL}/generated"
    slang = " ".join(f"-G {name}={value}" for name, value in parameters.items())
    own = " ".join(f"-set {name} {value}" for name, value in parameters.items())
    prepare = "proc; flatten; opt; memory_map; opt; "
    return (f"read_slang -j 1 -DSYNTHESIS {include} --top {top} {slang} {files}; {prepare} rename -top gold; "
            f"design -stash slang; "
            f"read_verilog -sv -I{RTL} -I{RTL}/generated {files}; "
            + (f"chparam {own} {top}; " if own else "") +
            f"hierarchy -check -top {top}; {prepare} rename -top gate; design -stash own; "
            "design -copy-from slang -as gold gold; design -copy-from own -as gate gate; "
            "equiv_make gold gate equiv; hierarchy -top equiv; equiv_struct; equiv_simple -undef; "
            "equiv_induct -undef; equiv_status -assert")


def remarks(log):
    """The lines of a log that are remarks and are not permitted."""
    found = []
    for line in log.splitlines():
        if re.search(r"[Ww]arning|remark", line) and not any(re.search(pattern, line) for pattern in PERMITTED):
            if not re.search(r"Build succeeded: 0 errors, 0 warnings|Warnings: \d+ unique", line):
                found.append(line.strip())
    return found


def modules():
    """{module: file}: every module of hls/rtl that is for all families."""
    files = [path for folder in SOURCES for path in sorted((RTL / folder).glob("*.sv"))]
    return {path.stem: path for path in files if path.stem not in PACKAGES}


def proofs():
    """[(name, top, parameters, family)]"""
    found = []
    for top in modules():
        if top not in PARTS_PROVEN:
            found += [(top, parameters, "behavioural") for parameters in PARAMETERS.get(top, [{}])]
    return found + FAMILY_PROOFS


def prove(runner, top, parameters, family, replaced={}):
    design = designs.Design("", top, 0, replaced=replaced)
    more = [path for folder in ("core", "link", "board", "sdram", "filter", "filter/generated", "fixed", "stream") for path in sorted((RTL / folder).glob("*.sv"))]
    files = " ".join(map(str, [*design.sources(family), *more]))
    name = "_".join([top, family, *(["misread"] if replaced else []), *map(str, parameters.values())]).replace('"', "")
    runner.step("yosys", f"{top} {parameters or ''}, {family}", f"front_ends/{name}",
                ["-p", script(top, parameters, files)], design.inputs(family), ["yosys.log"])
    log = (FOLDER / f"front_ends/{name}/yosys.log").read_text()
    wrong = remarks(log)
    if wrong:
        raise Failure("\n".join([*wrong, f"{top}: a front end remarks on it"]))
    (proven,) = re.findall(r"Found (\d+) \$equiv cells in equiv:", log) or ["0"]
    if proven == "0":
        raise Failure(f"{top}: the proof compared nothing")
    return int(proven)


def read_all(runner, family, more):
    """Reads the whole board of a family with slang. Yosys's own front end reads it for every netlist."""
    design = designs.ulx3s(2)
    files = [path for path in design.sources(family) if path.parent != designs.ULX3S]
    files += [designs.ULX3S / "emax_ulx3s.sv", designs.ULX3S / "behavioural/ulx3s_clock.sv", *more]
    runner.step("yosys", f"the board, {family}, read by slang", f"front_ends/board_{family}",
                ["-p", f"read_slang -j 1 -DSYNTHESIS -I {RTL} -I {RTL}/generated --top emax_ulx3s -G NUM_PE=2 "
                 + " ".join(map(str, files))], [*design.inputs(family), *files], ["yosys.log"])
    wrong = remarks((FOLDER / f"front_ends/board_{family}/yosys.log").read_text())
    if wrong:
        raise Failure("\n".join([*wrong, f"the board, {family}: slang remarks on it"]))


def main():
    runner = Runner(2, name="front ends")
    runner.prepare()
    if sys.argv[1:] == ["--misread"]:
        prove(runner, "fp_add", {"LATENCY": 12}, "behavioural", designs.misread(FOLDER / "misread"))
        return 0
    for family, more in {"behavioural": [], "ecp5": [ECP5_BLOCKS], "nexus": [NEXUS_CELLS], "xilinx": []}.items():
        read_all(runner, family, more)
    with ThreadPoolExecutor(2) as pool:
        proven = list(pool.map(lambda proof: prove(runner, *proof), proofs()))
    print(f"front ends: {len(proven)} modules equal, {sum(proven)} registers and outputs proven")
    return 0


if __name__ == "__main__":
    run_command("front_ends", main)
