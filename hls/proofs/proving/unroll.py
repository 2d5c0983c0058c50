"""The terms of a netlist's signals, step by step, for Bitwuzla."""

from bitwuzla import Kind, TermManager

KINDS = {
    "not": Kind.BV_NOT, "inc": Kind.BV_INC, "dec": Kind.BV_DEC, "neg": Kind.BV_NEG, "redand": Kind.BV_REDAND,
    "redor": Kind.BV_REDOR, "redxor": Kind.BV_REDXOR, "and": Kind.BV_AND, "nand": Kind.BV_NAND, "or": Kind.BV_OR,
    "nor": Kind.BV_NOR, "xor": Kind.BV_XOR, "xnor": Kind.BV_XNOR, "iff": Kind.BV_XNOR, "concat": Kind.BV_CONCAT,
    "sll": Kind.BV_SHL, "srl": Kind.BV_SHR, "sra": Kind.BV_ASHR, "add": Kind.BV_ADD, "sub": Kind.BV_SUB,
    "mul": Kind.BV_MUL, "udiv": Kind.BV_UDIV, "urem": Kind.BV_UREM, "read": Kind.ARRAY_SELECT,
    "write": Kind.ARRAY_STORE,
}
COMPARISONS = {"eq": Kind.EQUAL, "neq": Kind.DISTINCT, "ugt": Kind.BV_UGT, "ugte": Kind.BV_UGE, "ult": Kind.BV_ULT,
               "ulte": Kind.BV_ULE, "sgt": Kind.BV_SGT, "sgte": Kind.BV_SGE, "slt": Kind.BV_SLT, "slte": Kind.BV_SLE}
EXTENSIONS = {"uext": Kind.BV_ZERO_EXTEND, "sext": Kind.BV_SIGN_EXTEND}


class Terms:
    """Short names for common terms. A condition is a Boolean; a bit is a vector of one bit."""

    def __init__(self):
        self.tm = TermManager()
        self.booleans = self.tm.mk_bool_sort()

    def bv(self, width, value):
        return self.tm.mk_bv_value(self.tm.mk_bv_sort(width), value)

    def const(self, width, name):
        return self.tm.mk_const(self.sort(width), name)

    def sort(self, sort):
        if isinstance(sort, tuple):
            return self.tm.mk_array_sort(self.tm.mk_bv_sort(sort[0]), self.tm.mk_bv_sort(sort[1]))
        return self.tm.mk_bv_sort(sort)

    def op(self, kind, *terms, indices=()):
        return self.tm.mk_term(kind, list(terms), list(indices))

    def slice(self, term, high, low):
        return self.op(Kind.BV_EXTRACT, term, indices=[high, low])

    def concat(self, *terms):
        return self.op(Kind.BV_CONCAT, *terms)

    def eq(self, a, b):
        return self.op(Kind.EQUAL, a, b)

    def ite(self, condition, a, b):
        return self.op(Kind.ITE, condition, a, b)

    def both(self, *conditions):
        return self.op(Kind.AND, *conditions) if len(conditions) > 1 else conditions[0] if conditions else self.tm.mk_true()

    def either(self, *conditions):
        return self.op(Kind.OR, *conditions) if len(conditions) > 1 else conditions[0] if conditions else self.tm.mk_false()

    def negated(self, condition):
        return self.op(Kind.NOT, condition)

    def true(self, bit):
        return self.eq(bit, self.bv(1, 1))

    def bit(self, condition):
        return self.ite(condition, self.bv(1, 1), self.bv(1, 0))


class Unrolling:
    """term(node, step). Step 0 starts from the initial values where `initial` is set, else anywhere.

    `replaced` maps inputs to functions of the step, for the outputs of modules that are left out.
    """

    def __init__(self, system, terms, initial, replaced=None, products=None):
        self.system, self.terms, self.initial = system, terms, initial
        self.replaced = replaced or {}
        self.products = products  # a list: products become unknowns, noted as (factor, factor, product)
        self.cache = {}

    def named(self, name, step):
        return self.term(self.system.named(name), step)

    def term(self, number, step):
        stack = [(number, step)]
        while stack:
            key = stack[-1]
            if key in self.cache:
                stack.pop()
                continue
            missing = [need for need in self._needs(*key) if need not in self.cache]
            if missing:
                stack += missing
            else:
                stack.pop()
                self.cache[key] = self._make(*key)
        return self.cache[number, step]

    def _needs(self, number, step):
        node = self.system.nodes[number]
        if number in self.replaced:
            return self.replaced[number].needs(step)
        if node.kind == "state":
            if step > 0 and number in self.system.next:
                return [(self.system.next[number], step - 1)]
            if step == 0 and self.initial and number in self.system.init:
                return [(self.system.init[number], 0)]
            return []
        return [(operand, step) for operand in node.operands]

    def _make(self, number, step):
        t, node = self.terms, self.system.nodes[number]
        needs = self._needs(number, step)
        if number in self.replaced:
            return self.replaced[number].make([self.cache[need] for need in needs])
        if node.kind == "const":
            return t.bv(node.sort, node.value)
        if node.kind == "state" and needs:
            value = self.cache[needs[0]]
            if isinstance(node.sort, tuple) and step == 0:  # a word for all words
                return t.tm.mk_const_array(t.sort(node.sort), value)
            return value
        if node.kind in ("input", "state"):
            return t.const(node.sort, f"n{number}@{step}")
        operands = [self.cache[need] for need in needs]
        if node.kind in COMPARISONS:
            return t.bit(t.op(COMPARISONS[node.kind], *operands))
        if node.kind == "implies":
            return t.op(Kind.BV_OR, t.op(Kind.BV_NOT, operands[0]), operands[1])
        if node.kind == "ite":
            return t.ite(t.true(operands[0]), operands[1], operands[2])
        if node.kind in EXTENSIONS:
            return operands[0] if node.indices == [0] else t.op(EXTENSIONS[node.kind], operands[0], indices=node.indices)
        if node.kind == "slice":
            return t.slice(operands[0], *node.indices)
        if node.kind == "mul" and self.products is not None and not any(term.is_value() for term in operands):
            product = t.const(node.sort, f"n{number}@{step}")
            self.products.append((*operands, product))
            return product
        return t.op(KINDS[node.kind], *operands)
