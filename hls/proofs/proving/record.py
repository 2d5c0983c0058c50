"""The proof of a lowered function's memory of records: in the cycle in which the pipeline reads a field, it is that of
the record in the sample's slot, for all records, slots and samples. What the pipeline makes of it is proven apart."""

import json
from pathlib import Path

from synthesis.tools import Failure

from .solve import Solver, trace_of
from .unroll import Terms, Unrolling


class Contract:
    """What the unit's first lines permit: a record is written in step 0, a sample presents its slot `later` steps after
    that, and nothing else is written there until the record's last read. Memories and delays begin with any words."""

    def __init__(self, unrolling, design, later):
        self.t, self.of, self.design, self.sample = unrolling.terms, unrolling, design, later
        slot = self.of.named("write_slot", 0)
        self.assumed = [self.t.true(self.of.named("write_enable", 0)), self.t.eq(self.of.named("slot", self.sample), slot)]
        for step in range(1, self.sample + design["last_read"] + 1):
            self.assumed.append(self.t.negated(self.t.both(
                self.t.true(self.of.named("write_enable", step)), self.t.eq(self.of.named("write_slot", step), slot))))

    def wrong(self):
        """[(signal, its cycle, its step, the value that it should have, the condition that it has another)]"""
        found, record = [], self.of.named("write_record", 0)
        bits = {field["node"]: field["bit"] for field in self.design["record"]}
        for number, node in enumerate(self.design["nodes"]):
            if node["operation"] != "input":
                continue
            step = self.sample + node["start"]
            want = (self.t.slice(record, bits[number] + node["width"] - 1, bits[number]) if number in bits
                    else self.of.named(node["name"], step))
            found.append(self._compared(f"datapath.{node['name']}", node["start"], want))
        for output in self.design["outputs"]:
            cycle = self.design["latency"]
            found.append(self._compared(output["name"], cycle, self.of.named(f"datapath.{output['name']}", self.sample + cycle)))
        return found

    def _compared(self, name, cycle, want):
        step = self.sample + cycle
        return name, cycle, step, want, self.t.negated(self.t.eq(self.of.named(name, step), want))


def record(proof, system, refute=False):
    from .methods import Outcome
    design = json.loads(Path(proof.rule.file).read_text())
    if not design["record"]:
        raise Failure("the function has no record")
    terms = Terms()
    unrolling, properties = Unrolling(system, terms, False), 0
    # The earliest sample, and one after whose record nothing of it is on its way any more.
    for later in (1, design["last_read"] + 2):
        contract, solver = Contract(unrolling, design, later), Solver(terms, proof.limit)
        solver.assume(*contract.assumed)
        if not solver.possible():
            raise Failure("the assumptions contradict each other")
        for name, cycle, step, want, condition in contract.wrong():
            properties += 1
            if solver.possible(condition):
                trace, number = trace_of(solver, unrolling, later + design["latency"] + 1), solver.number(want)
                got = trace.value(name, step)
                if got == number:
                    raise Failure("the counterexample does not replay")
                return Outcome(trace, name, f"{name}, cycle {cycle} of a sample {later} edges after its record: "
                               f"{got:x} for {number:x}\n")
    return Outcome(covered=[f"{len(design['record'])} fields"], properties=properties)
