"""Writes docs/proofs.md from the results of a whole run."""

import importlib.metadata

from synthesis.document import table
from synthesis.tools import versions

INTRODUCTION = """# Proofs of the hardware

Written by `./dev prove`; never edit. Tools: Yosys {yosys}, Bitwuzla {bitwuzla}. `hls/proofs/table.py` lists the proofs,
`hls/proofs/harness/` holds their SystemVerilog, `hls/proofs/proving/` the methods. `./dev prove --quick` runs the proofs
that are part of the tests, `--only NAME` runs one proof, `--fault` shows the counterexamples of its faults.

## What is proven

{proofs}

The methods:

- **All words.** A pipeline is fed in one cycle. As many cycles later as its latency says, its output follows the rule, for
  every operand and whatever its registers held before. So the latency is proven with the result. The rule is written in
  the floating point of SMT-LIB (`hls/proofs/proving/floats.py`). A counter that runs by itself starts with any value that
  it can have.
- **Partial products.** Each product of two parts of the operands is an unknown within its bounds. The hardware multiplies
  nothing but these parts, and its output is the sum of the products at their places. That this sum is the product of the
  operands is an identity of whole numbers.
- **Congruence.** The operators are unknown functions, the same in the datapath and in the kernel's graph, which
  `emax_lower` records from the kernel's source. Delays are chains of registers here; they have proofs of their own.
- **Induction.** The properties hold from a reset on for any number of cycles, with further resets at any time. All
  registers but `reset` itself start with any value.
- **Bounded check.** The properties hold for the number of cycles in the table. Nothing is proven of later cycles.

## What each proof builds on

{assumptions}

All proofs trust that Yosys reads SystemVerilog as synthesis does, and that Bitwuzla's "no" is right. The cells of ECP5 are
those of `testbench/netlists/ecp5_blocks.sv`, written from the vendor's description.

## What is not proven

- `emax_core`, `filter_core` and `emax_link` as a whole, `emax_element`, `filter_element`, and the
  memories of `emax_distance_unit` and `emax_filter_unit`. Co-simulation with its mutants covers them.
- That the CRC finds all damage that it should find, data frames, and a serial line with different clocks at its two ends.
- Operators at other latencies and in other formats than those in the table. At binary32 a multiplication has no proof in
  one piece, but two proofs: of the product of the mantissas, and of everything around it.

## What shows that a proof can fail

A solver without an answer, a proof without a property, and a missing tool are failures. Each case of a rule and each cover
of a harness has to occur, and each assertion of an induction has to be violated by some state. Each fault below is put into
the sources and has to refute its proof. Its counterexample is replayed on numbers. It lies in `build/proofs/NAME/fault_N`,
in words and as a waveform in VCD format. For a bounded check and an induction it begins with the reset.

{faults}
"""


def write(path, proofs, results):
    rows, faults, assumptions = [], [], []
    for proof in proofs:
        result = results[proof.name]
        rows.append([proof.name, proof.what, result["method"], result["depth"], f"{result['seconds']:.1f} s"])
        if proof.assumes:
            assumptions.append(f"- {proof.name}: {proof.assumes}.")
        for fault in result["faults"]:
            faults.append([proof.name, fault["name"], " ".join(fault["how"].split()), f"{fault['seconds']:.1f} s"])
    path.write_text(INTRODUCTION.format(
        yosys=versions()["yosys"], bitwuzla=importlib.metadata.version("bitwuzla"),
        proofs=table(["proof", "what holds", "method", "depth", "time"], rows), assumptions="\n".join(assumptions),
        faults=table(["proof", "fault", "the counterexample begins with", "time"], faults)))
