"""The model: areas that add up, and a clock that falls as the device fills.

Area. A pipeline is its operators as they were measured alone, its delays as pieces of LUT RAM and block RAM that were
measured alone, and a LUT and a flip-flop for each bit of a registered multiplexer. What a design has beside its
pipelines is a sum of PARTS; least squares fit their sizes to designs that were measured whole.

Clock. A design runs at its slowest operator's clock, measured alone, times a factor. The factor is a line over the
greatest share of a kind that the design takes; least squares fit it, too, to designs that have a core, whose control
counts as well.
"""

import math
from dataclasses import dataclass
from typing import NamedTuple

from synthesis.tools import Failure

from . import operators, space

KINDS = ["lut", "ff", "dsp", "ram"]
PARTS = ["record bit", "exact element", "exact element in a core", "filter element", "core", "board"]
PIECE = 17  # edges that one piece of LUT RAM delays (hls/rtl/delay_line.sv)
# By how much a fitted figure may miss a measured one before one of the two is taken for wrong.
AREA_DOUBT, CLOCK_DOUBT = 0.20, 0.25


class Area(NamedTuple):
    lut: float = 0.0
    ff: float = 0.0
    dsp: float = 0.0
    ram: float = 0.0
    through: float = 0.0  # cells that only pass a signal on, beside the LUTs

    @property
    def cells(self):
        return self.lut + self.through

    def plus(self, other, times=1.0):
        return Area(*(mine + times * others for mine, others in zip(self, other)))


@dataclass(frozen=True)
class Anchor:
    """A design that was measured whole: its pipelines, its parts, and its figures. fmax is None where it was only
    counted. Only the clock is of use where it was made of other sources than its parts."""

    name: str
    pipelines: tuple  # (Pipeline, how many)
    parts: dict  # part: how many
    area: Area
    fmax: float = None
    fits_area: bool = True

    @property
    def fits_clock(self):
        return self.fmax is not None and "core" in self.parts


def least_squares(rows, wanted, weights):
    """The x for which the weighted squares of rows x - wanted are least. Raises ValueError where the rows do not
    determine it."""
    size = len(rows[0])
    scaled = [([weight * value for value in row], weight * value) for row, value, weight in zip(rows, wanted, weights)]
    system = [[sum(row[i] * row[j] for row, _ in scaled) for j in range(size)] + [sum(row[i] * value for row, value in scaled)]
              for i in range(size)]
    greatest = [system[i][i] for i in range(size)]
    for column in range(size):
        pivot = max(range(column, size), key=lambda i: abs(system[i][column]))
        if abs(system[pivot][column]) <= 1e-9 * greatest[column] or greatest[column] == 0:
            raise ValueError("the measurements do not determine every part")
        system[column], system[pivot] = system[pivot], system[column]
        for i in range(size):
            if i != column:
                factor = system[i][column] / system[column][column]
                system[i] = [a - factor * b for a, b in zip(system[i], system[column])]
    return [system[i][size] / system[i][i] for i in range(size)]


def delay_area(style, bits, cycles, measured):
    """One delay line; hls/rtl/delay_line.sv takes registers where a memory would hold nothing."""
    if style == "distributed_ram" and cycles > 2:
        whole, rest = divmod(cycles, PIECE)
        one = measured[operators.LUT_RAM_DELAY]
        pieces = whole + (rest > 2)
        registers = 0 if rest > 2 else rest * bits
        share = pieces * bits / operators.DELAY_BITS
        return Area(one["lut"] * share, one["ff"] * share + registers, through=(one["cells"] - one["lut"]) * share)
    if style == "block_ram" and cycles > 3:
        one = measured[operators.BLOCK_RAM_DELAY]
        per_block = one["ram"] / math.ceil(operators.DELAY_BITS / 18)
        return Area(one["lut"], one["ff"], 0, per_block * math.ceil(bits / 18), one["cells"] - one["lut"])
    return Area(0, bits * cycles)


def pipeline_area(pipeline, measured, width=None):
    """A filter's operators of another width than 18 take that share of their LUTs and flip-flops."""
    share = 1 if width in (None, 32) else width / space.BUILT_WIDTH
    total = Area(pipeline.selected_bits, pipeline.selected_bits)
    for operator, count in pipeline.operators:
        one = measured[operator]
        total = total.plus(Area(one["lut"] * share, one["ff"] * share, one["dsp"], one["ram"], one["cells"] - one["lut"]), count)
    for style, bits, cycles, count in pipeline.delays:
        total = total.plus(delay_area(style, bits, cycles, measured), count)
    return total


def slowest(pipeline, measured):
    """(MHz, operator) of the slowest."""
    return min((measured[operator]["fmax"], operator.name) for operator, _ in pipeline.operators)


def fit_parts(anchors, measured):
    """{part: Area}, DSP blocks 0: they are all in operators."""
    anchors = [anchor for anchor in anchors if anchor.fits_area]
    used = [part for part in PARTS if any(anchor.parts.get(part) for anchor in anchors)]
    rows = [[anchor.parts.get(part, 0) for part in used] for anchor in anchors]
    fitted = {part: {"dsp": 0.0} for part in used}
    for kind in ("lut", "ff", "ram"):
        known = [sum(count * getattr(pipeline_area(pipeline, measured), kind) for pipeline, count in anchor.pipelines)
                 for anchor in anchors]
        sizes = [getattr(anchor.area, kind) for anchor in anchors]
        try:
            solved = least_squares(rows, [size - part for size, part in zip(sizes, known)], [1 / max(size, 1) for size in sizes])
        except ValueError as error:
            raise Failure(f"the sizes of {', '.join(used)} cannot be fitted: {error}") from None
        for part, size in zip(used, solved):
            fitted[part][kind] = size
    return {part: Area(*(sizes[kind] + 0.0 for kind in KINDS)) for part, sizes in fitted.items()}


@dataclass(frozen=True)
class Model:
    measured: dict  # Operator: {"lut", "cells", "ff", "dsp", "ram", "fmax"}
    parts: dict  # part: Area
    crowding: tuple  # factor at an empty device, and by how much it falls to a full one
    capacity: dict

    def area(self, pipelines, parts):
        total = Area()
        for pipeline_area_, count in pipelines:
            total = total.plus(pipeline_area_, count)
        for part, count in parts.items():
            total = total.plus(self.parts[part], count)
        return total

    def utilisation(self, area):
        return utilisation(area, self.capacity)

    def factor(self, share):
        at_empty, slope = self.crowding
        return max(0.0, min(1.0, at_empty - slope * share))

    def fmax(self, alone, share):
        return alone * self.factor(share)


def utilisation(area, capacity):
    """The greatest share of a kind."""
    return max(getattr(area, kind) / there for kind, there in capacity.items())


def fit_crowding(anchors, measured, capacity):
    """(at_empty, slope) of the factor; a slope below 0 counts as 0."""
    shares, factors = [], []
    for anchor in anchors:
        if anchor.fits_clock:
            through = sum(pipeline_area(pipeline, measured).through * count for pipeline, count in anchor.pipelines)
            shares.append(utilisation(anchor.area._replace(through=through), capacity))
            factors.append(anchor.fmax / min(slowest(pipeline, measured)[0] for pipeline, _ in anchor.pipelines))
    try:
        at_empty, slope = least_squares([[1.0, -share] for share in shares], factors, [1.0] * len(shares))
    except (ValueError, IndexError):
        raise Failure("the clocks of the measured designs do not determine how a clock falls") from None
    return (at_empty, slope) if slope >= 0 else (sum(factors) / len(factors), 0.0)


def fit(anchors, measured, capacity):
    return Model(measured, fit_parts(anchors, measured), fit_crowding(anchors, measured, capacity), capacity)


def predicted(model, anchor):
    """(Area, fmax) that the model gives for an anchor."""
    area = model.area([(pipeline_area(pipeline, model.measured), count) for pipeline, count in anchor.pipelines], anchor.parts)
    alone = min(slowest(pipeline, model.measured)[0] for pipeline, _ in anchor.pipelines)
    return area, model.fmax(alone, model.utilisation(area))


def doubts(model, anchors):
    """What cannot be right, one line each: multipliers that do not add up, figures that the fit misses by far, and
    parts of less than nothing."""
    found = []
    for anchor in anchors:
        area, fmax = predicted(model, anchor)
        if round(area.dsp) != anchor.area.dsp:
            found.append(f"{anchor.name}: {area.dsp:g} multipliers by its operators, {anchor.area.dsp:g} measured")
        for kind in ("lut", "ff") if anchor.fits_area else ():
            model_says, was = getattr(area, kind), getattr(anchor.area, kind)
            if abs(model_says - was) > AREA_DOUBT * was:
                found.append(f"{anchor.name}: {kind} {model_says:,.0f} by the model, {was:,.0f} measured")
        if anchor.fits_clock and abs(fmax - anchor.fmax) > CLOCK_DOUBT * anchor.fmax:
            found.append(f"{anchor.name}: {fmax:.1f} MHz by the model, {anchor.fmax:.1f} measured")
        for part, count in anchor.parts.items():
            for kind in ("lut", "ff"):
                size = count * getattr(model.parts[part], kind)
                if size < -AREA_DOUBT * getattr(anchor.area, kind):
                    found.append(f"{anchor.name}: its {part} would have {size:,.0f} {kind}")
    return found
