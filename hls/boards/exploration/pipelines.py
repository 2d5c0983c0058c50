"""Lowered pipelines: which operators, delays and memories they have, read from emax_lower's text."""

import math
import re
import subprocess
from collections import Counter
from dataclasses import dataclass, replace
from typing import NamedTuple

from synthesis import lowered
from synthesis.tools import Failure

from . import space


class Operator(NamedTuple):
    module: str
    parameters: tuple = ()  # (name, value)
    products: str = ""  # "dsp" or "lut" of a module with a product

    @property
    def latency(self):
        return dict(self.parameters).get("LATENCY", 0)

    @property
    def name(self):
        """As designs.operators names those of the datapath, whose steps then are not run twice."""
        shape = "".join(f" {name} {value}" for name, value in self.parameters if name != "LATENCY")
        place = ", in LUTs" if self.products == "lut" else ""
        return f"{self.module}{shape}" + (f", latency {self.latency}" if self.latency else "") + place


@dataclass(frozen=True)
class Pipeline:
    latency: int  # cycles
    last_read: int  # the cycle in which the record is read last
    operators: tuple  # (Operator, how many)
    delays: tuple  # (style, bits, cycles, how many)
    record_bits: int
    selected_bits: int  # of multiplexers that a register follows


PRODUCTS = ("fp_multiply", "fp_square", "fixed_multiply")
# Parameters without which an operator is as large and as fast: a subtraction is an addition.
ALIKE = ("SUBTRACT", "MAGNITUDE")
INSTANCE = re.compile(r"^\s*(fp_\w+|fixed_\w+|delay_line|field_memory) #\((.*?)\) \w+ \(", re.MULTILINE | re.DOTALL)


def _value(text, constants):
    text = constants.get(text, text).strip('"')
    bit = re.fullmatch(r"1'b([01])", text)
    return int(bit[1]) if bit else int(text) if re.fullmatch(r"-?\d+", text) else text


def instances(text):
    """[(module, {parameter: value})] of the lowering's modules in a text of SystemVerilog."""
    constants = dict(re.findall(r"localparam int (\w+) = (\d+);", text))
    return [(module, {name: _value(value, constants) for name, value in re.findall(r"\.(\w+)\(([^()]*)\)", parameters)})
            for module, parameters in INSTANCE.findall(text)]


def _selected_bits(text):
    """Bits of registers that are written by `name <= condition ? a : b`."""
    widths = {}
    for bits, names in re.findall(r"^  logic (?:\[(\d+):0\] )?([\w,\s]+);", text, re.MULTILINE):
        widths.update({name: int(bits or 0) + 1 for name in re.findall(r"\w+", names)})
    return sum(widths.get(name, 1) for name in re.findall(r"always_ff @\(posedge clk\) (\w+) <=\s[^;]*\?", text))


def pipeline(datapath, unit, products):
    """The pipeline of the texts of a datapath and its unit."""
    operators, delays = Counter(), Counter()
    for module, parameters in instances(datapath):
        if module == "delay_line":
            delays[parameters["STYLE"], parameters["WIDTH"], parameters["DEPTH"]] += 1
        else:
            kept = tuple(sorted((name, value) for name, value in parameters.items() if name not in ALIKE))
            operators[Operator(module, kept, products if module in PRODUCTS else "")] += 1
    record_bits = sum(parameters["WIDTH"] for module, parameters in instances(unit) if module == "field_memory")
    figures = dict(re.findall(r"localparam int (LATENCY|LAST_READ) = (\d+);", unit))
    return Pipeline(int(figures["LATENCY"]), int(figures["LAST_READ"]), tuple(sorted(operators.items())),
                    tuple((*key, count) for key, count in sorted(delays.items())), record_bits, _selected_bits(datapath))


def made_of(pipeline, products):
    """The pipeline with its products in LUTs or in multipliers."""
    operators = ((operator._replace(products=products if operator.products else ""), count)
                 for operator, count in pipeline.operators)
    return replace(pipeline, operators=tuple(sorted(operators)))


def scaled(of_18, width):
    """The filter's pipeline of numbers of another width. What is as wide as a condition stays so. The operators
    keep their names, as their areas are scaled (Model.pipeline_area)."""
    scale = lambda bits: bits if bits < 8 else math.ceil(bits * width / space.BUILT_WIDTH)
    return Pipeline(of_18.latency, of_18.last_read, of_18.operators,
                    tuple((style, scale(bits), cycles, count) for style, bits, cycles, count in of_18.delays),
                    scale(of_18.record_bits), scale(of_18.selected_bits))


def arguments(options):
    latencies = ",".join(f"{name}={cycles}" for name, cycles in options.latencies)
    return [options.form, "--family", "ecp5", *(["--latency", latencies] if latencies else []),
            "--delay", space.DELAYS[options.delays]]


def lower(options, *what):
    """emax_lower's output: a text of SystemVerilog."""
    command = [lowered.LOWER, *arguments(options), *what]
    try:
        run = subprocess.run(command, capture_output=True, text=True)
    except OSError as error:
        raise Failure(f"{lowered.LOWER}: {error.strerror}; ./dev build kernel emax_lower makes it") from None
    if run.returncode != 0:
        raise Failure(f"{' '.join(map(str, command))}: {run.stderr.strip()}")
    return run.stdout


class Lowered:
    """Pipelines by their options. Width and products do not change what is lowered, and what is read of a unit does
    not depend on the delays."""

    def __init__(self, lower=lower):
        self.lower = lower
        self.units, self.made = {}, {}

    def __call__(self, options):
        of_unit = options.form, options.latencies
        key = *of_unit, options.delays
        if of_unit not in self.units:
            self.units[of_unit] = self.lower(options, "--unit")
        if key not in self.made:
            self.made[key] = pipeline(self.lower(options), self.units[of_unit], "dsp")
        made = made_of(self.made[key], options.products)
        return scaled(made, options.width) if options.form == "filter" and options.width != space.BUILT_WIDTH else made
