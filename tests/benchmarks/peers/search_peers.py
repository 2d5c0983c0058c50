"""Runs pagmo, NLopt and COBYQA on the search's test functions; prints one JSON line for each run.

The functions come from a library with C linkage, those on scans from the program that also runs the
search, so every optimizer minimises the very same ones.
Every call is charged. A peer's point counts as feasible where every inequality holds within 1e-8
and every equality within 1e-4; linear constraints are inequalities like the others. Where a problem
gives a start point, every peer starts from it.
"""

import argparse
import ctypes
import itertools
import json
import math
import subprocess
import sys
from importlib.metadata import version

import cobyqa
import nlopt
import numpy
import pygmo
import scipy.optimize

EQUALITY, INEQUALITY = 1e-4, 1e-8


class Spent(Exception):
    pass


class Library:
    """A test function of the library."""

    def __init__(self, library, name):
        self.library = ctypes.CDLL(library)
        self.library.emax_optimum.restype = ctypes.c_double
        self.index = self.library.emax_problem(name.encode())
        sizes = (ctypes.c_int * 3)()
        self.library.emax_sizes(self.index, sizes)
        genes, self.inequalities, self.equalities = sizes
        table = (ctypes.c_double * (4 * genes))()
        self.library.emax_genes(self.index, table)
        self.genes = numpy.array(table).reshape(-1, 4)
        self.optimum = self.library.emax_optimum(self.index)

    def values(self, x):
        values = numpy.empty(1 + self.inequalities + self.equalities)
        pointer = ctypes.POINTER(ctypes.c_double)
        self.library.emax_evaluate(self.index, x.ctypes.data_as(pointer), values.ctypes.data_as(pointer))
        return values


class Served:
    """A problem that a program evaluates, line by line."""

    def __init__(self, program, name):
        self.process = subprocess.Popen([program, "--serve", "--problems", name], stdin=subprocess.PIPE,
                                        stdout=subprocess.PIPE, text=True)
        told = self.answer()
        self.inequalities, self.equalities, self.optimum = told["inequalities"], told["equalities"], told["optimum"]
        self.genes = numpy.array(told["genes"], dtype=float)  # null becomes NaN

    def answer(self):
        line = self.process.stdout.readline()
        if not line:
            sys.exit("the program that evaluates has ended")
        return json.loads(line)

    def values(self, x):
        self.process.stdin.write(json.dumps(x.tolist()) + "\n")
        self.process.stdin.flush()
        return numpy.array(self.answer(), dtype=float)


class Problem:
    """One run: counts calls and keeps the best feasible objective."""

    def __init__(self, source, budget):
        self.source, self.budget = source, budget
        self.inequalities, self.equalities = source.inequalities, source.equalities
        self.lower, self.upper, self.whole, self.start = source.genes.T
        self.genes = len(self.lower)
        self.has_start = not math.isnan(self.start[0])
        self.width = 1 + self.inequalities + self.equalities
        self.calls, self.best = 0, math.inf

    def __call__(self, x):
        if self.calls >= self.budget:
            raise Spent
        self.calls += 1
        x = numpy.ascontiguousarray(numpy.clip(x, self.lower, self.upper))
        x = numpy.where(self.whole > 0, numpy.round(x), x)
        values = self.source.values(x)
        values = numpy.where(numpy.isfinite(values), values, 1e30)
        equal = values[1:1 + self.equalities]
        if (abs(equal) <= EQUALITY).all() and (values[1 + self.equalities:] <= INEQUALITY).all():
            self.best = min(self.best, values[0])
        return values


class Pagmo:
    """What pagmo calls. It copies its problem, so the counting stands outside, and an exception of
    the problem would end the process of some algorithms: past the budget the calls are empty."""

    current = None

    def fitness(self, x):
        try:
            return Pagmo.current(x)
        except Spent:
            return numpy.full(Pagmo.current.width, 1e30)

    def order(self):
        whole = Pagmo.current.whole > 0
        return numpy.concatenate([numpy.flatnonzero(~whole), numpy.flatnonzero(whole)])

    def get_bounds(self):
        return Pagmo.current.lower, Pagmo.current.upper

    def get_nec(self):
        return Pagmo.current.equalities

    def get_nic(self):
        return Pagmo.current.inequalities


def population(problem, size, seed):
    Pagmo.current = problem
    wrapped = pygmo.problem(Pagmo())
    wrapped.c_tol = [EQUALITY] * problem.equalities + [0.0] * problem.inequalities
    found = pygmo.population(wrapped, max(size - problem.has_start, 0), seed=seed)
    if problem.has_start:
        found.push_back(problem.start)
    return found


def gaco(problem, seed):
    size = 20 if problem.budget <= 1000 else 63
    evolve = pygmo.gaco(gen=max(1, problem.budget // size - 1), ker=min(size, 63), seed=seed)
    pygmo.algorithm(evolve).evolve(population(problem, size, seed))


def self_adaptive(problem, seed):
    size = 10 if problem.budget <= 200 else 20
    inner = pygmo.sade(gen=5, seed=seed)
    outer = pygmo.cstrs_self_adaptive(iters=max(1, problem.budget // (5 * size)), algo=inner, seed=seed)
    found = population(problem, size, seed)
    while problem.calls < problem.budget:
        before = problem.calls
        found = pygmo.algorithm(outer).evolve(found)
        if problem.calls == before:
            break


def with_nlopt(problem, algorithm, x, most=None):
    optimizer = nlopt.opt(algorithm, problem.genes)
    optimizer.set_lower_bounds(problem.lower)
    optimizer.set_upper_bounds(problem.upper)
    cache = {}

    def values(point):
        key = point.tobytes()
        if key not in cache:
            cache.clear()
            cache[key] = problem(point.copy())
        return cache[key]

    differences = {}

    def slopes(point):
        """Forward differences, backward at the upper bound; each is an evaluation."""
        key = point.tobytes()
        if key not in differences:
            differences.clear()
            here, columns = values(point), []
            for k, width in enumerate(problem.upper - problem.lower):
                step = 1e-7 * width
                step = -step if point[k] + step > problem.upper[k] else step
                beside = point.copy()
                beside[k] += step
                columns.append((problem(beside) - here) / step)
            cache[key] = here
            differences[key] = numpy.array(columns).T
        return differences[key]

    def fill(result, part):
        result[:] = part

    def constrained(rows):
        def constraint(result, point, gradient):
            if gradient.size:
                gradient[:] = slopes(point)[rows]
            fill(result, values(point)[rows])
        return constraint

    def objective(point, gradient):
        if gradient.size:
            gradient[:] = slopes(point)[0]
        return float(values(point)[0])

    optimizer.set_min_objective(objective)
    first = 1 + problem.equalities
    if problem.equalities:
        optimizer.add_equality_mconstraint(constrained(slice(1, first)), [EQUALITY] * problem.equalities)
    if problem.inequalities:
        optimizer.add_inequality_mconstraint(constrained(slice(first, None)), [INEQUALITY] * problem.inequalities)
    optimizer.set_xtol_rel(1e-10)
    left = problem.budget - problem.calls + 1
    optimizer.set_maxeval(left if most is None else min(most, left))
    optimizer.optimize(x)


def isres(problem, seed):
    nlopt.srand(seed)
    random = numpy.random.default_rng(seed)
    x = problem.start if problem.has_start else random.uniform(problem.lower, problem.upper)
    with_nlopt(problem, nlopt.GN_ISRES, x)


def from_random_points(search):
    """The local search with restarts from random points until the budget is spent."""
    def run(problem, seed):
        random = numpy.random.default_rng(seed)
        x = problem.start if problem.has_start else random.uniform(problem.lower, problem.upper)
        while problem.calls < problem.budget:
            try:
                search(problem, x)
            except (nlopt.RoundoffLimited, RuntimeError, ValueError):
                pass
            x = random.uniform(problem.lower, problem.upper)
    return run


def cobyla(problem, x):
    with_nlopt(problem, nlopt.LN_COBYLA, x, 50 * (problem.genes + 1))


def slsqp(problem, x):
    with_nlopt(problem, nlopt.LD_SLSQP, x)


def with_cobyqa(problem, x):
    cache = {}

    def values(point):
        key = point.tobytes()
        if key not in cache:
            cache.clear()
            cache[key] = problem(point)
        return cache[key]

    first = 1 + problem.equalities
    constraints = [scipy.optimize.NonlinearConstraint(lambda point, rows=rows: values(point)[rows], low, 0)
                   for rows, low, count in ((slice(1, first), 0, problem.equalities),
                                            (slice(first, None), -numpy.inf, problem.inequalities)) if count]
    cobyqa.minimize(lambda point: float(values(point)[0]), x, constraints=constraints,
                    bounds=scipy.optimize.Bounds(problem.lower, problem.upper),
                    options={"maxfev": problem.budget - problem.calls + 1, "feasibility_tol": INEQUALITY})


def at_random(problem, seed):
    random = numpy.random.default_rng(seed)
    if problem.has_start:
        problem(problem.start)
    while True:
        whole = random.integers(problem.lower.astype(int), problem.upper.astype(int), endpoint=True)
        problem(numpy.where(problem.whole > 0, whole, random.uniform(problem.lower, problem.upper)))


PEERS = {"pagmo gaco": gaco, "pagmo cstrs_self_adaptive": self_adaptive, "NLopt ISRES": isres, "NLopt COBYLA": from_random_points(cobyla),
         "NLopt SLSQP": from_random_points(slsqp), "COBYQA": from_random_points(with_cobyqa), "random search": at_random}


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    source = parser.add_mutually_exclusive_group(required=True)
    source.add_argument("--library", help="of the test functions")
    source.add_argument("--program", help="that serves the problems")
    parser.add_argument("--problems", nargs="+", required=True)
    parser.add_argument("--ways", nargs="+", choices=PEERS, required=True)
    parser.add_argument("--budgets", nargs="+", type=int, required=True)
    parser.add_argument("--seeds", type=int, required=True)
    arguments = parser.parse_args()
    print(json.dumps({"versions": f"pygmo {version('pygmo')}, nlopt {version('nlopt')}, cobyqa {version('cobyqa')}"}), flush=True)
    for name in arguments.problems:
        source = Served(arguments.program, name) if arguments.program else Library(arguments.library, name)
        for budget, title in itertools.product(arguments.budgets, arguments.ways):
            for seed in range(1, arguments.seeds + 1):
                problem = Problem(source, budget)
                try:
                    PEERS[title](problem, seed)
                except Spent:
                    pass
                except Exception as error:  # what a package cannot do is said in the table
                    print(json.dumps({"failure": f"{title} on {name}: {str(error)[:200]}"}), flush=True)
                gap = problem.best - source.optimum
                print(json.dumps({"way": title, "problem": name, "budget": budget, "seed": seed,
                                  "optimum": source.optimum, "gap": gap if math.isfinite(gap) else None}), flush=True)


if __name__ == "__main__":
    main()
