"""Netlists of designs, which Yosys makes of the sources, for placement and for simulation.

Every placement, count and simulation takes its netlist from here, so that the netlist that is simulated is
the one that is placed or counted.
"""

import re

from . import designs
from .tools import FOLDER

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


def routed(runner, design):
    """A design without a shell, placed and routed with its pins in the smallest ECP5, for simulation: the
    path of nextpnr's file of it (synthesis/routed.py)."""
    netlist, _ = ecp5_top(runner, design)
    (placed,) = runner.step("nextpnr", f"{design.name}, place and route", f"ecp5/{slug(design.name)}/routed",
                            ["--25k", "--package", "CABGA381", "--lpf-allow-unconstrained", "--timing-allow-fail",
                             "--seed", "1", "--json", str(netlist), "--write", "{folder}/routed.json"],
                            [netlist], ["routed.json"])
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
