"""The design as nextpnr placed and routed it, as Verilog for simulation.

nextpnr writes the design as JSON: the cells as it packed them, with their places, and nets of one bit
between them. The Verilog has the design's ports and an instance of each cell, of the models in
testbench/netlists. An input that no net reaches gets the value that nextpnr's bitstream gives it. The
wires and switches that carry the nets are not in the JSON.
"""

import json
import re

from .tools import Failure

# Inputs of blocks that the models lack, because no design of ours uses them.
ABSENT = [("MULT18X18D", "C"), ("MULT18X18D", "SRIA"), ("MULT18X18D", "SRIB"), ("DP16KD", "DIB")]
BLOCKS = ["MULT18X18D", "DP16KD"]


def read(path):
    """The only module of nextpnr's file."""
    (module,) = json.loads(path.read_text())["modules"].values()
    return module


def rejoined(module, placed):
    """The module of a design that nextpnr routed after it had read the placement `placed`, a module too. Such a
    file lacks the ports and the cells' pins that no net reaches; they are those of the placement. Raises Failure
    where the cells are not the placement's."""
    if module["cells"].keys() != placed["cells"].keys():
        raise Failure("the routed design has other cells than its placement")
    names = {net: name for name, item in placed["netnames"].items() for net in item["bits"]}
    nets = {name: item["bits"] for name, item in module["netnames"].items()}
    ports = {name: {**port, "bits": [net for bit in port["bits"] for net in nets[names[bit]]]}
             for name, port in placed["ports"].items()}
    cells = {}
    for name, cell in module["cells"].items():
        before = placed["cells"][name]
        if cell["attributes"].get("NEXTPNR_BEL") != before["attributes"].get("NEXTPNR_BEL"):
            raise Failure(f"{name} is routed in another place than where it was placed")
        cells[name] = {**cell, "port_directions": before["port_directions"],
                       "connections": {**{pin: [] for pin in before["connections"]}, **cell["connections"]}}
    return {**module, "ports": ports, "cells": cells}


def tied(kind, parameters, port):
    """The value of an input that no net reaches: 0, 1, x where nothing may depend on it, or None where
    the model has no such input."""
    if (kind, port.rstrip("0123456789")) in ABSENT:
        return None
    if kind == "TRELLIS_COMB" and port in "ABCD":
        # The bitstream repeats a LUT's entries for 0 at such an input. A carry's inputs are held at 1.
        return "1" if parameters.get("MODE") == "CCU2" else "0"
    if kind == "TRELLIS_FF" and port == "LSR":  # there is no reset
        return "0" if parameters.get("LSRMUX", "LSR") == "LSR" else "x"
    if kind == "TRELLIS_IO" and port == "T":
        return "0"
    if kind == "DCCA" and port == "CE":
        return "1"
    mux = parameters.get(f"{port}MUX", "").strip()
    if kind == "DP16KD" and re.match("CE|OCE|CS|CLK|WE|RST", port):
        # The fabric holds these at 1, and the block may invert them; all but enables are inverted by default.
        inverted = mux == "INV" if mux else not port.startswith(("CE", "OCE"))
        return "0" if inverted else "1"
    if kind == "DP16KD" or kind == "MULT18X18D" and re.fullmatch(r"[AB]\d+", port):
        return mux or "0"
    return "x"


def value(text):
    """A parameter of nextpnr's file as Verilog. Bits are a number. In that file a string that looks like
    bits ends with a space."""
    if re.fullmatch("[01xz]+", text):
        return f"{len(text)}'b{text}"
    return f'"{text[:-1] if re.fullmatch("[01xz]* +", text) else text}"'


class Nets:
    """The names of a module's nets, and who drives and reads them."""

    def __init__(self, module):
        self.pins = {}  # net: bit of a port
        self.inputs = set()
        for name, port in module["ports"].items():
            for index, net in enumerate(port["bits"]):
                self.pins[net] = f"{name}[{index}]" if len(port["bits"]) > 1 else name
            if port["direction"] != "output":  # driven from outside, the pins of both directions too
                self.inputs.update(port["bits"])
        self.known_as = {net: name for name, item in module["netnames"].items() for net in item["bits"]}
        self.driven, self.used = set(), set()

    def uses(self, net):
        self.used.add(net)
        return self._name(net)

    def drives(self, net):
        if net in self.driven or net in self.inputs:
            raise Failure(f"the routed design has two drivers of {self.known_as.get(net, net)}")
        self.driven.add(net)
        return self._name(net)

    def wires(self):
        """Declarations of the nets that are not ports. Raises Failure where a net that is used has no driver."""
        outputs = set(self.pins) - self.inputs
        for net in sorted((self.used | outputs) - self.driven - self.inputs):
            raise Failure(f"the routed design has no driver of {self.known_as.get(net, net)}")
        return [self._name(net) for net in sorted(self.driven - set(self.pins))]

    def _name(self, net):
        return self.pins.get(net, f"n{net}")


def instance(number, name, cell, nets):
    """A cell as an instance of its model, or "" for a cell that only reserves a place."""
    kind, parameters = cell["type"], dict(cell["parameters"])
    if parameters.get("MODE") == "RAMW_BLOCK" and not any(cell["connections"].values()):
        return ""
    if kind == "IOLOGIC":  # whose parameters are named as no parameter of Verilog
        parameters = {key.replace(".", "_"): text for key, text in parameters.items()}
    if kind == "TRELLIS_COMB":
        parameters["HALF"] = cell["attributes"]["NEXTPNR_BEL"].rpartition(".")[2]
    ports = {}
    for port, bits in cell["connections"].items():
        direction = cell["port_directions"][port]
        if not bits:
            constant = tied(kind, parameters, port) if direction == "input" else None
            if constant is not None:
                ports[port] = f"1'b{constant}"
            if direction == "input" and kind in BLOCKS:
                parameters.pop(f"{port}MUX", None)
        elif direction == "inout":  # a pin
            if parameters["DIR"] == "OUTPUT":
                ports["B_OUT"] = nets.drives(bits[0])
            else:
                ports["B_BOTH" if parameters["DIR"] == "BIDIR" else "B"] = nets.uses(bits[0])
        else:
            ports[port] = nets.drives(bits[0]) if direction == "output" else nets.uses(bits[0])
    given = ", ".join(f".{key}({value(text)})" for key, text in parameters.items())
    connected = ", ".join(f".{port}({net})" for port, net in ports.items())
    return f"  {kind} #({given}) c{number} ({connected});  // {name}\n"


def verilog(module, name):
    """A module of nextpnr's file as Verilog, under this name."""
    nets = Nets(module)
    cells = [instance(number, *item, nets) for number, item in enumerate(module["cells"].items())]
    ports = [f"{port['direction']} " + (f"[{len(port['bits']) - 1}:0] " if len(port["bits"]) > 1 else "") + label
             for label, port in module["ports"].items()]
    return "".join([f"module {name} ({', '.join(ports)});\n", *(f"  wire {wire};\n" for wire in nets.wires()), *cells,
                    "endmodule\n"])


def turn_a_bit(module):
    """Turns one bit of the LUT with the fewest inputs: the bit for inputs that are all 0. Returns the LUT's
    name."""
    def inputs(cell):
        return sum(bool(cell["connections"].get(port)) for port in "ABCD")

    luts = [(inputs(cell), name) for name, cell in module["cells"].items()
            if cell["type"] == "TRELLIS_COMB" and "MODE" not in cell["parameters"] and inputs(cell) > 0]
    _, name = min(luts)
    parameters = module["cells"][name]["parameters"]
    bits = parameters["INITVAL"]
    parameters["INITVAL"] = bits[:-1] + {"0": "1", "1": "0"}[bits[-1]]
    return name
