"""Proves a pipeline that adds up the products of the operands' parts to the product of two mantissas.

With a = sum of a_i 2^i and b = sum of b_j 2^j, a b = sum of a_i b_j 2^(i + j) is an identity of whole numbers. The
proof shows that the hardware multiplies these parts and no others, and adds all products at their places. Each partial
product is an unknown that is at most the greatest product of its parts. A product of parts of at most SMALL bits is
left to the solver itself.
"""

from bitwuzla import Kind

from synthesis.tools import Failure

from .solve import Solver, trace_of
from .unroll import Terms, Unrolling

SMALL = 6


def split(proof, system, refute=False):
    from .methods import Outcome
    terms, parts, products = Terms(), proof.rule, []
    unrolling = Unrolling(system, terms, False, products=products)
    a, b = (unrolling.named(name, 0) for name in (parts.inputs[0], parts.inputs[-1]))
    output = unrolling.named(parts.output, proof.depth)
    width = output.sort().bv_size()
    for operand, pieces in ((a, parts.a), (b, parts.b)):
        ends = [0, *(low + bits for low, bits in pieces)]
        if [low for low, _ in pieces] + [operand.sort().bv_size()] != ends:
            raise Failure("the parts do not make up the operand")

    def extend(term, size):
        return terms.op(Kind.BV_ZERO_EXTEND, term, indices=[size - term.sort().bv_size()])

    solver, summands, unmatched = Solver(terms, proof.limit), [], list(products)
    for low_a, bits_a in parts.a:
        for low_b, bits_b in parts.b:
            x, y = terms.slice(a, low_a + bits_a - 1, low_a), terms.slice(b, low_b + bits_b - 1, low_b)
            bits = bits_a + bits_b
            matching = []
            for left, right, product in products:
                size = left.sort().bv_size()
                if size < max(bits_a, bits_b):
                    continue
                pair, swapped = (extend(x, size), extend(y, size)), (extend(y, size), extend(x, size))
                for first, second in (pair, swapped):
                    if not solver.possible(terms.negated(terms.both(terms.eq(left, first), terms.eq(right, second)))):
                        matching.append((left, right, product))
                        break
            if not matching:
                if max(bits_a, bits_b) > SMALL:
                    if refute:
                        continue
                    raise Failure(f"nothing multiplies the parts at {low_a} and {low_b}")
                summand = terms.op(Kind.BV_MUL, extend(x, bits), extend(y, bits))
            else:
                summand = terms.const(bits, f"part {low_a} {low_b}")
                greatest = ((1 << bits_a) - 1) * ((1 << bits_b) - 1)
                solver.assume(terms.op(Kind.BV_ULE, summand, terms.bv(bits, greatest)))
                for match in matching:
                    size = match[2].sort().bv_size()
                    solver.assume(terms.eq(extend(summand, max(size, bits)), extend(match[2], max(size, bits))))
                    if match in unmatched:
                        unmatched.remove(match)
            shifted = terms.concat(extend(summand, width - low_a - low_b), terms.bv(low_a + low_b, 0)) \
                if low_a + low_b else extend(summand, width)
            summands.append(shifted)
    if unmatched:
        raise Failure("the hardware multiplies what is no pair of parts")
    total = summands[0]
    for summand in summands[1:]:
        total = terms.op(Kind.BV_ADD, total, summand)
    if not solver.possible():
        raise Failure("the bounds of the partial products contradict each other")
    if not solver.possible(terms.negated(terms.eq(total, terms.bv(width, 0)))):
        raise Failure("the sum is never anything but 0")
    if not solver.possible(terms.negated(terms.eq(output, total))):
        return Outcome(covered=[f"{len(summands)} partial products"], properties=1)
    if not refute:
        trace = trace_of(solver, unrolling, proof.depth + 1)
        return Outcome(trace, "sum", "the sum of the partial products is not the output\n")
    # The counterexample itself is one of true products.
    terms = Terms()
    unrolling, solver = Unrolling(system, terms, False), Solver(terms, proof.limit)
    a, b = (unrolling.named(name, 0) for name in (parts.inputs[0], parts.inputs[-1]))
    output = unrolling.named(parts.output, proof.depth)
    exact = terms.op(Kind.BV_MUL, extend(a, width), extend(b, width))
    if not solver.possible(terms.negated(terms.eq(output, exact))):
        return Outcome(covered=[], properties=1)
    trace = trace_of(solver, unrolling, proof.depth + 1)
    left, right, got = solver.number(a), solver.number(b), trace.value(parts.output, proof.depth)
    if got == left * right:
        raise Failure("the counterexample does not replay")
    return Outcome(trace, "product", f"{left:x} * {right:x} = {left * right:x}, not {got:x}\n")
