"""Reads a netlist in BTOR2, as Yosys writes it, and runs it on numbers.

A value is a whole number of the node's width; a memory is a dictionary of the words that differ from 0.
"""

from dataclasses import dataclass, field

from synthesis.tools import Failure

CONSTANTS = {"const": 2, "constd": 10, "consth": 16}
UNARY = {"not", "inc", "dec", "neg", "redand", "redor", "redxor"}
BINARY = {"implies", "iff", "eq", "neq", "and", "nand", "or", "nor", "xor", "xnor", "ugt", "ugte", "ult", "ulte",
          "sgt", "sgte", "slt", "slte", "concat", "sll", "srl", "sra", "add", "sub", "mul", "udiv", "urem", "read"}


@dataclass
class Node:
    kind: str
    sort: object  # the width, or (address width, word width) of a memory
    operands: list = field(default_factory=list)
    indices: list = field(default_factory=list)
    value: int = 0


class System:
    """nodes, and of these: inputs, states (with init and next), properties, assumptions, and names."""

    def __init__(self, text):
        self.nodes, self.inputs, self.states = {}, [], []
        self.init, self.next = {}, {}
        self.bad, self.constraints, self.names = [], [], {}
        sorts = {}
        for line in text.splitlines():
            words = line.split(" ;")[0].split()
            if not words or words[0].startswith(";"):
                continue
            number, kind, *rest = words
            number = int(number)
            if kind == "sort":
                sorts[number] = int(rest[1]) if rest[0] == "bitvec" else (sorts[int(rest[1])], sorts[int(rest[2])])
            elif kind in ("init", "next"):
                (self.init if kind == "init" else self.next)[int(rest[1])] = int(rest[2])
            elif kind == "bad":
                # An assertion without a name is called by its place: file:37 for folder/file:37.7-37.82.
                name = rest[1].rpartition("/")[2] if len(rest) > 1 else f"assertion {len(self.bad) + 1}"
                self.bad.append((name.split(".sv:")[0] + ".sv:" + name.split(".sv:")[1].split(".")[0]
                                 if ".sv:" in name else name, int(rest[0])))
            elif kind == "constraint":
                self.constraints.append(int(rest[0]))
            elif kind == "output":
                self.names.setdefault(rest[1] if len(rest) > 1 else f"output {number}", int(rest[0]))
            else:
                self._node(number, kind, sorts[int(rest[0])], rest[1:])

    def _node(self, number, kind, sort, rest):
        node = Node(kind, sort)
        if kind in CONSTANTS:
            node.kind, node.value = "const", int(rest[0], CONSTANTS[kind])
            rest = rest[1:]
        elif kind in ("zero", "one", "ones"):
            node.kind, node.value = "const", {"zero": 0, "one": 1, "ones": (1 << sort) - 1}[kind]
        elif kind == "input":
            self.inputs.append(number)
        elif kind == "state":
            self.states.append(number)
        else:
            operands = {"slice": 1, "uext": 1, "sext": 1, "ite": 3, "write": 3}.get(kind)
            operands = operands or (1 if kind in UNARY else 2 if kind in BINARY else 0)
            indices = {"slice": 2, "uext": 1, "sext": 1}.get(kind, 0)
            if operands == 0:
                raise Failure(f"BTOR2 operation '{kind}' is not known to this reader")
            node.operands = [int(word) for word in rest[:operands]]
            node.indices = [int(word) for word in rest[operands:operands + indices]]
            rest = rest[operands + indices:]
        self.nodes[number] = node
        if rest:
            self.names[rest[0]] = number

    def named(self, name):
        if name not in self.names:
            close = [known for known in self.names if known.split(".")[-1] == name.split(".")[-1]]
            raise Failure(f"the netlist has no signal '{name}'" + (f"; it has {', '.join(close[:5])}" if close else ""))
        number = self.names[name]
        while self.nodes[number].kind == "uext" and self.nodes[number].indices == [0]:  # another name
            (number,) = self.nodes[number].operands
        return number

    def width(self, name):
        return self.nodes[self.named(name)].sort


def signed(value, width):
    return value - (1 << width) if value >> (width - 1) else value


def apply(node, operands, sorts):
    """The result of an operation for values of its operands, whose sorts are given."""
    kind, width = node.kind, node.sort
    if kind == "write":
        memory, address, word = operands
        return {**memory, address: word}
    if kind == "read":
        return operands[0].get(operands[1], 0)
    if kind == "ite":
        return operands[1] if operands[0] else operands[2]
    mask, a, size = (1 << width) - 1, operands[0], sorts[0]
    if kind == "slice":
        return (a >> node.indices[1]) & mask
    if kind == "uext":
        return a
    if kind in UNARY or kind == "sext":
        return {
            "not": lambda: ~a & mask, "inc": lambda: (a + 1) & mask, "dec": lambda: (a - 1) & mask,
            "neg": lambda: -a & mask, "redand": lambda: int(a == (1 << size) - 1), "redor": lambda: int(a != 0),
            "redxor": lambda: bin(a).count("1") & 1, "sext": lambda: signed(a, size) & mask,
        }[kind]()
    b = operands[1]
    if kind in ("eq", "neq", "iff") and isinstance(a, dict):
        words = all(a.get(i, 0) == b.get(i, 0) for i in {*a, *b})
        return int(words == (kind != "neq"))
    signs = (signed(a, size), signed(b, size)) if kind in ("sgt", "sgte", "slt", "slte") else (a, b)
    return {
        "implies": lambda: int(not a or b), "iff": lambda: int(a == b), "eq": lambda: int(a == b),
        "neq": lambda: int(a != b), "and": lambda: a & b, "nand": lambda: ~(a & b) & mask, "or": lambda: a | b,
        "nor": lambda: ~(a | b) & mask, "xor": lambda: a ^ b, "xnor": lambda: ~(a ^ b) & mask,
        "ugt": lambda: int(a > b), "ugte": lambda: int(a >= b), "ult": lambda: int(a < b), "ulte": lambda: int(a <= b),
        "sgt": lambda: int(signs[0] > signs[1]), "sgte": lambda: int(signs[0] >= signs[1]),
        "slt": lambda: int(signs[0] < signs[1]), "slte": lambda: int(signs[0] <= signs[1]),
        "concat": lambda: a << sorts[1] | b, "sll": lambda: (a << b) & mask if b < width else 0,
        "srl": lambda: a >> b if b < width else 0, "sra": lambda: (signed(a, width) >> min(b, width)) & mask,
        "add": lambda: (a + b) & mask, "sub": lambda: (a - b) & mask, "mul": lambda: (a * b) & mask,
        "udiv": lambda: a // b if b else mask, "urem": lambda: a % b if b else a,
    }[kind]()


def simulate(system, steps, inputs, states):
    """[{node: value}] of each step. inputs(step, node) and states(node) give the values that are free. A state
    without `next` is free in every step."""
    trace = []
    for step in range(steps):
        values = {}
        for number, node in system.nodes.items():
            if node.kind == "const":
                values[number] = node.value
            elif node.kind == "input":
                values[number] = inputs(step, number)
            elif node.kind == "state":
                # An initial value or a next value may be of a later line than the state.
                if step > 0 and number in system.next:
                    values[number] = trace[-1][system.next[number]]
                elif step == 0 and number in system.init:
                    values[number] = initial(system, number)
                else:
                    values[number] = states(number) if step == 0 else inputs(step, number)
            else:
                values[number] = apply(node, [values[i] for i in node.operands],
                                       [system.nodes[i].sort for i in node.operands])
        trace.append(values)
    return trace


def initial(system, state):
    """The initial value of a state that has one. A word as that of a memory stands for each of its words."""
    node = system.nodes[system.init[state]]
    if node.kind != "const" or (isinstance(system.nodes[state].sort, tuple) and node.value):
        raise Failure("an initial value that is not a constant is not known to this reader")
    return {} if isinstance(system.nodes[state].sort, tuple) else node.value
