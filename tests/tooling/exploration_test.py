"""The parts of `./dev explore` that need no tool: the frontier, the model and its fit, what is read of lowered
pipelines, the cycles, the boards that are built, and the page. emax_lower and the tools have stand-ins."""

import contextlib
import io
import itertools
import json
import os
import random
import re
import sys
import tempfile
import unittest
from dataclasses import replace
from pathlib import Path
from unittest import mock

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "hls/boards"))
import explore  # noqa: E402
from exploration import (anchors, candidates, cycles, document, frontier, model, operators, pipelines,  # noqa: E402
                         routing, space)
from synthesis import baseline, designs, tools  # noqa: E402
from synthesis import document as synthesis_document  # noqa: E402

BOARD = space.BOARDS["ulx3s"]
DEFAULTS = {"add": 12, "multiply": 10, "square": 10, "less": 3, "fixed_add": 1, "fixed_multiply": 5, "fixed_fit": 1, "fixed_negate": 1}
SMALL = replace(space.FULL, add=(10, 12), multiply=(8, 10), square=(10,), less=(3,), fixed_multiply=(5,), fixed_negate=(1,), widths=(16, 18),
                delays=(space.STANDARD_DELAYS,), exact=(1, 2), filter=(0, 2, 4))


def setUpModule():
    os.chdir(ROOT)


def lower(options, *what):
    """The checked-in texts, with the operators' latencies as they are asked for, in the place of emax_lower. A
    pipeline's own latency grows with them."""
    module, folder = (("emax_filter", designs.RTL / "filter/generated") if options.form == "filter"
                      else ("emax_distance", designs.GENERATED))
    latencies = {**DEFAULTS, **dict(options.latencies)}
    figures = {name.lower(): int(value) for name, value in
               re.findall(r"define EMAX_\w+?_(LATENCY|LAST_READ) (\d+)", (folder / f"{module}_schedule.svh").read_text())}
    figures["latency"] += sum(latencies[name] - DEFAULTS[name] for name in DEFAULTS)
    if what == ("--unit",):
        return re.sub(r"(localparam int LATENCY =) \d+;", rf"\1 {figures['latency']};", (folder / f"{module}_unit.sv").read_text())
    if what == ("--schedule",):
        return f"`ifndef A\n`define {module.upper()}_LATENCY {figures['latency']}\n`endif\n"
    text = (folder / f"{module}.sv").read_text()
    for name, value in latencies.items():
        text = re.sub(rf"(localparam int {name.upper()}_LATENCY =) \d+;", rf"\1 {value};", text)
    return text


def measurement(operator):
    """Figures of an operator, made up: more registers make it faster and larger."""
    wide = {"fp_add": 500, "fp_multiply": 300, "fp_square": 200, "fp_less": 120, "delay_line": 60}.get(operator.module, 40)
    in_luts = operator.products == "lut"
    blocks = {"fp_multiply": 3, "fp_square": 2, "fixed_multiply": 1}.get(operator.module, 0)
    lut = wide + (700 if in_luts else 0)
    return {"lut": lut, "cells": round(1.08 * lut), "ff": 30 + wide * operator.latency / 12, "dsp": 0 if in_luts else blocks,
            "ram": 2 if operator == operators.BLOCK_RAM_DELAY else 0,
            "fmax": (120 if in_luts else 200) + 5 * operator.latency}


class Measured(dict):
    def __missing__(self, operator):
        return self.setdefault(operator, measurement(operator))


PARTS = {"record bit": model.Area(0.5, 1.5, 0, 0.002), "exact element": model.Area(900, 1200, 0, 9),
         "exact element in a core": model.Area(300, 400, 0, 13), "filter element": model.Area(700, 900, 0, 14),
         "core": model.Area(800, 1500, 0, 0), "board": model.Area(1200, 2000, 0, 38)}
CROWDING = 1.05, 0.6


def known_model(measured=None):
    return model.Model(Measured() if measured is None else measured, PARTS, CROWDING, BOARD.capacity)


def known_anchors():
    """Designs of these parts, as the model has them, with clocks by its factor."""
    lowered = pipelines.Lowered(lower)
    exact, filtering = lowered(anchors.EXACT), lowered(anchors.FILTER)
    shapes = [("form", ((exact, 1),), anchors.parts(record_bits=exact.record_bits)),
              ("wide form", ((exact, 1),), anchors.parts(record_bits=2 * exact.record_bits)),
              ("element", ((exact, 1),), anchors.parts(exact=1, record_bits=exact.record_bits, in_core=False)),
              *((f"filter {n}", ((filtering, n),), anchors.parts(filters=n, cores=1, record_bits=n * filtering.record_bits))
                for n in (1, 4)),
              ("core", ((exact, 1),), anchors.parts(exact=1, cores=1, record_bits=exact.record_bits)),
              ("board", ((exact, 1), (filtering, 4)), anchors.parts(1, 4, 2, 1, exact.record_bits + 4 * filtering.record_bits))]
    truth, made = known_model(), []
    for name, whole, sizes in shapes:
        empty = model.Anchor(name, whole, sizes, None)
        area, fmax = model.predicted(truth, empty)
        made.append(replace(empty, area=area, fmax=None if name in ("core", "board") else fmax))
    return made


class FrontierTest(unittest.TestCase):
    def test_is_that_of_brute_force(self):
        chance = random.Random(1)
        for size, values in itertools.product((1, 2, 10, 100), (3, 10, 1000)):
            points = [tuple(chance.randrange(values) for _ in range(3)) for _ in range(size)]
            no_worse = lambda a, b: all(x <= y for x, y in zip(a, b))
            brute = {p for p in points if not any(no_worse(q, p) and q != p for q in points)}
            found = frontier.nondominated(points, lambda point: point)
            self.assertEqual(found, sorted(brute), points)

    def test_a_point_behind_another_would_be_seen(self):
        with mock.patch.object(frontier, "dominates", lambda a, b: False):
            self.assertEqual(len(frontier.nondominated([(1, 1), (2, 2)], lambda point: point)), 2)

    def test_rows_rise_by_the_step(self):
        self.assertEqual(frontier.thinned([100, 101, 104, 90, 103], lambda value: value, 0.03), [90, 100, 103])


class CandidatesTest(unittest.TestCase):
    """Of a small space, with operators made up."""

    def setUp(self):
        self.lowered, self.model = pipelines.Lowered(lower), known_model()

    def all_halves(self, options):
        return [candidates.halves([each], self.lowered, self.model)[0] for each in options]

    def test_leaving_pipelines_out_loses_no_design_of_the_frontier(self):
        everything = candidates.enumerate_designs(self.all_halves(space.exact_options(SMALL)),
                                                  self.all_halves(space.filter_options(SMALL)), SMALL, BOARD, self.model)
        brute = frontier.nondominated(everything, lambda each: each.key)
        found, fitting = candidates.frontier(SMALL, self.lowered, BOARD, self.model)
        self.assertEqual({each.key for each in found}, {each.key for each in brute})
        self.assertLess(fitting, len(everything))
        self.assertGreater(len({(each.exact_elements, each.filter_elements) for each in found}), 3)

    def test_the_space_has_as_many_designs_as_are_said(self):
        roomy = replace(BOARD, capacity=dict.fromkeys(BOARD.capacity, 10**9), clocks=range(1, 2))
        everything = candidates.enumerate_designs(self.all_halves(space.exact_options(SMALL)),
                                                  self.all_halves(space.filter_options(SMALL)), SMALL, roomy,
                                                  replace(self.model, capacity=roomy.capacity))
        self.assertEqual(len(everything), space.size(SMALL))

    def test_a_design_over_capacity_is_left_out(self):
        (exact,), (filtering,) = self.all_halves([anchors.EXACT]), self.all_halves([anchors.FILTER])
        fits = lambda board, numbers: candidates.candidate(exact, filtering, numbers, board,
                                                           replace(self.model, capacity=board.capacity))
        self.assertEqual(fits(BOARD, (1, 4)).dsp, 57 + 80)
        self.assertIsNone(fits(BOARD, (1, 5)))  # 157 multipliers of 156
        for kind in BOARD.capacity:
            with self.subTest(kind):
                self.assertIsNone(fits(replace(BOARD, capacity={**BOARD.capacity, kind: 40}), (1, 4)))

    def test_a_design_slower_than_every_clock_is_left_out(self):
        self.assertEqual([candidates.clock_of(fmax, BOARD.clocks) for fmax in (59.9, 60, 134.9, 500)], [0, 60, 120, 240])

    def test_the_best_few_are_built_and_have_other_elements(self):
        found, _ = candidates.frontier(SMALL, self.lowered, BOARD, self.model)
        chosen = frontier.best_few(found, 2)
        self.assertEqual(len({(each.exact_elements, each.filter_elements) for each in chosen}), 2)
        self.assertTrue(all(each.filter.width == 18 for each in chosen))
        best = max(each.pairs for each in found if each.buildable)
        self.assertEqual(chosen[0].pairs, best)
        (wanted,) = frontier.best_few(found, 2, [(1, 2)])
        self.assertEqual((wanted.exact_elements, wanted.filter_elements), (1, 2))
        with self.assertRaisesRegex(tools.Failure, r"frontier has 2\+9 elements; there are 1\+2"):
            frontier.best_few(found, 2, [(1, 2), (2, 9)])


class ModelTest(unittest.TestCase):
    def test_least_squares_recover_what_is_known(self):
        chance = random.Random(2)
        truth = [3.0, -1.5, 0.25]
        rows = [[chance.uniform(-5, 5) for _ in truth] for _ in range(20)]
        wanted = [sum(a * x for a, x in zip(row, truth)) for row in rows]
        weights = [chance.uniform(0.5, 2) for _ in rows]
        for found, known in zip(model.least_squares(rows, wanted, weights), truth):
            self.assertAlmostEqual(found, known)
        # With noise no other solution has smaller squares.
        noisy = [value + chance.uniform(-1, 1) for value in wanted]
        squares = lambda x: sum((w * (sum(a * b for a, b in zip(row, x)) - value)) ** 2
                                for row, value, w in zip(rows, noisy, weights))
        best = model.least_squares(rows, noisy, weights)
        for i, step in itertools.product(range(3), (-0.01, 0.01)):
            self.assertGreater(squares([x + step * (i == j) for j, x in enumerate(best)]), squares(best))

    def test_too_few_measurements_are_refused(self):
        for rows in [[[1.0, 1.0], [2.0, 2.0]], [[0.0, 1.0]]]:
            with self.assertRaises(ValueError):
                model.least_squares(rows, [1.0] * len(rows), [1.0] * len(rows))
        with self.assertRaisesRegex(tools.Failure, "record bit.*cannot be fitted"):
            model.fit_parts([each for each in known_anchors() if each.name == "element"], Measured())

    def test_the_fit_recovers_parts_and_clocks(self):
        found = model.fit(known_anchors(), Measured(), BOARD.capacity)
        for part, area in PARTS.items():
            for kind, size in zip(found.parts[part], area):
                self.assertAlmostEqual(kind, size, 4, part)
        self.assertEqual(model.doubts(found, known_anchors()), [])

    def test_the_fall_of_the_clock_is_recovered(self):
        measured = Measured()
        (exact, _), = known_anchors()[0].pipelines
        alone, _ = model.slowest(exact, measured)
        made = [model.Anchor("d", ((exact, 1),), {"core": 1}, model.Area(0, 0, share * 156, 0), alone * (0.95 - 0.5 * share))
                for share in (0.1, 0.4, 0.7)]
        for found, known in zip(model.fit_crowding(made, measured, BOARD.capacity), (0.95, 0.5)):
            self.assertAlmostEqual(found, known)
        rising = [replace(each, fmax=alone * (0.5 + index / 10)) for index, each in enumerate(made)]
        self.assertEqual(model.fit_crowding(rising, measured, BOARD.capacity)[1], 0)
        without = replace(made[0], parts={}, fmax=1.0)  # has no core, so it says nothing
        self.assertEqual(model.fit_crowding([*made, without], measured, BOARD.capacity),
                         model.fit_crowding(made, measured, BOARD.capacity))
        with self.assertRaises(tools.Failure):
            model.fit_crowding(made[:1], measured, BOARD.capacity)

    def test_a_wrong_measurement_is_seen(self):
        good = known_anchors()
        by_name = {each.name: index for index, each in enumerate(good)}

        def doubts_of(name, **changes):
            made = list(good)
            was = made[by_name[name]]
            area = was.area._replace(**{kind: value for kind, value in changes.items() if kind != "fmax"})
            made[by_name[name]] = replace(was, area=area, fmax=changes.get("fmax", was.fmax))
            return "\n".join(model.doubts(model.fit(made, Measured(), BOARD.capacity), made))

        self.assertIn("filter 4: 80 multipliers by its operators, 79 measured", doubts_of("filter 4", dsp=79))
        self.assertIn("MHz by the model, 20.0 measured", doubts_of("filter 1", fmax=20.0))
        self.assertIn("its exact element would have", doubts_of("element", lut=good[by_name["element"]].area.lut / 3))
        operator = pipelines.Operator("fp_add", (("LATENCY", 12),))
        measured = Measured({operator: {**measurement(operator), "lut": 5000}})
        self.assertIn("lut", "\n".join(model.doubts(model.fit(good, measured, BOARD.capacity), good)))

    def test_a_doubt_ends_the_command(self):
        good = known_anchors()
        explore.fitted(Measured(), good, BOARD)
        wrong = [replace(good[0], area=good[0].area._replace(dsp=1)), *good[1:]]
        with self.assertRaisesRegex(tools.Failure, "form: 57 multipliers.*\n.*--fresh measures again"):
            explore.fitted(Measured(), wrong, BOARD)

    def test_delays_are_what_the_module_makes_of_them(self):
        measured = Measured({operators.LUT_RAM_DELAY: {"lut": 64, "cells": 66, "ff": 40, "ram": 0},
                             operators.BLOCK_RAM_DELAY: {"lut": 10, "cells": 14, "ff": 12, "ram": 2}})
        for style, bits, length, expected in [
                ("registers", 32, 5, (0, 160, 0, 0)), ("distributed_ram", 32, 2, (0, 64, 0, 0)),
                ("distributed_ram", 32, 3, (64, 40, 0, 0)), ("distributed_ram", 32, 17, (64, 40, 0, 0)),
                ("distributed_ram", 32, 18, (64, 72, 0, 0)), ("distributed_ram", 16, 37, (96, 60, 0, 0)),
                ("block_ram", 32, 3, (0, 96, 0, 0)), ("block_ram", 32, 73, (10, 12, 0, 2)), ("block_ram", 37, 73, (10, 12, 0, 3))]:
            with self.subTest((style, bits, length)):
                area = model.delay_area(style, bits, length, measured)
                self.assertEqual(area[:4], expected)
                of_pieces = (expected[0] / 32 if expected[3] == 0 else 4) if expected[0] else 0
                self.assertEqual(area.through, of_pieces)


class PipelinesTest(unittest.TestCase):
    def test_a_datapath_has_the_operators_and_delays_that_its_header_says(self):
        for options, operations in [(anchors.EXACT, {"fp_add": 18, "fp_multiply": 17, "fp_square": 3, "fp_less": 2}),
                                    (anchors.FILTER, {"fixed_add": 18, "fixed_multiply": 20, "fixed_fit": 8, "fixed_less": 6,
                                                      "fixed_negate": 4})]:
            made = pipelines.Lowered(lower)(options)
            found = {}
            for operator, count in made.operators:
                found[operator.module] = found.get(operator.module, 0) + count
            self.assertEqual(found, operations)
            bits = sum(width * length * count for _, width, length, count in made.delays)
            self.assertEqual(bits, int(re.search(r"Delays: (\d+) bits", lower(options))[1]))
        self.assertEqual(made.record_bits, 19 * 18 + 1)
        self.assertEqual(made.latency, 50)

    def test_registered_choices_are_counted_by_their_bits(self):
        text = """  logic small;
  logic [17:0] one, two,
      three;
  always_ff @(posedge clk) one <= a ? two : three;
  always_ff @(posedge clk) two <=
      small ? one : three;
  always_ff @(posedge clk) small <= a ? b : c;
  always_ff @(posedge clk) three <= one;
"""
        made = pipelines.pipeline(text, "localparam int LATENCY = 3;localparam int LAST_READ = 1;", "dsp")
        self.assertEqual(made.selected_bits, 18 + 18 + 1)

    def test_a_narrower_filter_keeps_its_conditions(self):
        lowered = pipelines.Lowered(lower)
        wide, narrow = lowered(anchors.FILTER), lowered(replace(anchors.FILTER, width=14))
        bits = lambda made, width: sum(count for _, each, _, count in made.delays if each == width)
        self.assertEqual((bits(narrow, 14), bits(narrow, 1)), (bits(wide, 18), bits(wide, 1)))
        area = lambda made, width: model.pipeline_area(made, Measured(), width)
        self.assertLess(area(narrow, 14).lut, 0.85 * area(wide, 18).lut)
        self.assertEqual(area(narrow, 14).dsp, area(wide, 18).dsp)

    def test_products_in_luts_are_other_operators(self):
        made = pipelines.Lowered(lower)(replace(anchors.EXACT, products="lut"))
        places = {operator.module: operator.products for operator, _ in made.operators}
        self.assertEqual(places, {"fp_add": "", "fp_less": "", "fp_multiply": "lut", "fp_square": "lut"})
        self.assertEqual(model.pipeline_area(made, Measured()).dsp, 0)

    def test_options_reach_emax_lower(self):
        options = space.Options("filter", (("fixed_add", 2),), "LUT RAM", "dsp", 18)
        self.assertEqual(pipelines.arguments(options), ["filter", "--family", "ecp5", "--latency", "fixed_add=2", "--delay", "memory=9999"])

    def test_a_failure_of_emax_lower_is_one_line(self):
        with tempfile.TemporaryDirectory() as folder:
            program = Path(folder) / "emax_lower"
            with mock.patch.object(pipelines.lowered, "LOWER", program):
                with self.assertRaisesRegex(tools.Failure, "No such file.*./dev build kernel emax_lower makes it"):
                    pipelines.lower(anchors.EXACT)
                program.write_text("#!/bin/sh\necho add must be 1 to 14 >&2; exit 2\n")
                program.chmod(0o755)
                with self.assertRaisesRegex(tools.Failure, "emax_lower visible_edge .*: add must be 1 to 14"):
                    pipelines.lower(anchors.EXACT)


class OperatorsTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        patched = mock.patch.object(operators, "FOLDER", Path(folder.name))
        patched.start()
        self.addCleanup(patched.stop)

    def test_a_binary32_operator_is_that_of_synth(self):
        made = operators.design(pipelines.Operator("fp_add", (("LATENCY", 12),)), 200)
        (known,) = [each for each in designs.operators(designs.GENERATED / "emax_distance.sv", 200) if each.top == "fp_add"]
        self.assertEqual(made, known)

    def test_products_in_luts_read_other_sources(self):
        sources = operators.design(pipelines.Operator("fp_multiply", (("LATENCY", 8),), "lut"), 200).sources("ecp5")
        self.assertIn(designs.RTL / "behavioural/mantissa_multiply.sv", sources)
        self.assertNotIn(designs.RTL / "ecp5/mantissa_multiply.sv", sources)
        self.assertIn(designs.RTL / "ecp5/block_memory.sv", sources)
        self.assertEqual(len(sources), len(set(sources)))

    def test_a_wrapper_has_ports_as_wide_as_its_parameters_make_them(self):
        operator = pipelines.Operator("fixed_fit", (("HALF_UP", 1), ("LATENCY", 2), ("SHIFT", 16), ("WIDTH", 18), ("WIDTH_A", 37)))
        made = operators.design(operator, 200)
        text = made.more[-1].read_text()
        for part in ["module explored_fixed_fit #(parameter int LATENCY = 2)", "input logic [36:0] a", "output logic [17:0] fitted",
                     ".HALF_UP(1), .SHIFT(16), .WIDTH(18), .WIDTH_A(37), .LATENCY(LATENCY)"]:
            self.assertIn(part, text)
        delay = operators.design(operators.LUT_RAM_DELAY, 200).more[-1].read_text()
        self.assertIn('delay_line #(.DEPTH(16), .STYLE("distributed_ram"), .WIDTH(32)) operator', delay)

    def test_every_operator_of_the_space_is_a_design(self):
        for axes, name in [(space.FULL, "full"), (space.QUICK, "quick")]:
            chosen = explore.wanted(axes, pipelines.Lowered(lower))
            names = [operators.design(operator, 200).name for operator in chosen]
            self.assertEqual(len(set(names)), len(names))
            self.assertEqual(len(chosen), explore.OPERATORS[name])
            self.assertTrue(all(len(name) < 100 for name in names))


class CyclesTest(unittest.TestCase):
    def rate(self, elements, clock):
        """10⁹ pairs/s as docs/datasheet.md has them: 16384 points and 2520 triangles in blocks of 1,024 points."""
        taken = cycles.block_cycles("exact", elements, 142, 98, 1024, 2520, 16)
        return 16 * 1024 * 2520 / taken * clock / 1e3

    def test_are_those_of_the_models_in_cpp(self):
        text = (ROOT / "docs/datasheet.md").read_text()
        for name, elements, clock in [("zynq7020", 3, 150), ("u50", 40, 300), ("u250", 80, 300)]:
            given = re.search(rf"^\| `{name}` \|[^|]*\| ([\d.]+) \|", text, re.MULTILINE)[1]
            self.assertEqual(f"{self.rate(elements, clock):.3g}", given, name)

    def test_rise_with_points_records_latency_and_fall_with_elements(self):
        base = ("exact", 2, 142, 98, 100, 30, 3)
        taken = cycles.block_cycles(*base)
        for place, value in [(2, 200), (4, 101), (5, 31), (6, 4)]:
            self.assertGreater(cycles.block_cycles(*base[:place], value, *base[place + 1:]), taken)
        self.assertLess(cycles.block_cycles(*base[:1], 4, *base[2:]), taken)
        self.assertGreaterEqual(taken, 3 * 30 * 50)

    def test_a_wider_filter_leaves_fewer_points(self):
        left = [cycles.points_left(width) for width in (18, 16, 14)]
        self.assertEqual(left, sorted(left))
        rates = [cycles.pairs_per_cycle((1, 142, 98), (4, 40, 22), width) for width in (18, 16, 14)]
        self.assertEqual(rates, sorted(rates, reverse=True))
        self.assertLess(rates[0], 4)
        self.assertGreater(rates[0], 3.5)
        self.assertLess(cycles.pairs_per_cycle((1, 142, 98), None, 0), 1)
        with self.assertRaisesRegex(tools.Failure, "a filter of 12 bits"):
            cycles.points_left(12)

    def test_a_constant_that_is_gone_is_said(self):
        with mock.patch.object(cycles, "SOURCES", cycles.SOURCES[1:]), self.assertRaisesRegex(tools.Failure, "kLeastRows"):
            cycles.constants.__wrapped__()


class AnchorsTest(unittest.TestCase):
    def test_cells_are_counted_as_nextpnr_counts_them(self):
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "netlist.json"
            kinds = ["LUT4"] * 5 + ["CCU2C"] * 3 + ["TRELLIS_DPR16X4"] * 2 + ["TRELLIS_FF"] * 7 + ["MULT18X18D", "DP16KD", "PFUMX"]
            path.write_text(json.dumps({"modules": {
                "box": {"attributes": {"blackbox": "1"}, "cells": {"a": {"type": "LUT4"}}},
                "top": {"attributes": {"top": "1"}, "cells": {str(i): {"type": kind} for i, kind in enumerate(kinds)}}}}))
            self.assertEqual(anchors.counted(path), (5 + 6 + 12, 7, 1, 1, 0))

    def test_the_baseline_has_every_design_that_is_wanted(self):
        (key,) = baseline.read(explore.BASELINE)
        versions = dict(part.split(" ", 1) for part in key.split(", "))
        lowered = pipelines.Lowered(lower)
        found = {each.name: each for each in anchors.placed(explore.BASELINE, versions, lowered)}
        self.assertTrue({"visible_edge", "three_edge", "barycentric", "emax_element", "filter_core, elements: 1",
                         "filter_core, elements: 4"} <= found.keys())
        self.assertEqual(found["filter_core, elements: 4"].pipelines[0][1], 4)
        self.assertEqual(found["filter_core, elements: 4"].parts["record bit"], 4 * 343)
        self.assertNotIn("exact element in a core", found["emax_element"].parts)
        with self.assertRaisesRegex(tools.Failure, "no figures of nextpnr 0, yosys 0; ./dev synth --update-baseline"):
            anchors.placed(explore.BASELINE, {"yosys": "0", "nextpnr": "0"}, lowered)


    def test_the_board_of_the_bitstream_is_read(self):
        lowered = pipelines.Lowered(lower)
        result = {"driven": {}, "figures": {"lut": 38792, "fmax": 122.6}, "elements": 2, "target": 120.0, "seed": 2,
                  "tried": {"2": 122.6}, "promised": {"2": (90.0, 400000)}, "path": None, "top": "emax_ulx3s",
                  "utilisation": {"cells": [41726, 83640], "FF": [53735, 83640], "DSP": [114, 156], "RAM": [50, 208]}}

        def read(**changes):
            used = {**result["utilisation"], **changes}
            page = synthesis_document.board_section("ulx3s", {**result, "utilisation": used}, {"yosys": "1", "nextpnr": "2"})
            return anchors.of_bitstream(page, {"yosys": "1", "nextpnr": "2"}, lowered, Measured())

        (old,) = read()
        self.assertEqual((old.area, old.fmax, old.fits_area), ((38792, 53735, 114, 50, 0), 122.6, False))
        (new,) = read(DSP=[2 * 57 + 40, 156])
        self.assertEqual((new.parts["filter element"], new.parts["core"], new.fits_area), (2, 2, True))
        with self.assertRaisesRegex(tools.Failure, "2 exact elements does not have 113 multipliers"):
            read(DSP=[113, 156])
        text = (ROOT / "docs/synthesis.md").read_text()
        self.assertEqual(anchors.of_bitstream(text, {"yosys": "0", "nextpnr": "0"}, lowered, Measured()), [])
        self.assertEqual(anchors.of_bitstream("# Synthesis\n", {"yosys": "0"}, lowered, Measured()), [])

    def test_a_design_of_older_sources_tells_its_clock_alone(self):
        old = replace(known_anchors()[-1], name="old", area=model.Area(1, 1, 137, 1), fmax=50.0, fits_area=False)
        made = [*known_anchors(), old]
        found = model.fit(made, Measured(), BOARD.capacity)
        for part, area in PARTS.items():
            self.assertAlmostEqual(found.parts[part].lut, area.lut, 4)
        self.assertEqual(model.doubts(found, made), [])
        self.assertGreater(found.crowding[1], model.fit(made[:-1], Measured(), BOARD.capacity).crowding[1])


class RoutingTest(unittest.TestCase):
    def candidate(self, **changes):
        exact = space.Options("visible_edge", (("add", 10), ("multiply", 8), ("square", 8), ("less", 2)))
        made = candidates.Candidate(exact, space.Options("filter", (("fixed_add", 2),), width=18), 1, 4, 40000.0, 43000.0, 50000.0,
                                    137, 118.0, 0.88, 121.0, 120, 4.6e8)
        return replace(made, **changes)

    def test_a_board_reads_what_was_lowered_for_it(self):
        with tempfile.TemporaryDirectory() as folder, mock.patch.object(routing, "FOLDER", Path(folder)):
            board = routing.design(self.candidate(), lower)
            sources = board.sources("ecp5")
            self.assertEqual(board.parameters, {"NUM_PE": 1, "CLOCK_MHZ": 120, "FILTER_PE": 4})
            for path in [designs.GENERATED / "emax_distance.sv", designs.RTL / "emax_element.sv",
                         designs.RTL / "filter/generated/emax_filter_unit.sv", designs.RTL / "filter/filter_element.sv"]:
                self.assertNotIn(path, sources)
                self.assertEqual([each.name for each in sources].count(path.name), 1)
            element = board.replaced[designs.RTL / "emax_element.sv"].read_text()
            self.assertIn("`define EMAX_DISTANCE_LATENCY 135", element)  # 142 - 2 - 2 - 2 - 1
            self.assertNotIn('`include "emax_distance', element)
            self.assertIn("localparam int ADD_LATENCY = 10;", board.replaced[designs.GENERATED / "emax_distance.sv"].read_text())
            self.assertIn(designs.RTL / "ecp5/mantissa_multiply.sv", sources)
            in_luts = routing.design(self.candidate(exact=replace(self.candidate().exact, products="lut")), lower)
            self.assertNotEqual(in_luts.name, board.name)
            self.assertIn(designs.RTL / "behavioural/mantissa_multiply.sv", in_luts.sources("ecp5"))
            self.assertIn(designs.RTL / "ecp5/signed_multiply.sv", in_luts.sources("ecp5"))

    def test_an_element_without_its_schedule_is_refused(self):
        with self.assertRaisesRegex(tools.Failure, "includes 0 schedules"):
            routing.with_schedule("module a;\n", "`define A 1\n")

    def test_a_board_that_is_not_routed_in_time_has_an_area_if_it_was_packed(self):
        class Slow:
            said, log = [], ""
            say = said.append

            def step(self, tool, title, folder, arguments, inputs, outputs, limit=None):
                if tool == "nextpnr":
                    if self.log:
                        path = routing.FOLDER / folder / "nextpnr.log"
                        path.parent.mkdir(parents=True)
                        path.write_text(self.log)
                    raise tools.TookTooLong(f"{title}: ended after {limit} s")
                return [Path(output) for output in outputs]

        with (tempfile.TemporaryDirectory() as folder, mock.patch.object(routing, "FOLDER", Path(folder)),
              mock.patch.object(routing, "design", lambda each: routing.designs.ulx3s(1, 120))):
            self.assertIsNone(routing.route(Slow(), self.candidate(), 2))
            Slow.log = ("Info:     Total LUT4s:     27428/83640    32%\nInfo: \t  DP16KD:      88/    208    42%\n"
                        "Info: \t  MULT18X18D:      97/    156    62%\nInfo: \t  EHXPLLL:       1/      4    25%\n"
                        "Info: \t  TRELLIS_FF:   47846/  83640    57%\nInfo: \t  TRELLIS_COMB:   29522/  83640    35%\n")
            figures = routing.route(Slow(), self.candidate(), 2)
            self.assertEqual(figures, {"lut": 27428, "cells": 29522, "ff": 47846, "dsp": 97, "ram": 88, "fmax": None})
            section = document.routed_section([(self.candidate(), figures)], 2)
            self.assertIn("43,000 / 29,522 (+46%)", section)
            self.assertIn("121.0, not routed within 2 min", section)
        self.assertIn("ended after 120 s", Slow.said[0])


class CommandTest(unittest.TestCase):
    """The whole command in a folder of its own, with operators made up and stand-ins for the tools."""

    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.page = Path(self.folder.name) / "exploration.md"

    def run_command(self, *arguments, designs_measured=None):
        class Place:
            def __init__(self, runner, operator, seeds, at_once):
                self.operator = operator

            def run(self):
                figures = measurement(self.operator)
                return {"figures": figures, "cells": figures["cells"]}

        measured_designs = known_anchors() if designs_measured is None else designs_measured
        out = io.StringIO()
        runner = lambda jobs, fresh, name: tools.Runner(jobs, fresh, {"yosys": ["true"], "nextpnr": ["true"]}, out, name)
        figures = {"lut": 41000, "ff": 51000, "dsp": 137, "ram": 118, "fmax": 101.5, "cells": 44000}
        with (mock.patch.object(sys, "argv", ["explore.py", *arguments]), mock.patch.object(explore, "Ecp5", Place),
              mock.patch.object(explore, "Runner", runner), mock.patch.object(tools.Runner, "prepare"),
              mock.patch.object(pipelines.Lowered.__init__, "__defaults__", (lower,)),
              mock.patch.object(explore.anchors, "placed", lambda *_: measured_designs[:-2]),
              mock.patch.object(explore.anchors, "mapped", lambda *_: measured_designs[-2:]),
              mock.patch.object(explore.routing, "route", lambda runner, each, limit: figures if each.exact_elements == 1 else None),
              mock.patch.object(operators, "design", lambda operator, target: operator),
              mock.patch.object(explore, "DOCUMENT", self.page),
              mock.patch.object(space, "FULL", SMALL), contextlib.redirect_stdout(out)):
            self.assertEqual(explore.main(), 0)
        return out.getvalue()

    def test_writes_the_page(self):
        said = self.run_command("ulx3s", "--route", "2", "--jobs", "3")
        self.assertRegex(said, r"(\d+) of \1 operators measured, about 0:00 left")
        self.assertIn("board 2 of 2", said)
        text = self.page.read_text()
        for part in ["Written by `./dev explore ulx3s`; never edit. Tools: yosys stand-in, nextpnr stand-in.", "## The frontier",
                     f"These are {space.size(SMALL):,} designs.", "fp_add, latency 12", "factor of ", "0.03% at 18 bits",
                     "83,640 cells", "137 / 137 (+0%)", "| board "]:
            self.assertIn(part, text)
        section = text[text.index("## Predicted beside measured"):text.index("## Operators")]
        self.assertEqual(section.count("(+0%)"), 7 * 4 + 2)
        rows = re.findall(r"^\| [12] +\| [024] .*\| ([\d.]+) +\| (yes|no) +\|$", text, re.MULTILINE)
        rates = [float(rate) for rate, _ in rows]
        self.assertGreater(len(rates), 4)
        self.assertEqual(rates, sorted(rates))
        self.assertEqual({built for _, built in rows}, {"yes", "no"})
        again = self.run_command("ulx3s", "--route", "2", "--jobs", "1")
        self.assertEqual(self.page.read_text(), text)
        self.assertIn("written", again)

    def test_quick_writes_nothing(self):
        with mock.patch.object(space, "QUICK", replace(SMALL, add=(12,))):
            said = self.run_command("ulx3s", "--quick")
        self.assertIn("10⁹ pairs/s", said)
        self.assertFalse(self.page.exists())

    def test_a_wrong_measurement_writes_nothing(self):
        wrong = known_anchors()
        wrong[0] = replace(wrong[0], area=wrong[0].area._replace(dsp=3))
        with self.assertRaisesRegex(tools.Failure, "57 multipliers by its operators, 3 measured"):
            self.run_command("ulx3s", designs_measured=wrong)
        self.assertFalse(self.page.exists())

    def test_no_design_that_fits_is_said(self):
        small = {"ulx3s": replace(BOARD, capacity={**BOARD.capacity, "ram": 20})}
        with mock.patch.object(space, "BOARDS", small), self.assertRaisesRegex(tools.Failure, "no design fits the ECP5-85F"):
            self.run_command("ulx3s")

    def test_arguments_are_judged_before_anything_runs(self):
        for arguments, complaint in [(["moon"], "invalid choice: 'moon'"), ([], "required: board"),
                                     (["ulx3s", "--limit", "0"], "must be positive"), (["ulx3s", "--route", "-1"], "0 or more"),
                                     (["ulx3s", "--elements", "3"], "'3' is not E+F, as 1+2")]:
            errors = io.StringIO()
            with (self.subTest(arguments), mock.patch.object(sys, "argv", ["explore.py", *arguments]),
                  contextlib.redirect_stderr(errors), self.assertRaises(SystemExit) as end):
                explore.main()
            self.assertEqual(end.exception.code, 2)
            self.assertIn(complaint, errors.getvalue())

    def test_the_plan_says_how_long_it_takes(self):
        out = io.StringIO()
        with mock.patch.object(sys, "argv", ["explore.py", "ulx3s", "--plan", "--jobs", "1"]), contextlib.redirect_stdout(out):
            self.assertEqual(explore.main(), 0)
        self.assertRegex(out.getvalue(), r"^explore: about 29 operators, 10 min with 1 at a time; .* designs predicted, 1 min;"
                         r" 2 boards placed and routed, at most 5 \+ 60 min each;.* not run again$")

    def test_the_time_left_is_that_of_steps_that_ran(self):
        out = io.StringIO()
        countdown = explore.Countdown(tools.Runner(1, tools={"yosys": ["true"]}, out=out), 10, 2)
        countdown.count(0.0)
        self.assertIn("1 of 10 operators measured, about 1:30 left", out.getvalue())
        countdown.count(20.0)
        countdown.count(40.0)
        self.assertIn("3 of 10 operators measured, about 1:45 left", out.getvalue())

    def test_an_interrupt_stops_the_tools(self):
        runner = tools.Runner(1, tools={"yosys": ["true"]}, out=io.StringIO())
        with mock.patch.object(tools.Background, "wait", side_effect=KeyboardInterrupt), self.assertRaises(KeyboardInterrupt):
            explore.in_background(runner, lambda: None)
        self.assertTrue(runner.stopped)

    def test_nothing_routed_is_said(self):
        self.assertIn("Nothing was routed", document.routed_section([], 5))


if __name__ == "__main__":
    unittest.main()
