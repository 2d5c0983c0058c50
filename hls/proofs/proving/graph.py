"""Compares a generated datapath with the dataflow graph of its source, the kernel's or a function of one's own. The operators are unknown functions of their
operands, the same on both sides. The proof therefore shows which values meet, and when."""

import json
import re
import subprocess
from pathlib import Path

from bitwuzla import Kind

from synthesis.tools import Failure

from . import floats
from .solve import Solver, trace_of
from .unroll import Terms, Unrolling

lower_program = Path("build/kernel/bin/emax_lower")
# Of binary numbers, by the end of an instance's name: its function, and its operands in the harness.
MODULES = {"adder": ("add", ("addend", "a")), "multiplier": ("multiply", ("a", "b")), "squarer": ("square", ("a",)),
           "comparator": ("less", ("a", "b")), "divider": ("divide", ("a", "b")), "root_taker": ("square_root", ("a",))}
OPERATIONS = {"subtract", *(function for function, _ in MODULES.values())}
# Of fixed-point numbers, by the end of an instance's name: its module, and its operands in the harness. The last
# operand is the module's parameters: SHIFT, HALF_UP, SATURATE, and SUBTRACT or MAGNITUDE.
FIXED_MODULES = {"adder": ("fixed_add", ("a", "b", "options")), "multiplier": ("fixed_multiply", ("a", "b", "options")),
                 "fitter": ("fixed_fit", ("a", "options")), "negator": ("fixed_negate", ("a", "options")),
                 "comparator": ("fixed_less", ("a", "b", "options"))}
# The graph's name of an operation: its module, and whether it is the other one of the two that the module has.
FIXED_OPERATIONS = {"fixed_add": ("fixed_add", 0), "fixed_subtract": ("fixed_add", 1), "fixed_multiply": ("fixed_multiply", 0),
                    "fixed_fit": ("fixed_fit", 0), "fixed_negate": ("fixed_negate", 0), "fixed_magnitude": ("fixed_negate", 1),
                    "fixed_less": ("fixed_less", 0)}


class FixedFunctions(dict):
    """The unknown functions of operators on fixed-point numbers: one for each module and its widths."""

    def __init__(self, terms, make):
        super().__init__()
        self.terms, self.make = terms, make

    def of(self, module, operands, width):
        key = (module, *operands, width)
        if key not in self:
            self[key] = self.make(self.terms, "_".join(map(str, key)), list(operands), width)
        return self[key]

    def apply(self, node, operands, nodes):
        """The result of a node of the graph, with the parameters that the formats demand."""
        t, (module, variant) = self.terms, FIXED_OPERATIONS[node["operation"]]
        fits = module in ("fixed_multiply", "fixed_fit")
        shift = sum(n["fraction"] for n in nodes) - node["fraction"] if fits else 0
        half_up = fits and node["half_up"]
        saturate = module != "fixed_less" and node["saturate"]
        options = t.bv(16, (shift & 255) << 8 | half_up << 2 | saturate << 1 | variant)
        widths = [n["width"] for n in nodes]
        return self.of(module, (*widths, 16), node["width"]).apply(*operands, options)


def read_graph(rule):
    """The graph of a form of the distance, from the kernel's source through emax_lower, or that of a file."""
    if rule.file:
        return json.loads(Path(rule.file).read_text())
    lower = lower_program
    if not lower.exists():
        raise Failure(f"{lower} is not there: ./dev build kernel emax_lower makes it")
    result = subprocess.run([lower, rule.name, "--graph"], capture_output=True, text=True)
    if result.returncode != 0:
        raise Failure(f"{lower} failed: {result.stderr.strip()}")
    return json.loads(result.stdout)


class Meaning:
    """The term of a graph's node, given the terms of its operands."""

    def __init__(self, terms, rules, functions, fixed):
        self.t, self.rules, self.functions, self.fixed = terms, rules, functions, fixed

    def node(self, node, operands, nodes):
        t, rules, name = self.t, self.rules, node["operation"]
        if name in FIXED_OPERATIONS:
            return self.fixed.apply(node, operands, nodes)
        if name == "fixed_negative":
            return t.slice(operands[0], nodes[0]["width"] - 1, nodes[0]["width"] - 1)
        if name in ("add", "subtract"):
            a, b = operands
            if name == "subtract":
                b = t.concat(t.op(Kind.BV_NOT, rules.sign(b)), t.slice(b, rules.width - 2, 0))
            return self.functions["add"].apply(b, a)
        if name in self.functions:
            return self.functions[name].apply(*operands)
        if name == "fixed_wires":
            return self.wires(node, operands[0], nodes[0])
        if name == "magnitude":
            return t.concat(t.bv(1, 0), t.slice(operands[0], rules.width - 2, 0))
        if name == "negate":
            return t.concat(t.op(Kind.BV_NOT, rules.sign(operands[0])), t.slice(operands[0], rules.width - 2, 0))
        if name == "is_number":
            return t.bit(t.negated(t.op(Kind.FP_IS_NAN, rules.number(operands[0]))))
        if name in ("less_zero", "greater_zero"):
            value, zero = rules.value(operands[0]), rules.number(t.bv(rules.width, 0))
            order = (value, zero) if name == "less_zero" else (zero, value)
            return t.bit(t.op(Kind.FP_LT, *order))
        if name == "select":
            return t.ite(t.true(operands[0]), operands[1], operands[2])
        kinds = {"both": Kind.BV_AND, "either": Kind.BV_OR, "negated": Kind.BV_NOT}
        if name not in kinds:
            raise Failure(f"the graph has an operation '{name}' that the proof does not know")
        return t.op(kinds[name], *operands)

    def wires(self, node, word, of):
        """A fixed-point number in another format: bits behind the point left out or added, then bits before it."""
        t, cut = self.t, of["fraction"] - node["fraction"]
        word = t.slice(word, of["width"] - 1, cut) if cut > 0 else t.concat(word, t.bv(-cut, 0)) if cut < 0 else word
        more = node["width"] - (of["width"] - cut)
        return t.op(Kind.BV_SIGN_EXTEND, word, indices=[more]) if more > 0 else t.slice(word, node["width"] - 1, 0)


def instances(system, functions, fixed):
    """{result of an operator that is left out: its function and operands}. Instances are told by the ends of their
    names; a number may follow."""
    from .methods import Instance
    replaced = {}
    for signal in system.names:
        instance, _, leaf = signal.rpartition(".")
        if leaf != "result" or "." in instance:
            continue
        end = next((end for end in (*MODULES, *FIXED_MODULES) if re.search(rf"_{end}(_\d+)?$", instance)), None)
        is_fixed = f"{instance}.options" in system.names
        if end not in (FIXED_MODULES if is_fixed else MODULES):
            raise Failure(f"{instance} is an operator that the proof does not know")
        name, operands = (FIXED_MODULES if is_fixed else MODULES)[end]
        of = functions[name] if not is_fixed else fixed.of(
            name, [system.width(f"{instance}.{operand}") for operand in operands], system.width(signal))
        replaced[system.named(signal)] = Instance(of, [system.named(f"{instance}.{operand}") for operand in operands])
    return replaced


def format_of(design):
    """The bits of exponent and mantissa of a design's binary numbers: one format for all."""
    return next(((node["exponent"], node["mantissa"]) for node in design["nodes"] if "exponent" in node), (8, 23))


def graph(proof, system, refute=False):
    from .methods import Function, Outcome
    terms = Terms()
    design = read_graph(proof.rule)
    rules = floats.Rules(terms, *format_of(design))
    functions = {
        name: Function(terms, name, [rules.width] * len(operands), 1 if name == "less" else rules.width,
                       None if name == "less" else lambda result, *_: rules.canonical(result))
        for name, operands in MODULES.values()}
    fixed = FixedFunctions(terms, Function)
    replaced = instances(system, functions, fixed)
    operations = sum(node["operation"] in (*OPERATIONS, *FIXED_OPERATIONS) for node in design["nodes"])
    if len(replaced) != operations or (operations == 0 and not proof.rule.file):
        raise Failure(f"the datapath has {len(replaced)} operators and the graph {operations}")

    unrolling, values = Unrolling(system, terms, False, replaced), []
    meaning = Meaning(terms, rules, functions, fixed)
    for node in design["nodes"]:
        if node["operation"] == "input":
            values.append(unrolling.named(node["name"], node["start"]))
        elif node["operation"] == "constant":
            values.append(terms.bv(node["width"], node["word"]))
        else:
            values.append(meaning.node(node, [values[i] for i in node["operands"]],
                                       [design["nodes"][i] for i in node["operands"]]))
    solver = Solver(terms, proof.limit)
    named, wrong = [], []
    for output in design["outputs"]:
        got = unrolling.named(output["name"], design["latency"])
        wrong.append(terms.negated(terms.eq(got, values[output["node"]])))
    if proof.depth != design["latency"]:
        raise Failure(f"the datapath's latency is {design['latency']}, the table's {proof.depth}")
    for function in (*functions.values(), *fixed.values()):
        solver.assume(*function.known)
    if not wrong:
        raise Failure("the graph has no output")
    if not solver.possible():
        raise Failure("what is assumed of the operators contradicts itself")
    if solver.possible(terms.either(*wrong)):
        trace = trace_of(solver, unrolling, design["latency"] + 1)
        # The first named value that differs. The operators do what the solver chose, the same on both sides.
        text = ""
        for node, value in zip(design["nodes"], values):
            if node["operation"] in ("input", "constant") or node["name"] not in system.names:
                continue
            want, got = solver.number(value), trace.value(node["name"], node["ready"])
            if want != got:
                text = (f"{node['name']} ({node['operation']}, cycle {node['ready']}): {got:08x} for {want:08x}, "
                        "for operators chosen by the solver\n")
                break
        if not text:
            raise Failure("the counterexample does not replay")
        return Outcome(trace, "the outputs", text)
    # Each choice of the kernel has to go both ways; otherwise a wrong branch would not be seen. A function of one's own
    # may have one that never changes.
    never = []
    for node, value in zip(design["nodes"], values):
        if node["width"] == 1:
            for bit in (0, 1):
                if not solver.possible(terms.eq(value, terms.bv(1, bit))):
                    never.append(f"the condition {node['name']} is never {bit}")
            named.append(node["name"])
    if never and not proof.rule.file:
        raise Failure(f"{never[0]}: the proof says nothing of it")
    return Outcome(covered=[f"{len(named)} conditions" + ("" if never else ", each both ways"), *never],
                   properties=len(wrong))
