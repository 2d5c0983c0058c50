"""Single operators as designs, and their measured areas and clocks.

An operator is placed and routed alone, in the register shell of `./dev synth`, by the same steps, so that what
either command has run is not run again.
"""

import re

from synthesis import designs
from synthesis.tools import FOLDER, Failure

from .pipelines import Operator

SEED = 1
# The delays that are measured: a piece of LUT RAM, and a block RAM.
DELAY_BITS = 32
LUT_RAM_DELAY = Operator("delay_line", (("DEPTH", 16), ("STYLE", "distributed_ram"), ("WIDTH", DELAY_BITS)))
BLOCK_RAM_DELAY = Operator("delay_line", (("DEPTH", 64), ("STYLE", "block_ram"), ("WIDTH", DELAY_BITS)))
DELAYS = [LUT_RAM_DELAY, BLOCK_RAM_DELAY]

ECP5, BEHAVIOURAL = designs.RTL / "ecp5", designs.RTL / "behavioural"


def in_luts(names):
    """The sources of products that Yosys maps to LUTs, in place of those of the device's multipliers."""
    return {ECP5 / f"{name}.sv": BEHAVIOURAL / f"{name}.sv" for name in names}


FLOATING_PRODUCTS = ["mantissa_multiply", "mantissa_square"]
FIXED_PRODUCTS = ["signed_multiply"]


def wrapper(operator, source):
    """A module with the operator's parameters, whose ports are as wide as these make them. Its name is
    explored_ with the operator's."""
    parameters = {**dict(re.findall(r"parameter (?:int|bit) (\w+)\s*= (\d+)", source)), **dict(operator.parameters)}
    ports = re.findall(r"^\s*(input|output)\s+logic\s+(?:\[(\w+)-1:0\]\s+)?(\w+),?$", source, re.MULTILINE)
    if not ports:
        raise Failure(f"{operator.module}: its source has no port that is understood")
    declared = ", ".join(f"{direction} logic [{int(parameters[bits] if bits else 1) - 1}:0] {name}"
                         for direction, bits, name in ports)
    given = ", ".join(f".{name}({value})" if isinstance(value, int) else f'.{name}("{value}")'
                      for name, value in operator.parameters if name != "LATENCY")
    given += ", .LATENCY(LATENCY)" if operator.latency else ""
    connected = ", ".join(f".{name}({name})" for _, _, name in ports)
    return f"""// Written for {operator.name}.
module explored_{operator.module} #(parameter int LATENCY = {operator.latency or 1}) (
    {declared});
  {operator.module} #({given.removeprefix(", ")}) operator ({connected});
endmodule
"""


def design(operator, target):
    """The operator as a design; a binary32 operator as that of `./dev synth`."""
    products = FIXED_PRODUCTS if operator.module.startswith("fixed_") else FLOATING_PRODUCTS
    replaced = in_luts(products) if operator.products == "lut" else {}
    if operator.module.startswith("fp_"):
        return designs.Design(operator.name, operator.module, target, {"LATENCY": operator.latency}, replaced=replaced)
    folders = [designs.RTL, designs.RTL / "fixed"]
    (source,) = [path for folder in folders if (path := folder / f"{operator.module}.sv").exists()]
    path = FOLDER / "explored" / f"{re.sub(r'[^a-z0-9]+', '_', operator.name.lower())}.sv"
    path.parent.mkdir(parents=True, exist_ok=True)
    text = wrapper(operator, source.read_text())
    if not path.exists() or path.read_text() != text:
        path.write_text(text)
    more = [*sorted((designs.RTL / "fixed").glob("*.sv")), path]
    return designs.Design(operator.name, f"explored_{operator.module}", target, {"LATENCY": operator.latency or 1}, more=more,
                          replaced=replaced)
