"""The solver, which has to answer, and the traces of its models."""

import time

from bitwuzla import Bitwuzla, Option, Options, Result

from synthesis.tools import Failure

from .waveform import Trace


class Solver:
    """Permanent assumptions, and questions about them. An answer that is neither yes nor no is a failure."""

    def __init__(self, terms, limit):
        options = Options()
        options.set(Option.PRODUCE_MODELS, True)
        self.terms = terms
        self.limit = limit
        self.end = time.monotonic() + limit
        self.solver = Bitwuzla(terms.tm, options)
        self.solver.configure_terminator(lambda: time.monotonic() > self.end)

    def assume(self, *conditions):
        for condition in conditions:
            self.solver.assert_formula(condition)

    def possible(self, *conditions):
        """Whether all conditions can hold together with the assumptions."""
        result = self.solver.check_sat(*conditions)
        if result not in (Result.SAT, Result.UNSAT):
            late = f" within {self.limit:g} s" if time.monotonic() > self.end else ""
            raise Failure(f"the solver gave no answer{late}")
        return result == Result.SAT

    def number(self, term):
        """The value of a term in the model of the last answer: a number, or a dictionary of a memory's words."""
        if term.sort().is_array():
            return None
        value = self.solver.get_value(term)
        return int(value.value(2), 2)

    def memory(self, term, addresses):
        from bitwuzla import Kind
        words = {}
        for address in range(1 << addresses):
            place = self.terms.bv(addresses, address)
            words[address] = self.number(self.terms.op(Kind.ARRAY_SELECT, term, place))
        return words


def trace_of(solver, unrolling, steps):
    """Runs the netlist on the numbers of the solver's model. Values that the model leaves open are 0."""
    system = unrolling.system

    def free(step, number):
        term = unrolling.cache.get((number, step))
        sort = system.nodes[number].sort
        if isinstance(sort, tuple):
            return solver.memory(term, sort[0]) if term is not None and sort[0] <= 12 else {}
        return solver.number(term) if term is not None else 0

    def state(number):
        from .btor import initial
        if unrolling.initial and number in system.init:
            return initial(system, number)
        return free(0, number)

    if not unrolling.initial:  # an initial value counts from a reset on alone
        system = _without_initial_values(system)
    return Trace(system, steps, free, state)


def _without_initial_values(system):
    import copy
    system = copy.copy(system)
    system.init = {}
    return system
