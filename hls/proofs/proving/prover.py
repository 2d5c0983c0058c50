"""Runs a proof and its faults, one after the other; the result is a dictionary for the driver."""

import shutil
import time

from bitwuzla import BitwuzlaException

from synthesis.tools import Failure

from . import methods, netlist


def attempt(proof, folder, fault=None):
    """The outcome of a proof, or of the same proof with a fault in its sources, and the seconds that it took."""
    start = time.monotonic()
    system = netlist.netlist(proof, folder, fault)
    outcome = methods.METHODS[proof.method](proof, system, fault is not None)
    if outcome.trace is not None:
        outcome.trace.write_vcd(folder / "counterexample.vcd")
        (folder / "counterexample.txt").write_text(outcome.text)
    return outcome, time.monotonic() - start


def first_line(text):
    return next((line for line in text.splitlines() if line.strip()), "")


def run(proof, folder, faults_alone=False):
    shutil.rmtree(folder / "proof", ignore_errors=True)
    result = {"method": methods.DESCRIPTIONS[proof.method], "depth": methods.depth(proof), "faults": []}
    try:
        if not faults_alone:
            outcome, seconds = attempt(proof, folder / "proof")
            result |= {"holds": outcome.trace is None, "how": first_line(outcome.text), "covered": outcome.covered,
                       "properties": outcome.properties, "seconds": round(seconds, 2)}
    except (Failure, BitwuzlaException) as failure:
        result["failure"] = str(failure)
    for number, fault in enumerate(proof.faults, 1):
        place = folder / f"fault_{number}"
        one = {"name": fault.name}
        try:
            outcome, seconds = attempt(proof, place, fault)
            one |= {"refuted": outcome.trace is not None, "how": first_line(outcome.text), "text": outcome.text,
                    "seconds": round(seconds, 2), "waveform": str(place / "counterexample.vcd")}
        except (Failure, BitwuzlaException) as failure:
            one["failure"] = str(failure)
        result["faults"].append(one)
    return result
