"""What `./dev explore` searches: the boards, and the values of each axis."""

import itertools
from dataclasses import dataclass


@dataclass(frozen=True)
class Board:
    device: str
    capacity: dict  # cells (one LUT4 each), flip-flops, multipliers, block RAMs
    clocks: range  # MHz


# The ULX3S's PLL compares at 5 MHz, and a bit of its serial line of 3 Mbaud takes a whole number of clocks.
BOARDS = {"ulx3s": Board("ECP5-85F, speed 6", {"cells": 83_640, "ff": 83_640, "dsp": 156, "ram": 208}, range(60, 241, 15))}
# The share of each kind that a design may take. What placement and routing need of the rest is not known.
FILL = 0.9

# Delay styles, as emax_lower's --delay: the longest delays in registers and in LUT RAM.
DELAYS = {
    "registers": "registers=9999,narrow_registers=9999",
    "LUT RAM": "memory=9999",
    "block RAM from 67": "memory=66",
    "block RAM from 34": "memory=33",
}
STANDARD_DELAYS = "block RAM from 67"
BUILT_WIDTH = 18  # bits of the filter that hls/rtl/filter has


@dataclass(frozen=True)
class Axes:
    add: tuple
    multiply: tuple
    square: tuple
    less: tuple
    fixed_add: tuple
    fixed_multiply: tuple
    fixed_fit: tuple
    fixed_negate: tuple
    widths: tuple
    delays: tuple
    products: tuple  # "dsp": multipliers of the device; "lut": inferred in LUTs
    exact: tuple  # numbers of elements
    filter: tuple  # 0: no filtering core


FULL = Axes(add=(10, 12, 14), multiply=(8, 10, 12), square=(8, 10), less=(2, 3), fixed_add=(1, 2), fixed_multiply=(4, 5, 6),
            fixed_fit=(1, 2), fixed_negate=(1, 2), widths=(14, 16, 18), delays=tuple(DELAYS), products=("dsp", "lut"), exact=(1, 2, 3),
            filter=tuple(range(9)))
QUICK = Axes(add=(12,), multiply=(10,), square=(10,), less=(3,), fixed_add=(1, 2), fixed_multiply=(5,), fixed_fit=(1,),
             fixed_negate=(1,), widths=(14, 16, 18), delays=tuple(DELAYS), products=("dsp",), exact=(1, 2), filter=tuple(range(9)))


@dataclass(frozen=True)
class Options:
    """How a pipeline is lowered and its products are made."""

    form: str  # emax_lower's name
    latencies: tuple = ()  # (operator, cycles)
    delays: str = STANDARD_DELAYS
    products: str = "dsp"
    width: int = 32


def _options(form, axes, latencies, width):
    """All combinations. A product in LUTs stands in one piece before its registers, so more of them would not
    make it faster: it has the least latency of the axis."""
    names = list(latencies)
    for products, delays in itertools.product(axes.products, axes.delays):
        values = [cycles[:1] if products == "lut" and name in ("multiply", "square", "fixed_multiply") else cycles
                  for name, cycles in latencies.items()]
        for chosen in itertools.product(*values):
            yield Options(form, tuple(zip(names, chosen)), delays, products, width)


def exact_options(axes):
    latencies = {name: getattr(axes, name) for name in ("add", "multiply", "square", "less")}
    return list(_options("visible_edge", axes, latencies, 32))


def filter_options(axes):
    latencies = {name: getattr(axes, name) for name in ("fixed_add", "fixed_multiply", "fixed_fit", "fixed_negate")}
    return [options for width in axes.widths for options in _options("filter", axes, latencies, width)]


def size(axes):
    """The number of designs in the space."""
    with_filter = len(filter_options(axes)) * sum(elements > 0 for elements in axes.filter)
    return len(exact_options(axes)) * len(axes.exact) * (with_filter + (0 in axes.filter))


def described(options):
    """A pipeline's options in a few words."""
    latencies = " ".join(f"{name.removeprefix('fixed_')} {cycles}" for name, cycles in options.latencies)
    width = f"{options.width} bits, " if options.form == "filter" else ""
    return f"{width}{latencies}, {options.delays}, {options.products.upper()}"
