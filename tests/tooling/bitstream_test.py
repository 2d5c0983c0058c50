"""The parts of `./dev bitstream` that need no tool: the places of blocks, and which placements are routed and driven.
Run in a folder of its own."""

import argparse
import itertools
import json
import os
import random
import re
import sys
import tempfile
import unittest
from pathlib import Path
from unittest import mock

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "hls/boards"))
import bitstream  # noqa: E402
from synthesis import blocks, designs, tools  # noqa: E402


class BlocksTest(unittest.TestCase):
    def cells(self, **connections):
        """{name: nets} as cells; a name that begins with m is a multiplier, with r a block RAM."""
        kinds = {"m": "MULT18X18D", "r": "DP16KD"}
        return [{"type": kinds.get(name[0], "LUT4"), "attributes": {},
                 "connections": {str(pin): [net] for pin, net in enumerate(nets)}} for name, nets in connections.items()]

    def test_near_blocks_are_drawn_together(self):
        # m_a - one - m_b - two - three - r_c, and a control net with all of them and more
        cells = self.cells(m_a=[1, 90], one=[1, 2, 90], m_b=[2, 3, 90], two=[3, 4, 90], three=[4, 5, 90], r_c=[5, 90],
                           **{f"other{i}": [90, "0"] for i in range(blocks.MOST_PINS)})
        self.assertEqual(blocks.neighbours(cells)[:6], [[0, 1], [0, 1, 2], [1, 2, 3], [2, 3, 4], [3, 4, 5], [4, 5]])
        drawn = blocks.affinities(cells, [0, 2, 5])
        self.assertGreater(drawn[1][0], drawn[1][2])
        self.assertEqual(drawn[0][2], 0)  # the way goes through a block
        self.assertEqual((drawn[0][1], drawn[1][2]), (drawn[1][0], drawn[2][1]))

    def test_an_assignment_is_nearly_the_shortest_of_all(self):
        sites = {"m": [(0, 0, "a"), (3, 0, "b"), (9, 0, "c"), (0, 5, "d")], "r": [(4, 5, "e"), (9, 5, "f"), (5, 9, "g")]}
        kinds = ["m", "r", "m", "r", "m"]
        for seed in range(5):
            chance = random.Random(seed)
            drawn = blocks.both_ways([{b: chance.random() for b in range(5) if b != a} for a in range(5)])
            shortest = min(blocks.length(drawn, [m[0], r[0], m[1], r[1], m[2]]) for m in itertools.permutations(sites["m"], 3)
                           for r in itertools.permutations(sites["r"], 2))
            found = blocks.assign(drawn, kinds, sites, seed, steps=20_000)
            self.assertEqual(len(set(found)), 5)
            self.assertTrue(all(site in sites[kind] for site, kind in zip(found, kinds)))
            self.assertLess(blocks.length(drawn, found), 1.03 * shortest)

    def test_every_block_gets_a_place_of_its_own(self):
        self.assertEqual({kind: len(set(sites)) for kind, sites in blocks.SITES.items()}, {"MULT18X18D": 156, "DP16KD": 208})
        names = {**{f"{'r' if i > 5 else 'm'}{i}": [i, i + 1] for i in range(1, 9)}, "lut": [1, 9]}
        text = json.dumps({"modules": {"top": {"attributes": {"top": "1"}, "cells": dict(zip(names, self.cells(**names)))}}})
        with mock.patch.object(blocks.assign, "__defaults__", (2_000,)):
            placed = blocks.with_places(text, 3)
            self.assertEqual(placed, blocks.with_places(text, 3))
        cells = json.loads(placed)["modules"]["top"]["cells"]
        self.assertEqual(cells.pop("lut")["attributes"], {})
        places = [cell["attributes"]["BEL"] for cell in cells.values()]
        self.assertEqual(len(set(places)), 8)
        self.assertEqual([place.split("/")[2][:3] for place in places], 5 * ["MUL"] + 3 * ["EBR"])


class BitstreamTest(unittest.TestCase):
    def steps(self, fmax, refused=None, clock=120, board="ulx3s", promises=(100.0,)):
        """What is done for a bitstream, of tools and netlists driven, where that netlist is refused. `promises` is
        what nextpnr expects of the placements with the seeds from 1 on, and `fmax` what each is routed with, in
        the order of the routings."""
        done, results = [], []
        routings = iter(fmax if isinstance(fmax, list) else [fmax] * len(promises))

        class Steps:
            say = staticmethod(lambda text: None)

            def step(self, tool, title, folder, arguments, inputs, outputs, limit=None):
                seed = re.search(r"/seed(\d+)/(\w+)$", folder)
                done.append(f"{seed[2]} {seed[1]}" if seed else tool)
                self.arguments = arguments
                return [Path(folder) / output for output in outputs]

        def drive(name, arguments):
            done.append(name)
            if name == refused:
                raise tools.Failure(f"{name} is refused")
            return "driven"

        options = argparse.Namespace(board=board, elements=1, clock=clock, first_seed=1, seeds=len(promises), limit=1, jobs=1)
        promised = lambda log: (promises[int(re.search(r"/seed(\d+)/", str(log))[1]) - 1], 400000)
        with (mock.patch.object(bitstream.netlists, "renamed"), mock.patch.object(bitstream.netlists, "write"),
              mock.patch.object(bitstream.comparison, "drive", drive), mock.patch.object(bitstream.comparison, "holds"),
              mock.patch.object(bitstream, "routed"), mock.patch.object(bitstream.designs, "promised", promised),
              mock.patch.object(bitstream, "with_blocks", lambda netlist, folder, seed: netlist),
              mock.patch.object(bitstream, "for_router", lambda placed, clock: placed),
              mock.patch.object(bitstream.designs, "board_figures", lambda *_: ({"fmax": next(routings)}, {}))):
            self.addCleanup(os.chdir, os.getcwd())
            os.chdir(Path(__file__).resolve().parents[2])
            try:
                bitstream.build(Steps(), options, results)
            except tools.Failure as failure:
                done.append("refused")
                self.said = str(failure)
        self.result = results[0] if results else None
        return done

    def test_a_bitstream_is_of_what_was_driven(self):
        routed_once = ["yosys", "board1_ecp5", "placement 1", "route 1"]
        self.assertEqual(self.steps(130.0), [*routed_once, "board1_routed", "ecppack"])
        self.assertEqual(self.steps(130.0, "board1_ecp5"), ["yosys", "board1_ecp5", "refused"])
        self.assertEqual(self.steps(130.0, "board1_routed"), [*routed_once, "board1_routed", "refused"])
        self.assertEqual(self.steps(110.0), routed_once)

    def test_a_slower_clock_is_that_of_what_is_driven(self):
        routed_once = ["yosys", "board1at105_ecp5", "placement 1", "route 1"]
        self.assertEqual(self.steps(110.0, clock=105), [*routed_once, "board1at105_routed", "ecppack"])
        self.assertEqual(self.steps(100.0, clock=105), routed_once)
        self.assertEqual(designs.ulx3s(1, 105).parameters, {"NUM_PE": 1, "CLOCK_MHZ": 105})

    def test_all_sources_have_the_clock_of_the_bitstream(self):
        root = Path(__file__).resolve().parents[2]
        for path, pattern in {"hls/boards/ulx3s/emax_ulx3s.sv": r"parameter int CLOCK_MHZ = (\d+)\b",
                              "hls/boards/ulx3s/emax_ulx3s_sdram.sv": r"parameter int CLOCK_MHZ = (\d+)\b",
                              "sw_model/protocol/cycle_model.h": r"constexpr std::uint64_t kUlx3sClockMhz = (\d+);"}.items():
            self.assertEqual(re.findall(pattern, (root / path).read_text()), [str(bitstream.CLOCK)], path)

    def test_the_board_with_its_sdram_is_another(self):
        done = self.steps(110.0, clock=105, board="ulx3s-sdram")
        self.assertEqual(done, ["yosys", "board1sdramat105_ecp5", "placement 1", "route 1", "board1sdramat105_routed", "ecppack"])
        self.assertEqual(self.result["top"], "emax_ulx3s_sdram")
        names = [path.name for path in designs.ulx3s(1, 105, sdram=True).sources("ecp5")]
        self.assertEqual(len(names), len(set(names)))
        for name in ("emax_ulx3s_sdram.sv", "sdram_controller.sv", "sdram_pins.sv", "emax_link.sv"):
            self.assertIn(name, names)
        self.assertNotEqual(designs.ulx3s(1).name, designs.ulx3s(1, sdram=True).name)
        pins = [name for name in bitstream.placement("n", 1, 105, board="ulx3s-sdram") if name.endswith(".lpf")]
        self.assertEqual(pins, [f"{designs.ULX3S}/ulx3s.lpf", f"{designs.ULX3S}/ulx3s_sdram.lpf"])

    def test_the_best_placement_is_routed_first(self):
        placed = ["yosys", "board1_ecp5", "placement 1", "placement 2", "placement 3"]
        self.assertEqual(self.steps([110.0, 121.0], promises=(80.0, 75.0, 90.0)),
                         [*placed, "route 3", "route 1", "board1_routed", "ecppack"])
        self.assertEqual(self.result["promised"], {"1": (80.0, 400000), "2": (75.0, 400000), "3": (90.0, 400000)})
        self.assertEqual(self.result["tried"], {"3": 110.0, "1": 121.0})

    def test_a_placement_that_promises_too_little_is_given_up(self):
        least = 120 * bitstream.LEAST_PROMISE
        self.assertEqual(self.steps([110.0, 110.0], promises=(least - 0.1, least, 90.0))[-2:], ["route 3", "route 2"])
        self.assertEqual(self.steps(130.0, promises=(least - 0.1, 20.0))[-2:], ["placement 2", "refused"])
        self.assertIn(f"no placement is worth routing: {least - 0.1:.1f} MHz", self.said)

    def test_the_router_has_a_margin(self):
        with tempfile.TemporaryDirectory() as folder:
            placed = Path(folder) / "placed.json"
            placed.write_text('{"settings": {"target_freq": "105000000.000000", "router": "router2"}}')
            given = bitstream.for_router(placed, 107.1)
            self.assertEqual(json.loads(given.read_text()), {"settings": {"target_freq": "107100000.000000", "router": "router2"}})
            placed.write_text("{}")
            with self.assertRaisesRegex(tools.Failure, "names 0 clocks"):
                bitstream.for_router(placed, 107.1)

    def test_what_nextpnr_expects_is_that_of_the_fastest_constraint(self):
        with tempfile.TemporaryDirectory() as folder:
            log = Path(folder) / "log"
            log.write_text("Info:   at iteration #1: temp = 0.0, timing cost = 3, wirelen = 437421\n"
                           "Info:   at iteration #5: temp = 0.0, timing cost = 3, wirelen = 403031\n"
                           "Info: Max frequency for clock 'slow': 300.00 MHz (PASS at 25.00 MHz)\n"
                           "Info: Max frequency for clock '$glbnet$clk': 67.71 MHz (FAIL at 105.01 MHz)\n")
            self.assertEqual(designs.promised(log), (67.71, 403031))
            log.write_text("Info: nothing\n")
            with self.assertRaisesRegex(tools.Failure, "does not say what clock"):
                designs.promised(log)

    def tried(self, clocks, at_once, target=120.0):
        route = lambda seed: {"seed": seed, "figures": {"fmax": clocks[seed - 1]}}
        seeds = range(1, len(clocks) + 1)
        return [result["seed"] for result in bitstream.first_that_meets(route, seeds, at_once, target)]

    def test_placements_are_routed_until_one_meets_the_clock(self):
        self.assertEqual(self.tried([110.0, 120.0, 130.0], 1), [1, 2])
        self.assertEqual(self.tried([110.0, 119.9, 115.0], 1), [1, 2, 3])

    def test_a_placement_that_is_not_routed_is_passed_over(self):
        route = {1: None, 2: {"figures": {"fmax": 120.0}}, 3: None}.get
        self.assertEqual(bitstream.first_that_meets(route, range(1, 4), 1, 120.0), [None, route(2)])

    def test_the_result_does_not_depend_on_how_many_run_at_once(self):
        for at_once in (1, 2, 3, 4):
            self.assertEqual(self.tried([110.0, 121.0, 130.0, 110.0], at_once), [1, 2])

    def test_a_board_has_all_sources_once_and_its_own_clock(self):
        self.addCleanup(os.chdir, os.getcwd())
        os.chdir(Path(__file__).resolve().parents[2])
        names = [path.name for path in designs.ulx3s(2, 120).sources("ecp5")]
        self.assertEqual(len(names), len(set(names)))
        for name in ("emax_ulx3s.sv", "ulx3s_clock.sv", "emax_link.sv", "emax_core.sv", "emax_element.sv"):
            self.assertIn(name, names)
        self.assertNotIn("behavioural", str(designs.ulx3s(2, 120).more))

    def test_a_boards_figures_count_the_whole_device(self):
        report = {"utilization": {"TRELLIS_COMB": {"used": 140, "available": 83640},
                                  "TRELLIS_FF": {"used": 220, "available": 83640}},
                  "fmax": {"clk": {"achieved": 121.256, "constraint": 120}, "slow": {"achieved": 300, "constraint": 25}},
                  "critical_paths": []}
        with tempfile.TemporaryDirectory() as folder:
            report_path, log = Path(folder) / "report", Path(folder) / "log"
            report_path.write_text(json.dumps(report))
            log.write_text("Info: Total LUT4s:  110/83640  0%\n")
            figures, detail = designs.board_figures(report_path, log)
        self.assertEqual(figures, {"lut": 110, "ff": 220, "dsp": 0, "ram": 0, "fmax": 121.26})
        self.assertEqual(detail, {"path": None, "utilisation": {"cells": [140, 83640], "FF": [220, 83640]}})


if __name__ == "__main__":
    unittest.main()
