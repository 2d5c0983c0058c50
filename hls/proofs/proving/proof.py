"""The parts of a proof. The proofs themselves stand in hls/proofs/table.py."""

from dataclasses import dataclass, field


@dataclass(frozen=True)
class Fault:
    """A fault that has to refute the proof: a mutant of hls/rtl/mutation.sv, or a replaced text (file, old, new)."""

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
    files: tuple = ()  # in hls/proofs/harness: the harness, and modules that replace others
    family: str = "behavioural"
    rule: object = None  # of the methods "words", "split" and "graph": the rule of the result
    reach: int = 0  # steps, from the first on, within which covers and faults must be found
    spread: bool = False  # memories become registers
    watch: tuple = ()  # (file, text): signals that the harness reads, inserted before the file's last endmodule
    limit: int = 600  # seconds for the solver
    quick: bool = True
    assumes: str = ""  # other proofs or conditions that this proof builds on


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
    """The form of the distance whose graph the datapath has to be, or the file of a function's graph."""

    name: str = ""
    file: str = ""  # as emax_lower --graph writes it


@dataclass(frozen=True)
class Parts:
    """A product out of partial products: (lowest bit, bits) of the parts of both operands."""

    inputs: tuple
    output: str
    a: tuple
    b: tuple
