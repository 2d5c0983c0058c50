"""Designs that no other is better than, and the choice of those to route."""

from synthesis.tools import Failure


def dominates(a, b):
    """a is nowhere worse than b; less is better."""
    return all(x <= y for x, y in zip(a, b))


def nondominated(items, key):
    """The items whose key no other item's dominates; of equal keys the first. Less is better. Items are kept in
    the order of their keys. O(n log n + n f) for f items that are kept."""
    kept = []
    for item_key, _, item in sorted((key(item), index, item) for index, item in enumerate(items)):
        # What sorts before may dominate, what sorts behind cannot. Late ones dominate most often.
        if not any(dominates(other, item_key) for other, _ in reversed(kept)):
            kept.append((item_key, item))
    return [item for _, item in kept]


def thinned(designs, figure, step):
    """Those of the designs, in rising order of a figure, that exceed the one kept before by this share."""
    kept = []
    for design in sorted(designs, key=figure):
        if not kept or figure(design) >= figure(kept[-1]) * (1 + step):
            kept.append(design)
    return kept


def best_few(designs, count, numbers=()):
    """The designs with most pairs a second, each of another number of elements; or those of these numbers
    (exact, filter). Only designs that the sources build."""
    chosen = {}
    for design in sorted(designs, key=lambda design: (-design.pairs, design.cells, design.dsp)):
        if design.buildable:
            chosen.setdefault((design.exact_elements, design.filter_elements), design)
    if missing := [pair for pair in numbers if pair not in chosen]:
        there = ", ".join(f"{exact}+{of_filter}" for exact, of_filter in sorted(chosen))
        raise Failure(f"no board of the frontier has {missing[0][0]}+{missing[0][1]} elements; there are {there}")
    return [chosen[pair] for pair in numbers] if numbers else list(chosen.values())[:count]
