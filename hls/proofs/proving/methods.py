"""The methods of proof. Each gives an Outcome: a counterexample, or none and what was shown to occur.

A proof that could not fail is a failure: a proof without a property, with assumptions that contradict each other,
with an assertion that no state violates, or with a case that is never reached.
"""

from dataclasses import dataclass, field

from bitwuzla import Kind

from synthesis.tools import Failure

from . import floats, graph, record, split
from .btor import apply, initial
from .solve import Solver, trace_of
from .unroll import Terms, Unrolling


@dataclass
class Outcome:
    trace: object = None  # a counterexample
    violated: str = ""
    text: str = ""  # the counterexample in words
    covered: list = field(default_factory=list)  # what was shown to occur
    properties: int = 0


class Function:
    """An unknown function in place of a module. Equal operands give equal results, and `facts` holds for each result."""

    def __init__(self, terms, name, operands, width, facts=None):
        self.terms, self.facts, self.operands = terms, facts, operands
        sorts = [terms.sort(operand) for operand in operands]
        self.function = terms.tm.mk_const(terms.tm.mk_fun_sort(sorts, terms.sort(width)), name)
        self.known = []

    def apply(self, *operands):
        result = self.terms.op(Kind.APPLY, self.function, *operands)
        if self.facts is not None:
            self.known.append(self.facts(result, *operands))
        return result


class Product(Function):
    """The true product of two words, for counterexamples."""

    def apply(self, *operands):
        size = sum(operand.sort().bv_size() for operand in operands)
        wide = [self.terms.op(Kind.BV_ZERO_EXTEND, word, indices=[size - word.sort().bv_size()]) for word in operands]
        return self.terms.op(Kind.BV_MUL, *wide)


class Instance:
    """For Unrolling.replaced: the function of an instance's operands in the same step."""

    def __init__(self, function, operands):
        self.function, self.operands = function, operands

    def needs(self, step):
        return [(operand, step) for operand in self.operands]

    def make(self, operands):
        return self.function.apply(*operands)


def covers_of(system):
    return sorted(name for name in system.names if name.split(".")[-1].startswith("cover_"))


def constraints_at(unrolling, step):
    return [unrolling.terms.true(unrolling.term(number, step)) for number in unrolling.system.constraints]


def bad_at(unrolling, step):
    return {name: unrolling.terms.true(unrolling.term(number, step)) for name, number in unrolling.system.bad}


def first_violation(system, depth, limit):
    """From the initial state through the steps 0 to `depth`: the first violated assertion, or None."""
    terms = Terms()
    unrolling, solver = Unrolling(system, terms, True), Solver(terms, limit)
    for step in range(depth + 1):
        solver.assume(*constraints_at(unrolling, step))
        bad = bad_at(unrolling, step)
        if solver.possible(terms.either(*bad.values())):
            violated = next(name for name, term in bad.items() if solver.possible(term))
            return _refuted(solver, unrolling, step, violated)
    if not solver.possible():
        raise Failure(f"the assumptions contradict each other within {depth} steps")
    return None


def reached(system, covers, reach, limit):
    """Each cover with the first step, at most `reach`, in which it occurs. One that never does is a failure."""
    terms = Terms()
    unrolling, solver = Unrolling(system, terms, True), Solver(terms, limit)
    missing, found = list(covers), []
    for step in range(reach + 1):
        solver.assume(*constraints_at(unrolling, step))
        for name in list(missing):
            if solver.possible(terms.true(unrolling.named(name, step))):
                missing.remove(name)
                found.append(f"{name.split('.')[-1].removeprefix('cover_')} ({step})")
        if not missing:
            return found
    raise Failure(f"never reached within {reach} steps: {', '.join(missing)}")


def _refuted(solver, unrolling, step, violated):
    trace = trace_of(solver, unrolling, step + 1)
    last = trace.values[-1]
    if not any(last[number] for name, number in unrolling.system.bad if name == violated):
        raise Failure(f"the counterexample of '{violated}' does not replay")
    if not all(values[number] for values in trace.values for number in unrolling.system.constraints):
        raise Failure(f"the counterexample of '{violated}' breaks an assumption when it is replayed")
    return Outcome(trace, violated, f"'{violated}' is violated in step {step}\n\n{trace.table()}")


def _check_properties(system):
    if not system.bad:
        raise Failure("the proof has no property")
    covers = covers_of(system)
    if not covers:
        raise Failure("the proof has no cover: nothing shows that its assumptions leave anything to happen")
    return covers


def bounded(proof, system, refute=False):
    """Proves all assertions in every run of `depth` steps."""
    covers = _check_properties(system)
    found = first_violation(system, (proof.reach or proof.depth) if refute else proof.depth, proof.limit)
    if refute or found is not None:
        return found or Outcome()
    return Outcome(covered=reached(system, covers, proof.depth, proof.limit), properties=len(system.bad))


def induction(proof, system, refute=False):
    """Proves all assertions in every run of any length: they hold in the first steps, and they hold after any `depth`
    steps, from any state, in which they hold."""
    covers = _check_properties(system)
    found = first_violation(system, max(proof.depth, proof.reach) if refute else proof.depth, proof.limit)
    if refute or found is not None:
        return found or Outcome()
    terms = Terms()
    unrolling, solver = Unrolling(system, terms, False), Solver(terms, proof.limit)
    for name, term in bad_at(unrolling, 0).items():
        if not solver.possible(term):
            raise Failure(f"the assertion '{name}' holds in every state there is: it says nothing")
    for step in range(proof.depth + 1):
        solver.assume(*constraints_at(unrolling, step))
    for step in range(proof.depth):
        solver.assume(*(terms.negated(term) for term in bad_at(unrolling, step).values()))
    if not solver.possible():
        raise Failure("the hypothesis of the induction contradicts itself")
    bad = bad_at(unrolling, proof.depth)
    if solver.possible(terms.either(*bad.values())):
        violated = next(name for name, term in bad.items() if solver.possible(term))
        outcome = _refuted(solver, unrolling, proof.depth, violated)
        outcome.text = "not inductive: the first step need not be reachable; " + outcome.text
        return outcome
    return Outcome(covered=reached(system, covers, proof.reach, proof.limit), properties=len(system.bad))


def pipeline(proof, system, refute):
    """The inputs of a pipeline in step 0 and its output `depth` edges later, from any state of its registers. A
    property of these holds in every step after `depth` edges, whatever was in the pipeline before."""
    terms, rule, facts = Terms(), proof.rule, []
    rules = floats.Rules(terms, rule.exponent, rule.mantissa)
    replaced, functions = {}, {}
    for instance, name, operands in rule.functions:
        numbers = [system.named(f"{instance}.{operand}") for operand in operands]
        result = system.named(f"{instance}.result")
        if system.nodes[result].kind not in ("state", "input") or result in system.next:
            raise Failure(f"{instance}.result is not free: its module was not left out")
        if name not in functions:
            functions[name] = (Product if refute else Function)(terms, name, [system.nodes[number].sort for number in numbers],
                                       system.nodes[result].sort, rules.facts(name))
        replaced[result] = Instance(functions[name], numbers)
    unrolling = Unrolling(system, terms, False, replaced)
    inputs = [unrolling.named(name, 0) for name in rule.inputs]
    output = unrolling.named(rule.output, proof.depth)
    right, cases = rules.rule(rule.name, inputs, output, functions)
    solver = Solver(terms, proof.limit)
    solver.assume(*counted(system, unrolling))
    for function in functions.values():
        facts += function.known
    solver.assume(*facts)
    return terms, unrolling, solver, inputs, output, right, cases


def counters(system):
    """{state: the values it takes} for states that depend on nothing but themselves and start with a number."""
    found = {}
    for state in system.states:
        if state not in system.init or state not in system.next or isinstance(system.nodes[state].sort, tuple):
            continue
        cone, waiting = set(), [system.next[state]]
        while waiting:
            number = waiting.pop()
            if number not in cone:
                cone.add(number)
                waiting += system.nodes[number].operands
        if any(system.nodes[number].kind in ("input", "state") and number != state for number in cone):
            continue
        values, value = [], initial(system, state)
        while value not in values:
            values.append(value)
            known = {state: value}
            for number in sorted(cone - {state}):
                node = system.nodes[number]
                known[number] = node.value if node.kind == "const" else apply(
                    node, [known[i] for i in node.operands], [system.nodes[i].sort for i in node.operands])
            value = known[system.next[state]]
        found[state] = values
    return found


def counted(system, unrolling):
    """The condition that each counter that the terms read starts with a value that it can have."""
    terms = unrolling.terms
    return [terms.either(*(terms.eq(unrolling.term(state, 0), terms.bv(system.nodes[state].sort, value)) for value in values))
            for state, values in counters(system).items() if (state, 0) in unrolling.cache]


def delays(proof, system, refute=False):
    """Proves the lines that `rule` names, of those of 1 to `depth` edges side by side: in any step each gives the word
    that went in as many steps before. Counters start with any value that they can have, all else with any value."""
    width = system.width("d")
    if not proof.rule:
        raise Failure("the proof looks at no line")
    for depth in proof.rule:
        terms = Terms()
        unrolling, solver = Unrolling(system, terms, False), Solver(terms, proof.limit)
        entering = unrolling.named("d", 0)
        leaving = terms.slice(unrolling.named("q", depth), width * depth - 1, width * (depth - 1))
        solver.assume(*counted(system, unrolling))
        for number in range(1 << width):
            if not solver.possible(terms.eq(leaving, terms.bv(width, number))):
                raise Failure(f"a line of {depth} edges never gives {number}")
        if solver.possible(terms.negated(terms.eq(entering, leaving))):
            trace, want = trace_of(solver, unrolling, depth + 1), solver.number(entering)
            got = trace.value("q", depth) >> width * (depth - 1) & (1 << width) - 1
            if got == want:
                raise Failure("the counterexample does not replay")
            return Outcome(trace, f"depth {depth}", f"a line of {depth} edges gives {got:x} for {want:x}\n")
    return Outcome(covered=[f"{len(proof.rule)} lines"], properties=len(proof.rule))


def expected(proof, values):
    """The result that the rule demands for the operands of a counterexample, as text."""
    terms, rule = Terms(), proof.rule
    rules = floats.Rules(terms, rule.exponent, rule.mantissa)
    bits = rule.mantissa + 1
    functions = {name: Product(terms, name, [bits, bits], 2 * bits) for _, name, _ in rule.functions}
    _, width = values[rule.output]
    inputs = [terms.bv(values[name][1], values[name][0]) for name in rule.inputs]
    output, solver = terms.const(width, "expected"), Solver(terms, proof.limit)
    right, _ = rules.rule(rule.name, inputs, output, functions)
    if not solver.possible(right):
        raise Failure("the rule allows no result for the operands of the counterexample")
    want = solver.number(output)
    if want == values[rule.output][0]:
        raise Failure("the rule allows the result of the counterexample")
    return f" for {want:0{(width + 3) // 4}x}{floats.readable(want, rule, width)}"


def words(proof, system, refute=False):
    terms, unrolling, solver, inputs, output, right, cases = pipeline(proof, system, refute)
    if solver.possible(terms.negated(right)):
        values = {name: (solver.number(term), term.sort().bv_size()) for name, term in
                  [*zip(proof.rule.inputs, inputs), (proof.rule.output, output)]}
        named = [name for name, case in cases.items() if solver.number(terms.bit(case))]
        trace = trace_of(solver, unrolling, proof.depth + 1)
        if trace.value(proof.rule.output, proof.depth) != values[proof.rule.output][0]:
            raise Failure("the counterexample does not replay")
        shown = {name: f"{value:0{(width + 3) // 4}x}{floats.readable(value, proof.rule, width)}"
                 for name, (value, width) in values.items()}
        given = ", ".join(f"{name} {shown[name]}" for name in proof.rule.inputs)
        want = expected(proof, values) if refute else ""
        text = f"{given}: {shown[proof.rule.output]}{want}; by the rule {', '.join(named) or 'an ordinary result'}\n"
        return Outcome(trace, proof.rule.name, text)
    covered = []
    for name, case in cases.items():
        if name in proof.rule.without:
            if solver.possible(case):
                raise Failure(f"the case '{name}' occurs, which the table rules out")
        elif not solver.possible(case):
            raise Failure(f"the case '{name}' never occurs: the rule proves nothing of it")
        else:
            covered.append(name)
    if not cases:
        raise Failure("the rule has no case that could be shown to occur")
    return Outcome(covered=covered, properties=1)


METHODS = {"words": words, "induction": induction, "bounded": bounded, "graph": graph.graph, "split": split.split,
           "delays": delays, "record": record.record}
DESCRIPTIONS = {
    "words": "all words", "induction": "induction", "bounded": "bounded check", "graph": "congruence", "split": "partial products",
    "delays": "all words", "record": "all records"}


def depth(proof):
    """The depth of a proof, as text."""
    if proof.method == "induction":
        return f"any number of cycles ({proof.depth} in the induction)"
    if proof.method == "bounded":
        return f"{proof.depth} cycles"
    if proof.method == "delays":
        return f"{', '.join(map(str, proof.rule))} edges, any cycle"
    return f"{proof.depth} edges, any cycle"
