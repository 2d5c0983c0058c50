"""The proof of a lowered function: the pipeline of its folder is its dataflow graph for all inputs."""

import json
import re
from pathlib import Path

from synthesis.tools import Failure

from .proof import Fault, Graph, Proof

# A text of the pipeline, what stands in its place, and what that is. The first place of each is taken.
FAULTS = (
    (r"\.DEPTH\((\d+)\)(.*)", lambda m: f".DEPTH({int(m[1]) - 1}){m[2]}", "a delay is one edge short"),
    (r"(\w+_LATENCY)\)\) (\w+) \(", lambda m: f"{m[1]} - 1)) {m[2]} (", "an operator is one edge short"),
    (r"\.a\((\w+)\), \.b\((?!\1\))(\w+)\)(.*)", lambda m: f".a({m[1]}), .b({m[1]}){m[3]}", "an operand takes the place of another"),
    (r"(\w+) \? (\w+) : (?!\2;)(\w+);", lambda m: f"{m[1]} ? {m[3]} : {m[2]};", "a choice takes the wrong branch"),
    (r"(assign \w+ =\s+)(.*(?:\[|\w [&|] |~).*);", lambda m: f"{m[1]}~({m[2]});", "a line of logic is inverted"),
)


def faults_of(file, text):
    """A fault of each kind that the pipeline has a place for."""
    start = text.index(");\n", text.index("\nmodule ")) + 3  # after the ports
    faults = []
    for pattern, replacement, what in FAULTS:
        place = next((m for m in re.finditer(pattern, text[start:]) if text.count(m[0]) == 1), None)
        if place is not None:
            faults.append(Fault(what, patch=(file, place[0], replacement(place))))
    return tuple(faults)


def proof_of(folder, stubs):
    """The proof of a folder that hls/lowering/lower_function.sh wrote; `stubs` replace the operators."""
    files = sorted(Path(folder).glob("*_graph.json"))
    if len(files) != 1:
        raise Failure(f"{folder} has {len(files)} files *_graph.json instead of one; lower the function again")
    design = json.loads(files[0].read_text())
    module = Path(folder).resolve() / f"{design['module']}.sv"
    if not module.exists():
        raise Failure(f"{module} is not there; lower the function again")
    faults = faults_of(module.name, module.read_text())
    return Proof(design["module"], "the pipeline is the function's dataflow graph for all inputs, with the operators as unknown functions",
                 "graph", design["module"], design["latency"], faults, files=(*stubs, str(module)),
                 rule=Graph(file=str(files[0].resolve())))


def plan(proof):
    """A line that says what is about to be proven."""
    return (f"{proof.name}: proving that the pipeline of {proof.depth} edges is the function's dataflow graph, then the same with "
            f"{len(proof.faults)} faults; each takes seconds, and at most {proof.limit // 60} minutes")


def sentence(proof, result):
    """(whether the proof counts, a line that says so)"""
    if result.get("failure"):
        return False, f"{proof.name}: {result['failure']}"
    if not result["holds"]:
        return False, f"{proof.name}: refuted: {result['how']}"
    refuting = [fault["name"] for fault in result["faults"] if fault.get("refuted")]
    hidden = [fault["name"] for fault in result["faults"] if not fault.get("refuted")]
    if not refuting:
        return False, f"{proof.name}: no fault refutes the proof, so it says nothing"
    return True, (f"{proof.name}: proven for all inputs, {result['depth']}, in {result['seconds']:.1f} s ({'; '.join(result['covered'])}); "
                  f"faults that refute it: {', '.join(refuting)}" + (f"; without effect: {', '.join(hidden)}" if hidden else ""))
