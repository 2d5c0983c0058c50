from __future__ import annotations

import threading
from typing import Any, Callable, Sequence

import numpy as np

from . import _core
from ._results import Interrupted

_CONTINUOUS, _WHOLE, _CATEGORY = 0, 1, 2


class OptimizeResult(dict[str, Any]):
    """A result as SciPy gives them: a dictionary whose entries are attributes too.

    ``x``, ``fun``, ``nfev``, ``success``, ``status`` and ``message`` have SciPy's meanings;
    ``constr_violation`` is the greatest violation of a nonlinear constraint, 0 where all hold.
    """

    def __getattr__(self, name: str) -> Any:
        try:
            return self[name]
        except KeyError as missing:
            raise AttributeError(name) from missing

    def __dir__(self) -> list[str]:
        return [*super().__dir__(), *self]


class _Nonlinear:
    """One constraint of SciPy as values that are at most 0, or 0."""

    def __init__(self, constraint: Any, x: np.ndarray, tolerance: float) -> None:
        if isinstance(constraint, dict):
            kind = constraint["type"]
            if kind not in ("ineq", "eq"):
                raise ValueError(f"constraints: a type is 'ineq' or 'eq', not {kind!r}")
            fun, args = constraint["fun"], tuple(constraint.get("args", ()))
            self.fun: Callable[[np.ndarray], Any] = lambda x: fun(x, *args)
            lower, upper = 0.0, 0.0 if kind == "eq" else np.inf
        else:
            self.fun, lower, upper = constraint.fun, constraint.lb, constraint.ub
        size = np.atleast_1d(np.asarray(self.fun(x), dtype=float)).size
        self.lower, self.upper = np.broadcast_to(lower, size), np.broadcast_to(upper, size)
        self.equal = self.lower == self.upper
        self.below = ~self.equal & np.isfinite(self.lower)
        self.above = ~self.equal & np.isfinite(self.upper)
        self.kinds = ([(True, tolerance)] * int(self.equal.sum())
                      + [(False, 0.0)] * int(self.below.sum() + self.above.sum()))

    def values(self, x: np.ndarray) -> list[float]:
        found = np.atleast_1d(np.asarray(self.fun(x), dtype=float))
        return [*(found - self.lower)[self.equal], *(self.lower - found)[self.below],
                *(found - self.upper)[self.above]]


def _linear_rows(constraint: Any) -> list[tuple[list[tuple[int, float]], bool, float]]:
    matrix = np.atleast_2d(np.asarray(constraint.A, dtype=float))
    rows: list[tuple[list[tuple[int, float]], bool, float]] = []
    for a, lower, upper in zip(matrix, np.broadcast_to(constraint.lb, len(matrix)),
                               np.broadcast_to(constraint.ub, len(matrix))):
        terms = [(int(i), float(a[i])) for i in np.flatnonzero(a)]
        if lower == upper:
            rows.append((terms, True, float(upper)))
            continue
        if np.isfinite(upper):
            rows.append((terms, False, float(upper)))
        if np.isfinite(lower):
            rows.append(([(i, -c) for i, c in terms], False, -float(lower)))
    return rows


def _pairs_of(bounds: Any) -> list[tuple[float, float]]:
    if hasattr(bounds, "lb"):
        lower, upper = np.broadcast_arrays(np.atleast_1d(bounds.lb), np.atleast_1d(bounds.ub))
        bounds = np.column_stack([lower, upper])
    pairs = np.asarray(bounds, dtype=float)
    if pairs.ndim != 2 or pairs.shape[1] != 2 or len(pairs) == 0:
        raise ValueError(f"bounds: a pair (lower, upper) for each variable is needed, not shape {pairs.shape}")
    if not np.isfinite(pairs).all():
        raise ValueError("bounds: each end has to be finite")
    return [(float(lower), float(upper)) for lower, upper in pairs]


class _Search:
    """The evaluations of one search, and the best of them."""

    def __init__(self, fun: Callable[..., float], args: tuple[Any, ...], nonlinear: list[_Nonlinear],
                 callback: Callable[[OptimizeResult], object] | None) -> None:
        self.fun, self.args, self.nonlinear, self.callback = fun, args, nonlinear, callback
        self.lock = threading.Lock()
        self.nfev = 0
        self.best: OptimizeResult | None = None
        self.told: OptimizeResult | None = None
        self.ended = False

    def evaluate(self, genes: list[float]) -> tuple[float, list[float]]:
        x = np.array(genes)
        objective = float(self.fun(x, *self.args))
        values = [float(v) for constraint in self.nonlinear for v in constraint.values(x)]
        kinds = [kind for constraint in self.nonlinear for kind in constraint.kinds]
        violation = max((abs(v) - tolerance if equal else v for v, (equal, tolerance) in zip(values, kinds)),
                        default=0.0)
        violation = max(violation, 0.0)
        with self.lock:
            self.nfev += 1
            if not np.isfinite([objective, violation]).all():
                return objective, values
            if self.best is None or (violation, objective) < (self.best.constr_violation, self.best.fun):
                self.best = OptimizeResult(x=x, fun=objective, nfev=self.nfev, constr_violation=violation)
        return objective, values

    def stopped(self) -> bool:
        if self.callback is not None and not self.ended and self.best is not None and self.best is not self.told:
            self.told = self.best
            try:
                self.ended = bool(self.callback(OptimizeResult(self.best)))
            except StopIteration:
                self.ended = True
        return self.ended


def minimize(
    fun: Callable[..., float],
    bounds: Any,
    constraints: Any = (),
    x0: Any = None,
    *,
    args: tuple[Any, ...] = (),
    integrality: Sequence[int] | int = 0,
    budget: int = 150,
    seed: int = 1,
    jobs: int = 1,
    tolerance: float = 1e-6,
    callback: Callable[[OptimizeResult], object] | None = None,
) -> OptimizeResult:
    """Minimises ``fun(x, *args)`` with Genocop III: few evaluations, no derivatives.

    ``bounds`` are finite pairs, or SciPy's ``Bounds``. ``constraints`` are as SciPy takes them:
    ``LinearConstraint``, ``NonlinearConstraint``, dictionaries with ``type`` and ``fun``, or a
    sequence of these; an equality holds within ``tolerance``. Nonlinear constraints are best scaled
    alike. ``x0`` is one start, or several rows. ``integrality`` is 1 for whole variables and 2 for
    categories, which have no order. ``budget`` is the number of evaluations. ``jobs`` evaluations
    run at a time, each in a thread; the result is the same for any number of them. ``callback`` is
    called with the best so far whenever it got better; True or StopIteration ends the search. Ctrl-C
    raises :class:`Interrupted` with the best so far.

    >>> import emax
    >>> box = emax.minimize(lambda x: x[0] ** 2 + x[1] ** 2, [(-5, 5), (-5, 5)],
    ...                     {"type": "ineq", "fun": lambda x: x[0] + x[1] - 1}, budget=200)
    >>> box.success, round(box.fun, 3), box.nfev
    (True, 0.5, 200)
    """
    pairs = _pairs_of(bounds)
    kinds = [int(kind) for kind in np.broadcast_to(integrality, len(pairs))]
    if not set(kinds) <= {_CONTINUOUS, _WHOLE, _CATEGORY}:
        raise ValueError("integrality: 0 for continuous variables, 1 for whole ones, 2 for categories")
    if budget < 1 or jobs < 1:
        raise ValueError("budget, jobs: numbers of at least 1")
    starts = np.empty((0, len(pairs))) if x0 is None else np.atleast_2d(np.asarray(x0, dtype=float))
    if starts.shape[1] != len(pairs):
        raise ValueError(f"x0: {len(pairs)} numbers a start are needed, not {starts.shape[1]}")
    middle = starts[0] if len(starts) else np.array([(lower + upper) / 2 for lower, upper in pairs])
    if isinstance(constraints, dict) or hasattr(constraints, "lb"):
        constraints = [constraints]
    linear = [row for c in constraints if hasattr(c, "A") for row in _linear_rows(c)]
    nonlinear = [_Nonlinear(c, middle, tolerance) for c in constraints if not hasattr(c, "A")]
    search = _Search(fun, args, nonlinear, callback)
    try:
        x, value, evaluated, violation, _, _ = _core.minimize(
            search.evaluate, pairs, kinds, linear, [kind for c in nonlinear for kind in c.kinds],
            [list(map(float, start)) for start in starts], budget, seed, jobs, search.stopped)
    except KeyboardInterrupt as interrupt:
        raise Interrupted(search.best) from interrupt
    except _core.Error:  # the callback ended the search before its first result was taken
        if not search.ended or search.best is None:
            raise
        x, value, evaluated, violation = search.best.x, search.best.fun, True, search.best.constr_violation
    violation = max(violation, 0.0) if evaluated else np.inf
    feasible = bool(evaluated and violation == 0)
    status = 99 if search.ended else 0 if feasible else 1
    message = ("the callback ended the search" if search.ended else
               "the budget is used" if feasible else
               "the budget is used, and no point keeps all constraints" if evaluated else
               "no evaluation gave finite numbers")
    return OptimizeResult(x=np.array(x), fun=value, nfev=search.nfev, success=feasible and not search.ended,
                          status=status, message=message, constr_violation=violation)
