"""What a proof is. The proofs themselves stand in hls/proofs/table.py."""

from dataclasses import dataclass, field


@dataclass(frozen=True)
class Fault:
    """A fault that has to refute the proof: a mutant of hls/rtl/mutation.sv, or words of a file put in the place
    of others (file, old, new)."""

    what: str = ""
    mutant: str = ""
    patch: tuple = ()

    @property
    def name(self):
        return self.mutant or self.what


@dataclass(frozen=True)
class Proof:
    name: str
    what: str  # a sentence: what holds
    method: str  # a name of methods.METHODS
    top: str
    depth: int  # the latency of a pipeline, the depth of an induction or of a bounded check
    faults: tuple
    parameters: dict = field(default_factory=dict)
    files: tuple = ()  # of hls/proofs/harness: the harness, and modules that stand in for others
    family: str = "behavioural"
    rule: object = None  # methods "words", "split" and "graph": what the result has to be
    reach: int = 0  # from the first step on: within how many steps covers and faults are found
    spread: bool = False  # memories become registers
    watch: tuple = ()  # (file, text): signals for the harness to look at, put before the file's last endmodule
    limit: int = 600  # seconds for the solver
    quick: bool = True
    assumes: str = ""  # other proofs, or statements outside, that this one builds on


@dataclass(frozen=True)
class Words:
    """The rule of a pipeline that is fed every cycle: its output after `depth` edges."""

    name: str  # a method of floats.Rules, or "same"
    inputs: tuple
    output: str
    exponent: int = 8
    mantissa: int = 23
    functions: tuple = ()  # (instance, function, operands): modules that are left out
    without: tuple = ()  # cases of the rule that cannot occur


@dataclass(frozen=True)
class Graph:
    """The form of the distance whose graph the datapath has to be."""

    name: str


@dataclass(frozen=True)
class Parts:
    """A product out of partial products: (lowest bit, bits) of the parts of both operands."""

    inputs: tuple
    output: str
    a: tuple
    b: tuple
