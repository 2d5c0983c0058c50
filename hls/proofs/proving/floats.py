"""The rules of docs/numerics.md for the result of an operator, in the floating point of SMT-LIB.

Each rule gives (condition that has to hold, {case: when it occurs}). A rule proves nothing of a case that
cannot occur, so the proof fails then.
"""

from bitwuzla import Kind, RoundingMode


class Rules:
    def __init__(self, terms, exponent, mantissa):
        self.t, self.exponent, self.mantissa = terms, exponent, mantissa
        self.width = 1 + exponent + mantissa
        self.wide = {(5, 10): (8, 24), (8, 23): (11, 53)}.get((exponent, mantissa))  # holds each product exactly
        self.nearest = terms.tm.mk_rm_value(RoundingMode.RNE)
        self.quiet_nan = terms.bv(self.width, ((2 << exponent) - 1) << (mantissa - 1))

    # Words.

    def sign(self, word):
        return self.t.slice(word, self.width - 1, self.width - 1)

    def exponent_of(self, word):
        return self.t.slice(word, self.width - 2, self.mantissa)

    def fraction(self, word):
        return self.t.slice(word, self.mantissa - 1, 0)

    def zero(self, sign):
        return self.t.concat(sign, self.t.bv(self.width - 1, 0))

    def flushed(self, word):
        """A subnormal operand counts as zero of its sign."""
        tiny = self.t.eq(self.exponent_of(word), self.t.bv(self.exponent, 0))
        return self.t.ite(tiny, self.zero(self.sign(word)), word)

    def value(self, word):
        """The number of a word after flushing, in the format itself."""
        return self.number(self.flushed(word))

    def number(self, word):
        return self.t.op(Kind.FP_TO_FP_FROM_BV, word, indices=[self.exponent, self.mantissa + 1])

    def convert(self, number, exponent, significand):
        return self.t.op(Kind.FP_TO_FP_FROM_FP, self.nearest, number, indices=[exponent, significand])

    def is_(self, kind, number):
        return self.t.op(kind, number)

    # Rules.

    def less(self, a, b, result):
        x, y = self.value(a), self.value(b)
        less = self.t.op(Kind.FP_LT, x, y)
        nan = self.t.either(self.is_(Kind.FP_IS_NAN, x), self.is_(Kind.FP_IS_NAN, y))
        return self.t.eq(self.t.true(result), less), {
            "less": less, "not less": self.t.negated(less), "NaN": nan,
            "zeros of both signs": self.t.both(self.is_(Kind.FP_IS_ZERO, x), self.is_(Kind.FP_IS_ZERO, y),
                                               self.t.negated(self.t.eq(self.sign(a), self.sign(b))))}

    def _rounded(self, number, result):
        """The result for a number in this format: flushed where it is subnormal."""
        nan, tiny = self.is_(Kind.FP_IS_NAN, number), self.is_(Kind.FP_IS_SUBNORMAL, number)
        negative = self.t.bit(self.is_(Kind.FP_IS_NEG, number))
        right = self.t.ite(nan, self.t.eq(result, self.quiet_nan),
                           self.t.ite(tiny, self.t.eq(result, self.zero(negative)),
                                      self.t.eq(self.number(result), number)))
        infinite, normal = self.is_(Kind.FP_IS_INF, number), self.is_(Kind.FP_IS_NORMAL, number)
        return right, {"NaN": nan, "flushed": tiny, "infinite": infinite, "normal": normal}

    def add(self, a, b, result, subtract=False):
        """A sum of normal numbers is a multiple of the least subnormal. Where it is tiny it is exact, so
        rounding at unbounded exponent and rounding in the format agree."""
        x, y = self.value(a), self.value(b)
        number = self.t.op(Kind.FP_SUB if subtract else Kind.FP_ADD, self.nearest, x, y)
        right, cases = self._rounded(number, result)
        cases["zero of numbers"] = self.t.both(self.is_(Kind.FP_IS_ZERO, number), self.is_(Kind.FP_IS_NORMAL, x))
        return right, cases

    def subtract(self, a, b, result):
        return self.add(a, b, result, subtract=True)

    def _product(self, exact, result, special):
        """The result for a product whose exact value is a number of the wide format: flushed below
        2^least (1 - 2^-(MANTISSA + 2)), else rounded once. `special` are the conditions for NaN, an infinite
        and a zero product, which come first, and the sign of the latter."""
        t = self.t
        magnitude, limit = t.op(Kind.FP_ABS, exact), self._flush_limit()
        tiny = t.both(t.op(Kind.FP_LT, magnitude, limit), t.negated(self.is_(Kind.FP_IS_ZERO, exact)))
        nan, infinite, zero, sign = special
        narrow = self.convert(exact, self.exponent, self.mantissa + 1)
        right, cases = self._rounded(narrow, result)
        right = t.ite(tiny, t.eq(result, self.zero(t.bit(self.is_(Kind.FP_IS_NEG, exact)))), right)
        infinity = t.concat(sign, t.bv(self.exponent, (1 << self.exponent) - 1), t.bv(self.mantissa, 0))
        right = t.ite(nan, t.eq(result, self.quiet_nan), t.ite(infinite, t.eq(result, infinity),
                      t.ite(zero, t.eq(result, self.zero(sign)), right)))
        ordinary = t.negated(t.either(nan, infinite, zero))
        carried = t.both(t.op(Kind.FP_LT, magnitude, self._least()), t.negated(tiny))
        cases = {name: t.both(ordinary, case) for name, case in
                 {"flushed": tiny, "rounded up to the least normal number": carried,
                  "overflow": cases["infinite"], "normal": cases["normal"]}.items()}
        return right, cases | {"NaN": nan, "infinite operand": infinite, "zero operand": zero}

    def _wide_power(self, power, minus=0):
        """2^power (1 - 2^-minus), or 2^power, in the wide format."""
        exponent, significand = self.wide
        bias, bits = (1 << (exponent - 1)) - 1, significand - 1
        fraction = ((1 << bits) - (1 << (bits + 1 - minus))) if minus else 0
        return self.t.tm.mk_fp_value(self.t.bv(1, 0), self.t.bv(exponent, power - (minus > 0) + bias), self.t.bv(bits, fraction))

    def _least(self):
        return self._wide_power(2 - (1 << (self.exponent - 1)))

    def _flush_limit(self):
        return self._wide_power(2 - (1 << (self.exponent - 1)), self.mantissa + 2)

    def _special(self, a, b):
        t, (x, y) = self.t, (self.value(a), self.value(b))
        infinities = [self.is_(Kind.FP_IS_INF, n) for n in (x, y)]
        zeros = [self.is_(Kind.FP_IS_ZERO, n) for n in (x, y)]
        nan = t.either(self.is_(Kind.FP_IS_NAN, x), self.is_(Kind.FP_IS_NAN, y),
                       t.both(infinities[0], zeros[1]), t.both(infinities[1], zeros[0]))
        return nan, t.either(*infinities), t.either(*zeros), t.op(Kind.BV_XOR, self.sign(a), self.sign(b))

    def multiply(self, a, b, result):
        """The rule of a product, by SMT-LIB's own multiplication, which is exact in the wide format."""
        x, y = (self.convert(self.value(word), *self.wide) for word in (a, b))
        return self._product(self.t.op(Kind.FP_MUL, self.nearest, x, y), result, self._special(a, b))

    def square(self, a, result):
        return self.multiply(a, a, result)

    def product_of(self, a, b, exact, result):
        """The rule of a product, given the exact product of the mantissas. Sign, exponents and `exact` make a
        number that the wide format holds exactly. By definition the product is that number, rounded once."""
        t, m = self.t, self.mantissa
        exponent, significand = self.wide
        bias, wide_bias = (1 << (self.exponent - 1)) - 1, (1 << (exponent - 1)) - 1
        extend = lambda word, size: t.op(Kind.BV_ZERO_EXTEND, word, indices=[exponent - size])
        add = lambda x, y: t.op(Kind.BV_ADD, x, y)
        top = t.slice(exact, 2 * m + 1, 2 * m + 1)
        power = add(extend(self.exponent_of(a), self.exponent), extend(self.exponent_of(b), self.exponent))
        power = add(add(power, extend(top, 1)), t.bv(exponent, wide_bias - 2 * bias))
        fraction = t.ite(t.true(top), t.slice(exact, 2 * m, 0), t.concat(t.slice(exact, 2 * m - 1, 0), t.bv(1, 0)))
        fraction = t.concat(fraction, t.bv(significand - 1 - (2 * m + 1), 0))
        special = self._special(a, b)
        return self._product(t.op(Kind.FP_FP, special[3], power, fraction), result, special)

    # Rules and facts that the driver asks for by name.

    def canonical(self, word):
        """A property of every operator's result: no subnormal, and no NaN but 0x7fc00000."""
        t = self.t
        ones = t.eq(self.exponent_of(word), t.bv(self.exponent, (1 << self.exponent) - 1))
        zero = t.bv(self.mantissa, 0)
        whole = t.eq(self.fraction(word), zero)
        return t.both(t.either(t.negated(t.eq(self.exponent_of(word), t.bv(self.exponent, 0))), whole),
                      t.either(t.negated(ones), whole, t.eq(word, self.quiet_nan)))

    def facts(self, name):
        """The fact that holds for each value of a function that stands in for a module."""
        bits = 2 * self.mantissa + 2
        greatest = ((2 << self.mantissa) - 1) ** 2
        return {"product": lambda product, *_: self.t.both(
            self.t.op(Kind.BV_UGE, product, self.t.bv(bits, 1 << (bits - 2))),
            self.t.op(Kind.BV_ULE, product, self.t.bv(bits, greatest)))}[name]

    def mantissa_of(self, word):
        return self.t.concat(self.t.bv(1, 1), self.fraction(word))

    def rule(self, name, inputs, output, functions):
        """(condition that has to hold, {case: when it occurs})"""
        t = self.t
        if name == "same":
            return t.eq(inputs[0], output), {"some word": t.negated(t.eq(output, t.bv(output.sort().bv_size(), 0)))}
        if name == "exact product":
            size = output.sort().bv_size()
            a, b = (t.op(Kind.BV_ZERO_EXTEND, word, indices=[size - word.sort().bv_size()]) for word in (inputs[0], inputs[-1]))
            return t.eq(output, t.op(Kind.BV_MUL, a, b)), {"not zero": t.negated(t.eq(output, t.bv(size, 0)))}
        if name == "product_of":
            a, b = inputs[0], inputs[-1]
            exact = functions["product"].apply(self.mantissa_of(a), self.mantissa_of(b))
            return self.product_of(a, b, exact, output)
        return getattr(self, name)(*inputs, output)


def readable(value, rule, width):
    """ (the number), for words of binary32 and binary16."""
    import struct
    formats = {(8, 23): ("<I", "<f"), (5, 10): ("<H", "<e")}
    pack = formats.get((rule.exponent, rule.mantissa))
    if pack is None or width != 1 + rule.exponent + rule.mantissa:
        return ""
    return f" ({struct.unpack(pack[1], struct.pack(pack[0], value))[0]!r})"
