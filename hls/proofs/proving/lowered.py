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

# The same of the memory of records.
UNIT_FAULTS = (
    (r"\.DEPTH\((\d+)\)(.*slot_at_)", lambda m: f".DEPTH({int(m[1]) - 1}){m[2]}", "a slot is delayed by an edge less"),
    (r"\.DEPTH\((\d+)\)(.*_late_delay|\) \w+_late_delay)", lambda m: f".DEPTH({int(m[1]) - 1}){m[2]}", "a field is written an edge early"),
    (r"write_enable\((\w+)\), \.write_slot\(\w+\)(.*)", lambda m: f"write_enable(1'b0), .write_slot(write_slot){m[2]}", "a field is never written"),
    (r"write_enable\((\w+)\)(, \.write_slot.*)", lambda m: f"write_enable(1'b1){m[2]}", "a field is always written"),
    (r"write_data\(write_record\[(\d+):(\d+)\]\)", lambda m: f"write_data({{write_record[{m[2]}], write_record[{m[1]}:{int(m[2]) + 1}]}})",
     "a field's bits change places"),
)


def faults_of(file, text, kinds=FAULTS):
    """A fault of each kind that the pipeline has a place for."""
    start = text.index(");\n", text.index("\nmodule ")) + 3  # after the ports
    faults = []
    for pattern, replacement, what in kinds:
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


def unit_proof_of(folder, pipeline):
    """The proof of the memory of records in a folder, beside that of its pipeline; None where there is no record."""
    unit = Path(folder).resolve() / f"{pipeline.name}_unit.sv"
    if not unit.exists():
        return None
    return Proof(f"{pipeline.name}_unit", "each field is that of its record in the cycle in which the pipeline reads it",
                 "record", f"{pipeline.name}_unit", pipeline.depth, faults_of(unit.name, unit.read_text(), UNIT_FAULTS),
                 files=(*pipeline.files, str(unit)), parameters={"SLOT_BITS": 2}, spread=True, rule=pipeline.rule)


def plan(proof):
    """A line that says what is about to be proven."""
    return (f"{proof.name}: proving that {proof.what}, then the same with "
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
