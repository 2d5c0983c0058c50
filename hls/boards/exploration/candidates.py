"""Every design of the space with what the model predicts of it."""

from dataclasses import dataclass

from . import cycles, space
from .frontier import nondominated
from .model import pipeline_area, slowest


@dataclass(frozen=True)
class Half:
    """A pipeline of the exact core or of the filter, with its figures for one element."""

    options: space.Options
    area: tuple  # model.Area of the pipeline and its record memory
    alone: float  # MHz of the slowest operator
    latency: int
    last_read: int

    def key(self):
        """What a better pipeline has less of; a design gets no worse with a better pipeline."""
        width = -self.options.width if self.options.form == "filter" else 0
        return (*self.area, -self.alone, self.latency, self.last_read, width)


@dataclass(frozen=True)
class Candidate:
    exact: space.Options
    filter: space.Options  # None where there is no filtering core
    exact_elements: int
    filter_elements: int
    lut: float
    cells: float
    ff: float
    dsp: int
    ram: float
    share: float  # the greatest of a kind
    fmax: float
    clock: int  # MHz: the greatest of the board's below fmax
    pairs: float  # a second

    @property
    def key(self):
        return (-self.pairs, self.cells, self.dsp)

    @property
    def buildable(self):
        """Whether hls/rtl has such a board: it has a filtering core, of 18 bits."""
        return self.filter is not None and self.filter.width == space.BUILT_WIDTH


def halves(options, lowered, model):
    """The pipelines of these options that no other is better than. O(n^2) for n options."""
    made = []
    for each in options:
        pipeline = lowered(each)
        area = pipeline_area(pipeline, model.measured, each.width).plus(model.parts["record bit"], pipeline.record_bits)
        made.append(Half(each, area, slowest(pipeline, model.measured)[0], pipeline.latency, pipeline.last_read))
    return nondominated(made, Half.key)


def clock_of(fmax, clocks):
    """The greatest clock that is not above fmax; 0 where there is none."""
    return max((clock for clock in clocks if clock <= fmax), default=0)


def candidate(exact, filtering, numbers, board, model):
    """A design of halves, `numbers` (exact, filter) of them; None where it does not fit or meets no clock."""
    parts = {"exact element": numbers[0], "exact element in a core": numbers[0], "filter element": numbers[1],
             "core": 1 + (numbers[1] > 0), "board": 1}
    area = model.area([(exact.area, numbers[0]), *([(filtering.area, numbers[1])] if filtering else [])], parts)
    share = model.utilisation(area)
    if share > space.FILL:
        return None
    fmax = model.fmax(min(exact.alone, filtering.alone) if filtering else exact.alone, share)
    clock = clock_of(fmax, board.clocks)
    if clock == 0:
        return None
    rate = cycles.pairs_per_cycle((numbers[0], exact.latency, exact.last_read),
                                  filtering and (numbers[1], filtering.latency, filtering.last_read),
                                  filtering.options.width if filtering else 0)
    return Candidate(exact.options, filtering and filtering.options, *numbers, area.lut, area.cells,
                     area.ff, round(area.dsp), area.ram, share, fmax, clock, 1e6 * clock * rate)


def enumerate_designs(exact, filters, axes, board, model):
    """All designs of these halves that fit and meet a clock."""
    made = (candidate(one, other, (numbers, of_filter), board, model)
            for numbers in axes.exact for of_filter in axes.filter for one in exact
            for other in (filters if of_filter else [None]))
    return [each for each in made if each is not None]


def frontier(axes, lowered, board, model):
    """(designs that no other is better than, how many designs of better pipelines fit)."""
    exact = halves(space.exact_options(axes), lowered, model)
    filters = halves(space.filter_options(axes), lowered, model)
    fitting = enumerate_designs(exact, filters, axes, board, model)
    return nondominated(fitting, lambda each: each.key), len(fitting)
