"""Designs that were measured whole, to which the model is fitted.

The element, the forms of the distance and the filtering core come from the baseline of `./dev synth`, which has
figures of each as it was placed and routed with these tools. The exact core and the board are mapped by
Yosys here and counted, as the tests of their netlists map them. A board that `./dev bitstream` routed tells a
clock of a full device.
"""

import json
import re

from synthesis import baseline, designs, document, lowered, netlists
from synthesis.tools import Failure

from .model import KINDS, Anchor, Area, pipeline_area
from .space import Options

COUNTED_LUTS = {"LUT4": 1, "CCU2C": 2, "TRELLIS_DPR16X4": 6}  # as nextpnr counts them: a LUT RAM with its write ports
EXACT, FILTER = Options("visible_edge"), Options("filter", width=18)
BOARD_FILTERS = 4  # elements of the filter on the board unless told otherwise


def counted(netlist):
    """The area of the top module of a flat netlist that Yosys wrote."""
    (module,) = [each for each in json.loads(netlist.read_text())["modules"].values() if "top" in each["attributes"]]
    kinds = {}
    for cell in module["cells"].values():
        kinds[cell["type"]] = kinds.get(cell["type"], 0) + 1
    return Area(sum(luts * kinds.get(kind, 0) for kind, luts in COUNTED_LUTS.items()), kinds.get("TRELLIS_FF", 0),
                kinds.get("MULT18X18D", 0), kinds.get("DP16KD", 0))


def parts(exact=0, filters=0, cores=0, board=0, record_bits=0, in_core=True):
    sizes = {"record bit": record_bits, "exact element": exact, "exact element in a core": exact if in_core else 0,
             "filter element": filters, "core": cores, "board": board}
    return {part: count for part, count in sizes.items() if count}


def placed(path, versions, pipelines):
    """The anchors of the baseline."""
    known = baseline.read(path)
    key = baseline.key(versions)
    if key not in known:
        raise Failure(f"{path} has no figures of {key}; ./dev synth --update-baseline measures them")
    figures = known[key]
    exact = pipelines(EXACT)
    found = []

    def add(subject, made, sizes):
        if subject not in figures:
            raise Failure(f"{path} has no figures of {subject}; ./dev synth --update-baseline measures them")
        was = figures[subject]
        area = Area(*(was[kind] for kind in KINDS))
        found.append(Anchor(subject.partition(": ")[2], made, sizes, area, was["fmax"]))

    for form in lowered.FORMS:
        pipeline = pipelines(Options(form))
        add(f"forms: {form}", ((pipeline, 1),), parts(record_bits=pipeline.record_bits))
    add("element: emax_element", ((exact, 1),), parts(exact=1, record_bits=exact.record_bits, in_core=False))
    filtering = pipelines(FILTER)
    for subject in sorted(figures):
        elements = re.fullmatch(r"filter: filter_core, elements: (\d+)", subject)
        if elements:
            number = int(elements[1])
            add(subject, ((filtering, number),), parts(filters=number, cores=1, record_bits=number * filtering.record_bits))
    return found


def mapped(runner, pipelines):
    """The anchors that Yosys maps and that are counted."""
    exact, filtering = pipelines(EXACT), pipelines(FILTER)
    core, board = designs.core(1), designs.ulx3s(1)
    return [
        Anchor(f"{core.name}, counted", ((exact, 1),), parts(exact=1, cores=1, record_bits=exact.record_bits),
               counted(netlists.ecp5_top(runner, core)[0])),
        Anchor(f"{board.name}, counted", ((exact, 1), (filtering, BOARD_FILTERS)),
               parts(1, BOARD_FILTERS, 2, 1, exact.record_bits + BOARD_FILTERS * filtering.record_bits),
               counted(netlists.ecp5_top(runner, board)[0]))]


def of_bitstream(page, versions, pipelines, measured):
    """[the board of `./dev bitstream`] of docs/synthesis.md, or [] where it has none of these tools. The elements of
    the filter are those that the multipliers tell. A board without them is from before the filter, and its
    area is not fitted."""
    board = document.bitstreams(page).get("ulx3s")
    if board is None or board.tools != document.tools_text(versions):
        return []
    exact, filtering = pipelines(EXACT), pipelines(FILTER)
    elements = board.elements
    used = {kind.lower(): count for kind, count in board.used.items()}
    filters, rest = divmod(used["dsp"] - elements * pipeline_area(exact, measured).dsp, pipeline_area(filtering, measured).dsp)
    if filters < 0 or rest:
        raise Failure(f"docs/synthesis.md: a board of {elements} exact elements does not have {used['dsp']} multipliers;"
                      " ./dev bitstream ulx3s writes it anew")
    filters = int(filters)
    made = ((exact, elements), (filtering, filters)) if filters else ((exact, elements),)
    sizes = parts(elements, filters, 1 + (filters > 0), 1, elements * exact.record_bits + filters * filtering.record_bits)
    return [Anchor(f"ULX3S of ./dev bitstream, elements: {elements} and {filters}", made, sizes,
                   Area(*(used[kind] for kind in KINDS)), board.clocks[0], fits_area=filters > 0)]
