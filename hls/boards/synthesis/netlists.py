"""Netlists of designs, which Yosys makes of the sources, for placement and for simulation.

Every placement, count and simulation takes its netlist from here, so that the netlist that is simulated is
the one that is placed or counted.
"""

import json
import re
from collections import Counter

from . import designs
from .tools import FOLDER, Failure

# The ECP5 mapping names its DSP blocks itself; without the option Yosys would give small products blocks
# without registers (docs/decisions/0006-synthesis-options.md).
ECP5_OPTIONS = "-nodsp"
FAMILIES = {"xc7": "7-series", "xcup": "UltraScale+"}


def slug(name):
    return name.replace(", latency ", "_").replace(": ", "_").replace(", ", "_").replace(" ", "_")


def with_ports(runner, design, family, folder, make):
    """The path of the Verilog that `make` writes around the design, given its ports."""
    (ports,) = runner.step("yosys", f"{design.name}, ports", f"{folder}/ports",
                           ["-q", "-p", designs.ports_script(design, family)], design.inputs(family), ["ports.json"])
    path = FOLDER / folder / "top.v"
    path.write_text(make(design, designs.ports(ports)))
    return path


def ecp5(runner, design):
    """The design in its register shell for ECP5: for nextpnr, the shell's cells, and the design alone
    for simulation."""
    folder = f"ecp5/{slug(design.name)}"
    shell = with_ports(runner, design, "ecp5", folder, designs.shell)
    return runner.step("yosys", f"{design.name}, synthesis for ECP5", f"{folder}/yosys",
                       ["-p", designs.ecp5_script(design, shell, ECP5_OPTIONS)], [*design.inputs("ecp5"), shell],
                       ["netlist.json", "cells.json", "netlist.v"])


# The LUTs of the cell in which Yosys begins a carry chain: the second one, whose D is high, gives A to COUT.
FIRST_CARRY = {"INIT0": "0xFFFF", "INIT1": "0x00AA"}


def without_first_carries(text):
    """A netlist for Nexus in JSON without the constants that Yosys gives to the carry inputs of first cells. These
    cells ignore them, and nextpnr 0.11.1 refuses them. Raises Failure where a cell would not ignore one."""
    netlist = json.loads(text)
    for module in netlist["modules"].values():
        cells = module["cells"]
        nets = lambda kind: {net for cell in cells.values() if cell["type"] == kind for net in cell["connections"]["Z"]}
        low, high = nets("VLO"), nets("VHI")
        ends = Counter(net for cell in cells.values() for bits in cell["connections"].values() for net in bits)
        for name, cell in cells.items():
            pins = cell["connections"]
            if cell["type"] != "CCU2" or not low.intersection(pins["CIN"]):
                continue
            sums = [net for pin in ("S0", "S1") for net in pins.get(pin, [])]
            if (any(cell["parameters"].get(lut) != entries for lut, entries in FIRST_CARRY.items())
                    or not high.issuperset(pins["D1"]) or any(ends[net] > 1 for net in sums)):
                raise Failure(f"{name}: a carry cell of another kind than those that ignore a constant CIN;"
                              " netlists.without_first_carries has to learn it")
            pins["CIN"] = []
    return json.dumps(netlist)


def with_an_inverted_lut(text):
    """A netlist for Nexus in Verilog with the entries of one LUT turned: the one in the middle of the text."""
    luts = list(re.finditer(r'LUT4 #\(\s*\.INIT\("0x([0-9a-fA-F]{4})"\)', text))
    entries = luts[len(luts) // 2]
    return text[:entries.start(1)] + f"{0xffff ^ int(entries[1], 16):04x}" + text[entries.end(1):]


def nexus(runner, design):
    """As ecp5, for Lattice Nexus."""
    folder = f"nexus/{slug(design.name)}"
    shell = with_ports(runner, design, "nexus", folder, designs.shell)
    made, cells, netlist = runner.step("yosys", f"{design.name}, synthesis for Nexus", f"{folder}/yosys",
                                       ["-p", designs.nexus_script(design, shell)], [*design.inputs("nexus"), shell],
                                       ["netlist.json", "cells.json", "netlist.v"])
    placed = FOLDER / folder / "placed.json"
    write(placed, without_first_carries(made.read_text()))
    return placed, cells, netlist


def ecp5_top(runner, design):
    """A design without a shell for ECP5: for nextpnr and for simulation."""
    return runner.step("yosys", f"{design.name}, synthesis for ECP5", f"ecp5/{slug(design.name)}/yosys",
                       ["-p", designs.top_script(design, ECP5_OPTIONS)], design.inputs("ecp5"),
                       ["netlist.json", "netlist.v"])


def xilinx(runner, design, family):
    """The design for a family of FAMILIES: to be counted and for simulation."""
    folder = f"{family}/{slug(design.name)}"
    wrapper = with_ports(runner, design, "xilinx", folder, designs.wrapper)
    return runner.step("yosys", f"{design.name}, synthesis for {FAMILIES[family]}", f"{folder}/yosys",
                       ["-p", designs.xilinx_script(design, wrapper, family)], [*design.inputs("xilinx"), wrapper],
                       ["netlist.json", "netlist.v"])


def routed(runner, design, device="--25k", pins=()):
    """A design without a shell, placed and routed with its pins in an ECP5, the smallest unless another one is
    named, for simulation: the path of nextpnr's file of it (synthesis/routed.py)."""
    netlist, _ = ecp5_top(runner, design)
    given = [argument for path in pins for argument in ("--lpf", str(path))]
    (placed,) = runner.step("nextpnr", f"{design.name}, place and route", f"ecp5/{slug(design.name)}/routed",
                            [device, "--package", "CABGA381", "--lpf-allow-unconstrained", "--timing-allow-fail",
                             "--seed", "1", *given, "--json", str(netlist), "--write", "{folder}/routed.json"],
                            [netlist, *pins], ["routed.json"])
    return placed


def words(runner, design):
    """The design as the front end reads it, before anything is mapped, for simulation."""
    (netlist,) = runner.step("yosys", f"{design.name}, read", f"words/{slug(design.name)}",
                             ["-p", designs.words_script(design)], design.inputs("behavioural"), ["netlist.v"])
    return netlist


def mutated(runner, design, mutants, seed):
    """The design with about this number of faults put in (designs.mutants_script), for simulation, and the
    list of faults. Faults of a clock are left out, because a register without a clock is a constant."""
    folder = f"mutated/{slug(design.name)}"
    listed, gates = runner.step("yosys", f"{design.name}, a list of faults", f"{folder}/list",
                                ["-p", designs.mutants_script(design, mutants, seed)], design.inputs("behavioural"),
                                ["mutants.txt", "gates.il"])
    chosen = FOLDER / folder / "mutants.txt"
    chosen.write_text("".join(line for line in listed.read_text().splitlines(keepends=True) if " -port C " not in line))
    (netlist,) = runner.step("yosys", f"{design.name}, with its faults", f"{folder}/netlist",
                             ["-p", designs.mutated_script(gates, chosen)], [gates, chosen], ["netlist.v"])
    return netlist, chosen


def renamed(netlist, name):
    """The text of a netlist of one module, renamed to this name."""
    text, count = re.subn(r"^module (\\\S+|\w+) ?\(", f"module {name}(", netlist.read_text(), flags=re.MULTILINE)
    if count != 1:
        raise ValueError(f"{netlist} holds {count} modules, not one")
    return text


def write(path, text):
    """Writes the text unless the file has it already, so that nothing is built again without need."""
    if not path.exists() or path.read_text() != text:
        path.write_text(text)
