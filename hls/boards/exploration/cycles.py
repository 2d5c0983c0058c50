"""Cycles and pairs a second, by the cycle model of sw_model/protocol/cycle_model.cpp.

The model is written here once more, because a search asks it thousands of times. Its constants are read from
the C++ sources; a test compares it with the throughput that the C++ model gave for docs/datasheet.md.
"""

import functools
import re
from dataclasses import dataclass
from pathlib import Path

from synthesis.tools import Failure

SOURCES = [Path("sw_model/protocol/cycle_model.cpp"), Path("sw_model/protocol/cycle_model.h"),
           Path("hls/kernel/command_words.h"), Path("hls/kernel/filter_words.h"), Path("hls/kernel/triangle_record.h")]
BENCHMARKS = Path("docs/benchmarks.md")


@dataclass(frozen=True)
class Workload:
    """Full blocks of points, each with its candidates among the triangles. The number of candidates is that of
    the bunny's search in docs/decisions/0039: 4,266,272 pairs of 23,520 points."""

    points: int = 1024
    records: int = round(4_266_272 / 23_520)
    blocks: int = 8


@functools.cache
def constants():
    """{name: value} of the constants of the C++ model."""
    found = {}
    for path in SOURCES:
        found.update(re.findall(r"constexpr [\w:]+ (k\w+) = (\d+);", path.read_text()))
    values = {name: int(value) for name, value in found.items()}
    missing = [name for name in ("kLeastRows", "kSlotAfterPass", "kRecordHandover", "kPassAfterRecord", "kPassAfterReduce",
                                 "kAnswerAfterPair", "kGather", "kAnswerOverhead", "kAnswerWorst", "kSlots", "kPointWords",
                                 "kRecordWords", "kFilterPointWords", "kFilterRecordWords") if name not in values]
    if missing:
        raise Failure(f"{SOURCES[0]}: {missing[0]} is not there any more; adapt hls/boards/exploration/cycles.py")
    return values


def block_cycles(core, elements, latency, last_read, points, records, blocks):
    """Cycles that `blocks` blocks of one size take on a core, "exact" or "filter", whose stream of words never
    pauses and whose answers list no points."""
    k = constants()
    point_words, record_words = ((k["kPointWords"], k["kRecordWords"]) if core == "exact"
                                 else (k["kFilterPointWords"], k["kFilterRecordWords"]))
    rows = max(-(-points // elements), k["kLeastRows"])
    next_word = moved = gone = pass_end = answer_end = taken = passes = 0
    slot_free = [0] * k["kSlots"]

    def make_pass(begin):
        nonlocal pass_end, passes
        pass_end = max(pass_end, begin) + rows
        slot_free[passes % len(slot_free)] = pass_end + last_read + k["kSlotAfterPass"]
        passes += 1

    for _ in range(blocks):
        next_word = max(next_word, pass_end) + 1 + points * point_words + 1
        for i in range(records):
            next_word = max(next_word, moved) + record_words
            moved = max(next_word, gone + 1)
            gone = max(moved + k["kRecordHandover"], slot_free[taken % len(slot_free)])
            taken += 1
            if i > 0:
                make_pass(gone + k["kPassAfterRecord"])
        next_word = max(next_word, gone) + 1
        begin = max(pass_end, next_word + k["kPassAfterReduce"])
        make_pass(begin)
        first = max(begin + latency + k["kAnswerAfterPair"], answer_end)
        ready = max(first, pass_end + latency + k["kAnswerAfterPair"] + 1) + k["kGather"] * min(elements, points)
        answer_end = max(answer_end, ready) + k["kAnswerWorst"] + k["kAnswerOverhead"]
    return max(next_word, answer_end)


@functools.cache
def points_left(width):
    """The share of points that the filter of this width leaves to the kernel, as `./dev bench --filter` wrote it."""
    text = BENCHMARKS.read_text()
    section = text[text.find("<!-- filter: begin -->"):text.find("<!-- filter: end -->")]
    points = re.search(r"the (\d+) vertices", section)
    left = re.search(rf"^\| {width} \| [^|]* \| (\d+) \|", section, re.MULTILINE)
    if points is None or left is None:
        raise Failure(f"{BENCHMARKS} does not say how many points a filter of {width} bits leaves; ./dev bench --filter does")
    return int(left[1]) / int(points[1])


@functools.cache
def pairs_per_cycle(exact, filtering, width, work=Workload()):
    """Pairs of the search a clock cycle. `exact` and `filtering` are (elements, latency, last read); the second
    None where there is no filter. The filter takes a block, then the exact core the points that are left of
    it, all with the block's records: the cores work one after the other."""
    pairs = work.points * work.records
    if filtering is None:
        return pairs * work.blocks / block_cycles("exact", *exact, work.points, work.records, work.blocks)
    left = work.points * points_left(width)  # of a block; below 1 some blocks have one, the others none
    cycles = block_cycles("filter", *filtering, work.points, work.records, work.blocks)
    cycles += min(left, 1) * block_cycles("exact", *exact, max(round(left), 1), work.records, work.blocks)
    return pairs * work.blocks / cycles
