"""The parts of `./dev synth` that need no tool: the comparison with the baseline, the steps and
their memory, the shell, and what is read out of the tools' files. Run in a folder of its own."""

import io
import json
import os
import re
import sys
import tempfile
import time
import unittest
from pathlib import Path
from unittest import mock

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "hls/boards"))
import front_ends  # noqa: E402
import synthesize  # noqa: E402
from synthesis import baseline, comparison, contracts, designs, document, netlists, power, routed, tools  # noqa: E402

FIGURES = {"element: e": {"lut": 1000, "ff": 2000, "dsp": 60, "ram": 0, "fmax": 175.0}}


class BaselineTest(unittest.TestCase):
    def faults(self, changes, complete=True):
        return baseline.compare({"element: e": {**FIGURES["element: e"], **changes}}, FIGURES, complete)

    def test_equal_better_and_tolerated_figures_pass(self):
        self.assertEqual(self.faults({}), [])
        self.assertEqual(self.faults({"lut": 900, "dsp": 59, "fmax": 300.0}), [])
        self.assertEqual(self.faults({"lut": 1030, "ff": 2100, "fmax": 157.5}), [])

    def test_each_worsened_figure_is_named(self):
        for figure, value in {"lut": 1031, "ff": 2101, "dsp": 61, "ram": 1, "fmax": 157.4}.items():
            (fault,) = self.faults({figure: value})
            self.assertIn(f"element: e: {figure} {value:g} is worse than the baseline's", fault)

    def test_figures_on_one_side_only_are_faults(self):
        self.assertIn("not in the baseline", self.faults({"latency": 3})[0])
        short = {"element: e": {"lut": 1000}}
        self.assertEqual(len(baseline.compare(short, FIGURES, False)), 4)
        self.assertEqual(len(baseline.compare({}, FIGURES, True)), 5)
        self.assertEqual(baseline.compare({}, FIGURES, False), [])

    def test_a_partial_run_updates_its_part_of_the_file(self):
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "baseline.json"
            versions = {"yosys": "1", "nextpnr": "2"}
            baseline.write(path, versions, FIGURES, True)
            baseline.write(path, versions, {"xilinx: f": {"lut": 5}}, False)
            known = baseline.read(path)[baseline.key(versions)]
            self.assertEqual(known, {**FIGURES, "xilinx: f": {"lut": 5}})
            baseline.write(path, versions, FIGURES, True)
            self.assertEqual(list(baseline.read(path)[baseline.key(versions)]), ["element: e"])


class ContractsTest(unittest.TestCase):
    """What Yosys reads of the assertions is compared with their text."""

    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.source, self.netlist = Path(self.folder.name, "a.sv"), Path(self.folder.name, "a.json")
        self.source.write_text("// `ASSERT(in, a comment)\n`ASSERT(a, \"x\");\n  if (b) `ASSERT(b,\n    \"y\");\n")

    def netlist_of(self, *places):
        cells = {place: {"type": "$check", "parameters": {"FLAVOR": "assert"}, "attributes": {"src": place}}
                 for place in places}
        cells["other"] = {"type": "$add", "parameters": {}, "attributes": {"src": "a.sv:1.1-1.2"}}
        twice = {"once": {"cells": cells}, "again": {"cells": cells}}  # two instances of one module
        self.netlist.write_text(json.dumps({"modules": twice}))
        return contracts.read(self.netlist)

    def test_each_assertion_is_counted_once(self):
        path = str(self.source)
        self.assertEqual(contracts.written([self.source]), {path: 2})
        self.assertEqual(self.netlist_of(f"{path}:2.1-2.9", f"{path}:4.1-4.9"), {path: 2})
        contracts.compare({path: 2}, {path: 2})

    def test_a_lost_assertion_is_a_failure(self):
        with self.assertRaisesRegex(tools.Failure, "a.sv has 2 assertions, of which Yosys reads 1"):
            contracts.compare({"a.sv": 2}, {"a.sv": 1})
        with self.assertRaisesRegex(tools.Failure, "a.sv has 0 assertions, of which Yosys reads 1"):
            contracts.compare({"b.sv": 1}, {"b.sv": 1, "a.sv": 1})
        with self.assertRaisesRegex(tools.Failure, "no assertion"):
            contracts.compare({}, {})


class StepTest(unittest.TestCase):
    """A shell in the place of Yosys."""

    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.addCleanup(os.chdir, os.getcwd())
        os.chdir(self.folder.name)
        Path("in").write_text("1")

    def runner(self, **options):
        return tools.Runner(1, tools={"yosys": ["sh"]}, out=io.StringIO(), **options)

    def step(self, runner, script, outputs=("out",), **options):
        return runner.step("yosys", "a step", "s", ["-c", script], [Path("in")], outputs, **options)

    def test_is_run_again_only_when_something_changed(self):
        script = "echo x >>{folder}/out"
        lines = lambda: len(Path("build/synth/s/out").read_text().splitlines())
        for _ in range(2):
            (out,) = self.step(self.runner(), script)
            self.assertEqual(lines(), 1)
        Path("in").write_text("2")
        self.step(self.runner(), script)
        self.assertEqual(lines(), 2)
        self.step(self.runner(), script + "; true")
        self.assertEqual(lines(), 3)
        self.step(self.runner(fresh=True), script + "; true")
        self.assertEqual(lines(), 4)
        out.unlink()
        self.step(self.runner(), script + "; true")
        self.assertEqual(lines(), 1)

    def test_a_failure_shows_the_end_of_the_log_and_its_path_and_is_not_remembered(self):
        for _ in range(2):
            with self.assertRaisesRegex(tools.Failure, "(?s)broken wire.*status 3.*build/synth/s/yosys.log"):
                self.step(self.runner(), "touch {folder}/out; echo broken wire; exit 3")
        with self.assertRaisesRegex(tools.Failure, "did not write build/synth/s/none"):
            self.step(self.runner(), "true", ["none"])

    def test_a_step_at_its_time_limit_is_ended_and_is_not_remembered(self):
        script = "touch {folder}/out; exec sleep 60"
        for _ in range(2):
            start = time.monotonic()
            with self.assertRaisesRegex(tools.TookTooLong, "a step: ended after 0:00; its log is build/synth/s/yosys.log"):
                self.step(self.runner(), script, limit=0.2)
            self.assertLess(time.monotonic() - start, 30)
        self.step(self.runner(), "touch {folder}/out", limit=30)

    def test_stopping_ends_the_tool_and_its_children(self):
        runner = self.runner()
        work = tools.Background(runner)
        work.start(self.step, runner, "sleep 60 & echo $! >{folder}/child; wait")
        child = Path("build/synth/s/child")
        deadline = time.monotonic() + 20
        while not (child.exists() and child.read_text().strip()) and time.monotonic() < deadline:
            time.sleep(0.01)
        runner.stop()
        with self.assertRaisesRegex(tools.Failure, "stopped"):
            work.wait()
        status = Path(f"/proc/{child.read_text().strip()}/stat")
        while status.exists() and status.read_text().split()[2] != "Z" and time.monotonic() < deadline:
            time.sleep(0.01)
        self.assertTrue(not status.exists() or status.read_text().split()[2] == "Z")

    def test_a_failure_in_the_background_is_raised(self):
        work = tools.Background(self.runner())
        work.start(lambda: {}["no such key"])
        with self.assertRaises(KeyError):
            work.wait()

    def test_progress_names_the_stage(self):
        Path("log").write_text("Info: Packing carries..\nInfo: Routing globals...\nInfo: more\n")
        self.assertEqual(tools.stage_of("log"), "routing")
        self.assertEqual(tools.stage_of("none"), "")


class ComparisonTest(unittest.TestCase):
    """A program that says what it is told to in the place of one that drives a netlist."""

    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.build = Path(self.folder.name)
        for name in ["bin", "netlists", "tools"]:
            (self.build / name).mkdir()
        self.addCleanup(os.environ.__setitem__, "PATH", os.environ["PATH"])
        os.environ["PATH"] = f"{self.build / 'tools'}:{os.environ['PATH']}"
        self.program("tools/cmake", "exit 0")

    def program(self, name, body):
        path = self.build / name
        path.write_text(f"#!/bin/sh\n{body}\n")
        path.chmod(0o755)

    def drive(self, body):
        self.program("bin/netlist_x", body)
        return comparison.drive("x", ["--frames", 3], self.build)

    def test_a_netlist_that_is_its_source_passes(self):
        self.assertEqual(self.drive("echo 'netlist: 12 results, 0 mismatches'"), "netlist: 12 results, 0 mismatches")
        self.assertIn("5 answers", self.drive("echo 'fuzz: seed 1, 30 frames, 5 answers right, 0 wrong'"))

    def test_everything_else_is_refused(self):
        for body in ["echo 'netlist: 12 results, 1 mismatches'; exit 1", "echo 'netlist: 12 results, 3 mismatches'",
                     "echo 'netlist: 0 results, 0 mismatches'", "true", "exit 1",
                     "echo 'fuzz: seed 1, 30 frames, 0 answers right, 0 wrong'",
                     "echo 'fuzz: seed 1, 30 frames, 4 answers right, 1 wrong'"]:
            with self.subTest(body), self.assertRaises(tools.Failure):
                self.drive(body)
        self.program("tools/cmake", "echo cannot build; exit 1")
        with self.assertRaisesRegex(tools.Failure, "cannot build"):
            self.drive("echo 'netlist: 12 results, 0 mismatches'")

    def test_another_netlist_than_the_one_driven_is_refused(self):
        (self.build / "netlists/x.v").write_text("a\nb")
        comparison.holds("x", ["a", "b"], self.build)
        for wrong in [["a", "c"], []]:
            with self.assertRaises(tools.Failure):
                comparison.holds("x", wrong, self.build)


class DesignTest(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)

    def file(self, content, name="file"):
        path = Path(self.folder.name) / name
        path.write_text(content if isinstance(content, str) else json.dumps(content))
        return path

    def test_operators_have_the_latencies_of_the_datapath(self):
        text = """  localparam int ADD_LATENCY = 12;
  fp_add #(.SUBTRACT(1'b1), .LATENCY(ADD_LATENCY)) a (
  fp_less #(.LATENCY(2)) b ("""
        found = {d.top: d.parameters["LATENCY"] for d in designs.operators(self.file(text), 200)}
        self.assertEqual(found, {"fp_add": 12, "fp_less": 2})
        with self.assertRaises(tools.Failure):
            designs.operators(self.file("module empty; endmodule"), 200)

    def test_the_shell_reaches_every_port_bit_once(self):
        design = designs.Design("d", "d", 100, {"N": 4})
        text = designs.shell(design, [("clk", "input", 1), ("a", "input", 8), ("b", "input", 1), ("q", "output", 3)])
        for part in [".a(offered[7:0])", ".b(offered[8:8])", ".q(out[2:0])", "reg [8:0] held", "reg [2:0] given, taken", "#(.N(4))"]:
            self.assertIn(part, text)

    def test_a_netlist_is_renamed_only_where_it_is_one_module(self):
        text = "module \\$paramod\\fp_add\\LATENCY=s32'1 (clk, a);\n  wire module_x;\nendmodule\n"
        self.assertTrue(netlists.renamed(self.file(text), "n").startswith("module n(clk, a);\n"))
        for wrong in [text + text, "// nothing\n"]:
            with self.assertRaises(ValueError):
                netlists.renamed(self.file(wrong), "n")

    def test_a_netlist_that_stands_there_is_not_written_again(self):
        path = self.file("text")
        os.utime(path, (0, 0))
        netlists.write(path, "text")
        self.assertEqual(path.stat().st_mtime, 0)
        netlists.write(path, "other")
        self.assertEqual(path.read_text(), "other")

    def test_a_source_replaced_is_read_in_its_place(self):
        source = designs.RTL / "fp_add.sv"
        design = designs.Design("d", "fp_add", 0, replaced={source: Path("other.sv")})
        self.assertNotIn(source, design.sources("behavioural"))

    def test_what_a_front_end_remarks_on_is_found(self):
        permitted = ("Warning: Replacing memory \\stage with list of registers. See x.sv:1\n"
                     "Build succeeded: 0 errors, 0 warnings\nWarnings: 1 unique messages, 1 total\n")
        self.assertEqual(front_ends.remarks(permitted), [])
        self.assertEqual(front_ends.remarks(permitted + "x.sv:3:4: warning: width\nWarning: latch"),
                         ["x.sv:3:4: warning: width", "Warning: latch"])
        self.assertEqual(len(front_ends.remarks("Build succeeded: 0 errors, 2 warnings")), 1)

    def test_the_critical_path_is_the_clocks_own(self):
        step = lambda kind, delay: {"type": kind, "delay": delay, "from": {"cell": "design.a_TRELLIS_FF_Q"},
                                    "to": {"cell": "design.b_TRELLIS_FF_Q_DI_LUT4_Z"}}
        steps = [step("clk-to-q", 0.5), step("routing", 1.25), step("logic", 0.25), step("setup", 0.0)]
        report = {"utilization": {"TRELLIS_COMB": {"used": 140}, "TRELLIS_FF": {"used": 220},
                                  "MULT18X18D": {"used": 4}},
                  "fmax": {"$clk": {"achieved": 181.256, "constraint": 175}},
                  "critical_paths": [{"from": "<async>", "to": "posedge $clk", "path": [step("routing", 9)]},
                                     {"from": "posedge $clk", "to": "posedge $clk", "path": steps}]}
        cells = Path(self.folder.name) / "cells"
        cells.write_text(json.dumps({"modules": {
            "\\synthesis_shell": {"num_cells_by_type": {"LUT4": 10, "TRELLIS_FF": 20}},
            "\\d": {"num_cells_by_type": {"LUT4": 100}}}}))
        log = Path(self.folder.name) / "log"
        log.write_text("Info: Total LUT4s:  110/83640  0%\n")
        figures, detail = designs.ecp5_figures(self.file(report), log, cells)
        self.assertEqual(detail["cells"], 130)
        self.assertEqual(figures, {"lut": 100, "ff": 200, "dsp": 4, "ram": 0, "fmax": 181.26})
        self.assertEqual(detail["path"], {"from": "a", "to": "b", "logic": 0.75, "routing": 1.25, "levels": 1})
        log.write_text("")
        with self.assertRaises(tools.Failure):
            designs.ecp5_figures(self.file(report), log, cells)

    def test_figures_of_nexus_leave_the_shell_out(self):
        report = {"utilization": {"OXIDE_COMB": {"used": 140}, "OXIDE_FF": {"used": 220}, "OXIDE_EBR": {"used": 3}},
                  "fmax": {"clk": {"achieved": 131.256, "constraint": 120}}, "critical_paths": []}
        cells = {"modules": {"\\synthesis_shell": {"num_cells_by_type": {"LUT4": 10, "FD1P3IX": 20}},
                             "\\d": {"num_cells_by_type": {"LUT4": 100, "MULT18X18": 4}},
                             "\\e": {"num_cells_by_type": {"MULT18X18": 1}}}}
        figures, detail = designs.nexus_figures(self.file(report), self.file(cells, "cells"))
        self.assertEqual(figures, {"lut": 130, "ff": 200, "dsp": 5, "ram": 3, "fmax": 131.26})
        self.assertEqual(detail, {"cells": 130, "path": None})

    def test_yosys_infers_no_multipliers_for_nexus(self):
        # It loses registers that two of them share (docs/decisions/0048-a-filter-on-nexus.md).
        self.addCleanup(os.chdir, os.getcwd())
        os.chdir(Path(__file__).resolve().parents[2])
        design = designs.filter_core(1, 0)
        self.assertIn(designs.RTL / "nexus/signed_multiply.sv", design.sources("nexus"))
        self.assertIn(" -nodsp ", designs.nexus_script(design, Path("shell.v")))

    def carry_chain(self, **first):
        """A netlist for Nexus with a chain of two cells, the first with these connections or entries."""
        carry = lambda entries, **pins: {"type": "CCU2", "parameters": {"INIT0": entries, "INIT1": "0x00AA"}, "connections": pins}
        entries = first.pop("INIT0", "0xFFFF")
        cells = {"low": {"type": "VLO", "connections": {"Z": [7]}}, "high": {"type": "VHI", "connections": {"Z": [6]}},
                 "first": carry(entries, **{"CIN": [7], "D1": [6], "S0": [4], "S1": [5], "COUT": [8], **first}),
                 "second": carry("0x96AA", CIN=[8], D1=[6], S0=[9], COUT=[]), "read": {"type": "LUT4", "connections": {"A": [9]}},
                 "free": carry("0x96AA", CIN=[], D1=[6])}
        return json.dumps({"modules": {"m": {"cells": cells}}})

    def test_first_cells_of_a_carry_chain_have_no_carry_in(self):
        cells = json.loads(netlists.without_first_carries(self.carry_chain()))["modules"]["m"]["cells"]
        self.assertEqual([cells[name]["connections"]["CIN"] for name in ("first", "second", "free")], [[], [8], []])

    def test_a_first_cell_that_its_carry_in_matters_to_is_refused(self):
        for first in [{"INIT0": "0x96AA"}, {"D1": [7]}, {"S0": [9]}]:
            with self.subTest(first), self.assertRaisesRegex(tools.Failure, "first: a carry cell of another kind"):
                netlists.without_first_carries(self.carry_chain(**first))

    def test_one_lut_is_inverted(self):
        lut = lambda entries: f'  LUT4 #(\n    .INIT("0x{entries}")\n  ) x (.A(a));\n'
        self.assertEqual(netlists.with_an_inverted_lut(lut("0001") + lut("0a0f") + lut("0003")),
                         lut("0001") + lut("f5f0") + lut("0003"))

    def test_dsp_blocks_without_inner_registers_are_seen(self):
        dsp = lambda **registers: {"type": "DSP48E1", "parameters": {k: f"{v:032b}" for k, v in registers.items()}}
        cells = {"a": dsp(AREG=1, BREG=2, MREG=1, PREG=0), "b": dsp(AREG=1, BREG=1, MREG=0, PREG=0),
                 "c": dsp(AREG=0, BREG=1, MREG=1), "d": {"type": "LUT6"}, "e": {"type": "SRL16E"},
                 "f": {"type": "RAM32M"}, "g": {"type": "FDRE"}, "h": {"type": "CARRY4"}}
        netlist = {"modules": {"cell": {"attributes": {}}, "top": {"attributes": {"top": 1}, "cells": cells}}}
        figures, detail = designs.xilinx_figures(self.file(netlist))
        self.assertEqual(figures, {"lut": 6, "ff": 1, "dsp": 3, "ram": 0})
        self.assertEqual(detail, {"srl": 1, "ram_luts": 4, "registered": 2, "registered_inputs": 2})


def cell(kind, place="X1/Y2/SLICEA.K1", parameters=None, outputs=(), **connections):
    """A cell of nextpnr's file; a net of 0 is none."""
    direction = lambda port: ("inout" if kind == "TRELLIS_IO" and port == "B" else
                              "output" if port in outputs else "input")
    return {"type": kind, "parameters": parameters or {}, "attributes": {"NEXTPNR_BEL": place},
            "port_directions": {port: direction(port) for port in connections},
            "connections": {port: [net] if net else [] for port, net in connections.items()}}


class RoutedTest(unittest.TestCase):
    """An inverter between two pins, as nextpnr writes it."""

    def setUp(self):
        self.module = {
            "ports": {"a": {"direction": "input", "bits": [1]}, "q": {"direction": "output", "bits": [2, 3]}},
            "netnames": {"a": {"bits": [1]}, "lost": {"bits": [9]}},
            "cells": {
                "a$tr_io": cell("TRELLIS_IO", parameters={"DIR": "INPUT"}, outputs=["O"], B=1, I=0, T=0, O=4),
                "q$tr_io": cell("TRELLIS_IO", parameters={"DIR": "OUTPUT"}, outputs=["O"], B=2, I=5, T=0, O=0),
                "r$tr_io": cell("TRELLIS_IO", parameters={"DIR": "OUTPUT"}, outputs=["O"], B=3, I=4, T=0, O=0),
                "lut": cell("TRELLIS_COMB", parameters={"INITVAL": "0101010101010101"}, outputs=["F"], A=4, B=0, F=5),
                "place": cell("TRELLIS_COMB", parameters={"MODE": "RAMW_BLOCK"}, outputs=["F"], A=0, F=0)}}

    def text(self):
        return routed.verilog(self.module, "top")

    def test_a_design_keeps_its_ports(self):
        self.assertEqual(self.text(), """module top (input a, output [1:0] q);
  wire n4;
  wire n5;
  TRELLIS_IO #(.DIR("INPUT")) c0 (.B(a), .I(1'bx), .T(1'b0), .O(n4));  // a$tr_io
  TRELLIS_IO #(.DIR("OUTPUT")) c1 (.B_OUT(q[0]), .I(n5), .T(1'b0));  // q$tr_io
  TRELLIS_IO #(.DIR("OUTPUT")) c2 (.B_OUT(q[1]), .I(n4), .T(1'b0));  // r$tr_io
  TRELLIS_COMB #(.INITVAL(16'b0101010101010101), .HALF("K1")) c3 (.A(n4), .B(1'b0), .F(n5));  // lut
endmodule
""")

    def test_a_net_has_one_driver(self):
        for change, complaint in [({"A": [9]}, "no driver of lost"), ({"F": [1]}, "two drivers of a"),
                                  ({"F": [4]}, "two drivers of 4"), ({"F": []}, "no driver of 5")]:
            with self.subTest(change), self.assertRaisesRegex(tools.Failure, complaint):
                self.setUp()
                self.module["cells"]["lut"]["connections"].update(change)
                self.text()
        self.setUp()
        del self.module["cells"]["r$tr_io"]
        with self.assertRaisesRegex(tools.Failure, "no driver of 3"):
            self.text()

    def test_an_input_without_a_net_has_the_fabrics_value(self):
        for kind, parameters, port, expected in [
                ("TRELLIS_COMB", {}, "A", "0"), ("TRELLIS_COMB", {"MODE": "CCU2"}, "C", "1"),
                ("TRELLIS_COMB", {"MODE": "CCU2"}, "FCI", "x"), ("TRELLIS_FF", {"LSRMUX": "LSR"}, "LSR", "0"),
                ("TRELLIS_FF", {"LSRMUX": "INV"}, "LSR", "x"), ("TRELLIS_FF", {}, "CE", "x"),
                ("DCCA", {}, "CE", "1"), ("MULT18X18D", {"A3MUX": "1 "}, "A3", "1"), ("MULT18X18D", {}, "B3", "0"),
                ("MULT18X18D", {}, "CE0", "x"), ("MULT18X18D", {}, "C12", None), ("MULT18X18D", {}, "SRIA0", None),
                ("DP16KD", {"ADA0MUX": "1 "}, "ADA0", "1"), ("DP16KD", {}, "ADB0", "0"), ("DP16KD", {}, "WEA", "0"),
                ("DP16KD", {"WEAMUX": "WEA"}, "WEA", "1"), ("DP16KD", {}, "CEA", "1"), ("DP16KD", {}, "OCEB", "1"),
                ("DP16KD", {"OCEBMUX": "INV"}, "OCEB", "0"), ("DP16KD", {}, "CSB2", "0"),
                ("DP16KD", {}, "DIB0", None)]:
            with self.subTest((kind, parameters, port)):
                self.assertEqual(routed.tied(kind, parameters, port), expected)

    def test_a_multiplexer_is_left_to_the_model_where_a_net_reaches_it(self):
        for net, expected in [(0, "DP16KD #() c0 (.WEA(1'b1));"), (4, 'DP16KD #(.WEAMUX("INV")) c0 (.WEA(n4));')]:
            parameters = {"WEAMUX": "INV" if net else "WEA"}
            nets = routed.Nets(self.module)
            self.assertIn(expected, routed.instance(0, "m", cell("DP16KD", parameters=parameters, WEA=net), nets))

    def test_a_pin_of_both_directions_and_its_registers(self):
        self.module["ports"]["d"] = {"direction": "inout", "bits": [6]}
        self.module["cells"] = {
            "d": cell("TRELLIS_IO", parameters={"DIR": "BIDIR"}, outputs=["O"], B=6, IOLDO=7, T=0, O=8),
            "d$IOL": cell("IOLOGIC", parameters={"OUTREG.REGSET": "SET"}, outputs=["IOLDO"], TXDATA0=8, IOLDO=7)}
        del self.module["ports"]["q"]
        self.assertEqual(self.text(), """module top (input a, inout d);
  wire n7;
  wire n8;
  TRELLIS_IO #(.DIR("BIDIR")) c0 (.B_BOTH(d), .IOLDO(n7), .T(1'b0), .O(n8));  // d
  IOLOGIC #(.OUTREG_REGSET("SET")) c1 (.TXDATA0(n8), .IOLDO(n7));  // d$IOL
endmodule
""")

    def test_a_design_routed_from_its_placement_has_its_ports_again(self):
        placed, shift = self.module, 20
        whole = self.text()
        renumbered = lambda net: net + shift
        placed["netnames"] = {f"net {net}": {"bits": [net]} for net in range(1, 6)}
        self.module = {"ports": {}, "netnames": {name: {"bits": [renumbered(net) for net in item["bits"]]}
                                                 for name, item in placed["netnames"].items()}, "cells": {}}
        for name, each in placed["cells"].items():
            joined = {pin: [renumbered(net) for net in nets] for pin, nets in each["connections"].items() if nets}
            self.module["cells"][name] = {**each, "connections": joined,
                                          "port_directions": {pin: each["port_directions"][pin] for pin in joined}}
        again = routed.verilog(routed.rejoined(self.module, placed), "top")
        self.assertEqual(re.sub(r"\bn2(\d)\b", r"n\1", again), whole)
        moved = json.loads(json.dumps(self.module))
        moved["cells"]["lut"]["attributes"]["NEXTPNR_BEL"] = "X2/Y1/SLICEA.K1"
        with self.assertRaisesRegex(tools.Failure, "lut is routed in another place"):
            routed.rejoined(moved, placed)
        del self.module["cells"]["lut"]
        with self.assertRaisesRegex(tools.Failure, "other cells than its placement"):
            routed.rejoined(self.module, placed)

    def test_words_that_look_like_bits_are_words(self):
        for text, expected in [("0110", "4'b0110"), ("1 ", '"1"'), ("NONE", '"NONE"'), ("0b000", '"0b000"'),
                               ("x ", '"x"')]:
            self.assertEqual(routed.value(text), expected)

    def test_one_bit_of_the_smallest_lut_is_turned(self):
        self.module["cells"]["wide"] = cell("TRELLIS_COMB", parameters={"INITVAL": "0" * 16}, A=4, B=5)
        self.assertEqual(routed.turn_a_bit(self.module), "lut")
        self.assertEqual(self.module["cells"]["lut"]["parameters"]["INITVAL"], "0101010101010100")


class FamilyTest(unittest.TestCase):
    def options(self, *arguments):
        with mock.patch.object(sys, "argv", ["synth", *arguments]), mock.patch("sys.stderr", io.StringIO()):
            return synthesize.arguments()

    def test_a_family_is_its_sections(self):
        self.assertEqual(self.options("--family", "nexus").only, ["nexus"])
        self.assertEqual(self.options("--family", "ecp5", "--only", "filter", "--only", "nexus").only, ["filter"])
        self.assertEqual(self.options().only, list(synthesize.SECTIONS))
        for wrong in [("--family", "none"), ("--family", "nexus", "--only", "filter")]:
            with self.assertRaises(SystemExit):
                self.options(*wrong)

    def test_only_whole_families_at_their_target_are_written(self):
        whole = lambda *arguments: (self.options(*arguments).complete, self.options(*arguments).all_of_family)
        self.assertEqual(whole(), (True, False))
        self.assertEqual(whole("--family", "nexus"), (False, True))
        for part in [("--quick",), ("--only", "nexus"), ("--family", "ecp5", "--target", "100"), ("--family", "ecp5", "--quick")]:
            self.assertEqual(whole(*part), (False, False), part)

    def test_nextpnr_has_one_version_for_all_families(self):
        text = (Path(designs.__file__).parents[1] / "requirements.txt").read_text()
        versions = re.findall(r"^yowasp-nextpnr-(\w+)==(\S+)", text, re.MULTILINE)
        self.assertEqual([family for family, _ in versions], ["ecp5", "nexus"])
        self.assertEqual(len({version for _, version in versions}), 1)


class DocumentTest(unittest.TestCase):
    RESULT = {"figures": FIGURES["element: e"], "cells": 1100, "target": 175.0, "seed": 1, "tried": {"1": 175.0}, "path": None}

    def page(self, results, driven):
        with mock.patch.object(document, "SECTIONS", {"filter": ("Filter", "A note."), "nexus": ("Nexus", "Another.")}):
            return document.page(results, {"yosys": "1"}, {"lut": (0.03, True)}, driven, f"{document.BOARDS['ulx3s']}\n\nboard\n")

    def with_sections(self, page, results, driven, version="1"):
        with mock.patch.object(document, "SECTIONS", {"filter": ("Filter", "A note."), "nexus": ("Nexus", "Another.")}):
            return document.with_sections(page, results, {"yosys": version}, {"lut": (0.03, True)}, driven)

    def test_sections_are_written_in_their_place(self):
        results = {"filter": {"f": self.RESULT}, "nexus": {"n": self.RESULT}}
        driven = {"f_ecp5": "netlist: 3 results", "n_nexus": "netlist: 12 results"}
        page = self.page(results, driven)
        self.assertEqual(self.with_sections(page, {}, {}), page)
        slower = {**results, "nexus": {"n": {**self.RESULT, "target": 176.0}}}
        again = {**driven, "n_nexus": "netlist: 4 results"}
        self.assertEqual(self.with_sections(page, {"nexus": slower["nexus"]}, {"n_nexus": "netlist: 4 results"}),
                         self.page(slower, again))
        without = page.replace(page[page.index("## Filter"):page.index("## Nexus")], "")
        self.assertEqual(self.with_sections(without, {"filter": results["filter"]}, {}), page)

    def test_sections_of_other_versions_are_not_put_together(self):
        page = self.page({"filter": {"f": self.RESULT}, "nexus": {"n": self.RESULT}}, {"f_ecp5": "netlist: 3 results"})
        self.assertIsNone(self.with_sections(page, {"nexus": {"n": self.RESULT}}, {}, "10"))

    def test_a_missed_target_is_written_as_such(self):
        result = {"figures": FIGURES["element: e"], "cells": 1100, "target": 176.0, "seed": 2, "tried": {"1": 170.0, "2": 175.0},
                  "path": {"from": "a", "to": "b", "logic": 1.0, "routing": 2.0, "levels": 3}}
        text = document.tables({"element": {"e": result}})
        self.assertIn("176 missed", text)
        self.assertIn("Seeds tried for e: 1: 170.0 MHz, 2: 175.0 MHz.", text)
        self.assertIn("175 met", document.tables({"element": {"e": {**result, "target": 175.0}}}))

    def test_the_boards_sections_are_the_pages_last_and_stand_once(self):
        board = {"driven": {"synthesized": "fuzz: 3 answers right", "routed": "fuzz: 4 answers right"},
                 "figures": {"lut": 41820, "fmax": 121.0}, "path": None, "elements": 2,
                 "utilisation": {"cells": [40000, 83640], "FF": [10, 83640], "DSP": [100, 156], "RAM": [50, 208]},
                 "target": 120.0, "seed": 3, "promised": {"1": (80.0, 400000), "3": (90.0, 390000), "4": (70.0, 410000)},
                 "tried": {"3": 121.0, "1": None}, "top": "emax_ulx3s"}
        section = document.board_section("ulx3s", board, {"yosys": "1"})
        self.assertIn("Clock: 121.0 MHz, target 120 MHz met, seed 3.", section)
        for row in [r"\| 1 +\| 80.0 +\| 400,000 +\| not routed +\|", r"\| 3 +\| 90.0 +\| 390,000 +\| 121.0 +\|",
                    r"\| 4 +\| 70.0 +\| 410,000 +\| not tried +\|"]:
            self.assertRegex(section, row)
        # By hand: 0.298 W, then per MHz 677 uA for the clock, 11.8 or 162 nA for a cell and 19.8 uA for a block,
        # all 0.902 times, at 1.1 V and 120 MHz.
        self.assertIn(": 0.4 W idle, at most 1.5 W at work.", section)
        idle, busy = power.estimated(board["utilisation"], 120)
        self.assertAlmostEqual(idle, 0.2982 + 0.1191 * (0.677 + 40000 * 11.82e-6), places=3)
        self.assertAlmostEqual(busy, 0.2982 + 0.1191 * (0.677 + 40000 * 162.5e-6 + 150 * 19.75e-3), places=3)
        self.assertIn("as synthesized, fuzz: 3 answers right; as routed, fuzz: 4 answers right.", section)
        self.assertRegex(section, r"\| LUT +\| 41,820 \| 83,640 \| 50% +\|")
        self.assertIn("missed", document.board_section("ulx3s", {**board, "target": 122.0}, {}))
        other = document.board_section("ulx3s-sdram", board, {"yosys": "1"})
        page = "# Synthesis\n\ntext\n"
        for sections in ([section, other], [other, section]):
            both = page
            for each in sections:
                both = document.with_boards(both, each)
            self.assertEqual(both, f"{page}\n{section}\n{other}")
        self.assertEqual((document.board_of(both, "ulx3s"), document.board_of(both, "ulx3s-sdram")), (section, other))
        self.assertEqual(document.with_boards(page, document.boards_of(both)), both)
        self.assertEqual(document.with_boards(both, section), both)
        changed = document.board_section("ulx3s", {**board, "seed": 7}, {"yosys": "1"})
        self.assertEqual(document.with_boards(both, changed), both.replace(section, changed))
        self.assertEqual((document.board_of(page, "ulx3s"), document.boards_of(page), document.with_boards(page, "")), ("", "", page))

    def test_the_figures_of_boards_are_read_as_written(self):
        result = {"driven": {}, "figures": {"lut": 41820, "fmax": 91.5}, "path": None, "elements": 2, "top": "emax_ulx3s",
                  "utilisation": {"cells": [40000, 83640], "FF": [10, 83640], "DSP": [100, 156], "RAM": [50, 208]},
                  "target": 90.0, "seed": 3, "promised": {"3": (90.0, 390000)}, "tried": {"3": 91.5}}
        versions = {"yosys": "1.2", "nextpnr": "3.4"}
        section = document.board_section("ulx3s", result, versions)
        page = document.with_boards(document.with_boards("# Synthesis\n\n## Filter\n\ntext\n", section),
                                    document.board_section("ulx3s-sdram", {**result, "target": 95.5, "elements": 1}, {}))
        found = document.bitstreams(page)
        self.assertEqual(list(found), ["ulx3s", "ulx3s-sdram"])
        board, other = found.values()
        self.assertEqual((board.tools, board.elements, board.clocks), (document.tools_text(versions), 2, (91.5, 90.0)))
        self.assertEqual(board.used, {"LUT": 41820, "FF": 10, "DSP": 100, "RAM": 50})
        self.assertRegex(board.power, r"^0\.\d W idle, at most 1\.\d W at work$")
        self.assertEqual((other.elements, other.clocks), (1, (91.5, 95.5)))
        self.assertEqual(document.bitstreams("# Synthesis\n"), {})

        # Each figure damaged: that one is missed, by name, and the others are still read.
        reads = {"tools": lambda b: b.tools, "elements": lambda b: b.elements, "clock": lambda b: b.clocks,
                 "power": lambda b: b.power, "DSP": lambda b: b.used}
        for what, (text, wrong) in {"tools": (" Tools: ", " Made by "), "elements": ("(elements: 2)", "(elements: two)"),
                                    "clock": ("91.5 MHz, target", "fast, target"), "power": (" W idle", " mW idle"),
                                    "DSP": ("| DSP  ", "| MUL  ")}.items():
            self.assertIn(text, section)
            (damaged,) = document.bitstreams(section.replace(text, wrong)).values()
            for name, read in reads.items():
                if name != what:
                    read(damaged)
                    continue
                with self.assertRaisesRegex(tools.Failure, f"ulx3s does not say its {what}; ./dev bitstream ulx3s"):
                    read(damaged)
        nameless = page.replace("Written by `./dev bitstream ulx3s`", "Written")
        for read in (document.bitstreams, document.boards_of):
            with self.assertRaisesRegex(tools.Failure, "does not say which board"):
                read(nameless)


if __name__ == "__main__":
    unittest.main()
