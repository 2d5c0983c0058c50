"""docs/proofs.md, out of the results of a whole run."""

import importlib.metadata

from synthesis.document import table
from synthesis.tools import versions

INTRODUCTION = """# Proofs of the hardware

Written by `./dev prove`; never edit. Tools: Yosys {yosys}, Bitwuzla {bitwuzla}. The proofs are listed in `hls/proofs/table.py`.

## What is proven

{proofs}

All words: the output of a pipeline, its latency after the operands, follows the rule for every operand and every state of
its registers; the rule is written in the floating point of SMT-LIB (`hls/proofs/proving/floats.py`). Partial products: the
hardware multiplies the parts of the operands, each product an unknown within its bounds, and adds all of them at their
places; that the parts' products add up to the product is an identity of whole numbers. Congruence: operators are unknown
functions, the same in the datapath and in the kernel's graph. Induction: from a reset on and for any number of cycles, with
further resets at any time. Bounded check: the cycles after a reset that the table names, and no more.

## What each proof builds on

{assumptions}

## What shows that a proof can fail

A solver without an answer, a proof without a property and a tool that is missing are failures. Each case of a rule, and
each cover of a harness, has to occur; each assertion has to be violated by some state. Each fault below is put into the
sources and has to refute its proof. Its counterexample is replayed on numbers, and lies in `build/proofs` in words and as a
waveform in VCD format.

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
