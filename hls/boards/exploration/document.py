"""The tables of an exploration, and docs/exploration.md around them."""

from synthesis.document import table

from . import cycles, operators, routing, space
from .model import KINDS, predicted
from .space import described

INTRODUCTION = """# Exploration

Written by `./dev explore {board}`; never edit. Tools: {tools}. Seeds: {operator_seed} of every operator, {route_seed} of every routed board.

The command searches the designs of a board: how deep the operators' pipelines are, how values are delayed, how wide the filter is, what products are made of, and how many elements there are. A model predicts area, clock and pairs a second of each design; it is fitted to measured operators and designs. How to use the command: [boards](boards.md#other-designs-for-the-ulx3s).

Not measured: anything on a board. Not searched: seeds of the placement, forms of the distance, the sizes of FIFOs and of the store.
"""

MODEL = """## The model

- **Area.** LUTs, flip-flops, multipliers and block RAMs add up. A pipeline is its operators, each as measured alone; its delays, as pieces of LUT RAM (at most 17 cycles each), block RAMs or flip-flops; and a LUT and a flip-flop for each bit of a registered multiplexer. The parts below are added.
- **Cells** are LUTs and cells that only pass a signal on. Of the latter a design has those of its operators and delays alone.
- **Width.** Operators of 16 and 14 bits take 16/18 and 14/18 of the LUTs and flip-flops of those of 18, and run no faster.
- **Clock.** The slowest operator's clock alone, times a factor of {at_empty:.3f} - {slope:.3f} u, at most 1; u is the greatest share of a kind (cells, flip-flops, multipliers, block RAMs) that the design takes, and the factor is fitted to designs that have a core, whose control counts as well. The board's clock is the next multiple of 15 MHz below.
- **Pairs a second.** The cycles are those of the model of the cores (`sw_model/protocol/cycle_model.h`), for blocks of {points:,} points and {records} candidates each, as in the search of the bunny ([0039](decisions/0039-a-filter-before-the-device.md)). The serial line is left out. A pair that the filter settles counts as a pair. The exact core meets the points that the filter leaves, which `./dev bench --filter` measured: {left}. The cores work one after the other.
- **Limits.** A design may take {fill:.0%} of each kind.

The device has {capacity}.
"""


def number(value):
    return f"{value:,.0f}"


def _difference(model_says, was):
    return f"{round((model_says - was) / was, 2) + 0.0:+.0%}" if was else "–"  # + 0.0: no -0%


def space_section(axes, fitting, better):
    named = {"add": "exact: latency of a sum", "multiply": "exact: of a product", "square": "exact: of a square",
             "less": "exact: of a comparison", "fixed_add": "filter: latency of a sum", "fixed_multiply": "filter: of a product",
             "fixed_fit": "filter: of a fit", "fixed_negate": "filter: of a magnitude", "widths": "filter: bits", "delays": "delays of each", "products": "products of each",
             "exact": "exact elements", "filter": "elements of the filter, 0 for no filter"}
    rows = [[title, ", ".join(map(str, getattr(axes, axis)))] for axis, title in named.items()]
    return "\n\n".join([
        "## The space", table(["axis", "values"], rows),
        f"These are {space.size(axes):,} designs. Pipelines that another one surpasses in everything are left out first, which"
        f" loses no design of the frontier; {fitting:,} designs of the others fit and meet a clock. {better:,} of these are"
        " surpassed by no other in pairs a second, cells and multipliers together.\n"])


def model_section(model, board):
    left = ", ".join(f"{cycles.points_left(width):.2%} at {width} bits" for width in space.FULL.widths)
    capacity = ", ".join(f"{count:,} {kind.upper() if kind in ('dsp', 'ram', 'ff') else kind}" for kind, count in board.capacity.items())
    work = cycles.Workload()
    text = MODEL.format(at_empty=model.crowding[0], slope=model.crowding[1],
                        points=work.points, records=work.records, left=left, fill=space.FILL, capacity=capacity)
    size_of = lambda size: number(size) if abs(size) >= 100 else f"{round(size, 1) + 0.0:,.1f}"  # + 0.0: no -0.0
    rows = [[part, *(size_of(getattr(sizes, kind)) for kind in KINDS)] for part, sizes in model.parts.items()]
    return f"{text}\n{table(['part', 'LUT', 'FF', 'DSP', 'RAM'], rows)}\n"


def operator_section(measured):
    rows = [[operator.name, number(one["lut"]), number(one["cells"]), number(one["ff"]), one["dsp"], one["ram"], f"{one['fmax']:.1f}"]
            for operator, one in sorted(measured.items())]
    return "\n\n".join([
        "## Operators, measured alone",
        "Each was placed and routed in the register shell of [synthesis](synthesis.md). WIDTH and its like are parameters of the"
        " modules in `hls/rtl/`.",
        table(["operator", "LUT", "cells", "FF", "DSP", "RAM", "MHz"], rows)]) + "\n"


def _beside(model_says, was, digits=0):
    return f"{model_says:,.{digits}f} / {was:,.{digits}f} ({_difference(model_says, was)})"


def anchor_section(model, anchors):
    rows = []
    for anchor in anchors:
        area, fmax = predicted(model, anchor)
        rows.append([anchor.name, *(_beside(getattr(area, kind), getattr(anchor.area, kind)) if anchor.fits_area else
                                    f"– / {number(getattr(anchor.area, kind))}" for kind in KINDS),
                     _beside(fmax, anchor.fmax, 1) if anchor.fits_clock else "–"])
    return "\n\n".join([
        "## Predicted beside measured",
        "The designs that the parts and the factor were fitted to: predicted / measured. Where a part stands in one of them"
        " alone, the fit meets that design exactly and says nothing of its own error. Where no area is predicted, the design is"
        " of older sources, and the clock alone was fitted.",
        table(["design", "LUT", "FF", "DSP", "RAM", "MHz"], rows)]) + "\n"


def _row(each):
    return [each.exact_elements, each.filter_elements, described(each.exact), described(each.filter) if each.filter else "–",
            number(each.cells), number(each.ff), each.dsp, number(each.ram), f"{each.fmax:.1f}", each.clock,
            f"{each.pairs / 1e9:.3f}", "yes" if each.buildable else "no"]


COLUMNS = ["exact", "filter", "exact pipeline", "filter's pipeline", "cells", "FF", "DSP", "RAM", "MHz", "clock", "10⁹ pairs/s", "built"]


def frontier_table(designs):
    return table(COLUMNS, [_row(each) for each in designs])


def frontier_section(designs, step):
    return "\n\n".join([
        "## The frontier",
        f"Predicted, in the order of pairs a second; a row has at least {step:.0%} more than the row before. Latencies are those of"
        " sum, product, square and comparison, of the filter those of sum, product, fit and magnitude. \"Built\" says whether"
        " `hls/rtl/` has such a board: its filter has 18 bits, and a board without a filter is not there.",
        frontier_table(designs)]) + "\n"


def routed_section(routed, limit):
    """`routed` is [(candidate, figures or None)]."""
    if not routed:
        return "## Routed\n\nNothing was routed in this run (`--route 0`).\n"
    rows = []
    for each, figures in routed:
        name = f"{each.exact_elements} exact, {each.filter_elements} of the filter"
        kinds = ["lut", "cells", "ff", "dsp", "ram"]
        areas = [_beside(getattr(each, kind), figures[kind]) for kind in kinds] if figures else ["–"] * len(kinds)
        clock = (_beside(each.fmax, figures["fmax"], 1) if figures and figures["fmax"]
                 else f"{each.fmax:.1f}, not routed within {limit} min")
        rows.append([name, *areas, clock])
    return "\n\n".join([
        "## Routed",
        "Designs of the frontier that `hls/rtl/` has, each with most pairs a second of its numbers of elements: predicted / measured."
        " The model was not fitted to them.",
        table(["board", "LUT", "cells", "FF", "DSP", "RAM", "MHz"], rows)]) + "\n"


def page(board_name, board, axes, model, anchors, found, shown, routed, limit, versions, step):
    """The whole page. `found` is (frontier, number of designs that fit)."""
    parts = [INTRODUCTION.format(board=board_name, tools=", ".join(f"{tool} {version}" for tool, version in versions.items()),
                                 operator_seed=operators.SEED, route_seed=routing.SEED),
             frontier_section(shown, step), routed_section(routed, limit), space_section(axes, found[1], len(found[0])),
             model_section(model, board), anchor_section(model, anchors), operator_section(model.measured)]
    return "\n".join(parts)
