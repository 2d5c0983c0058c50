"""`./dev prove`: proves what hls/proofs/table.py lists, and shows that each of its faults refutes its proof.

Run in the root of the project. Each proof runs in a process of its own. Its folder build/proofs/NAME gets the files that
the proof was made of, and for each fault a counterexample in words (counterexample.txt) and as a waveform
(counterexample.vcd).
"""

import argparse
import json
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

sys.path[:0] = [str(Path(__file__).resolve().parent), str(Path(__file__).resolve().parents[1] / "boards")]
from synthesis.tools import Failure, minutes  # noqa: E402

FOLDER = Path("build/proofs")
DOCUMENT = Path("docs/proofs.md")
SPARE = 120  # seconds that a worker has beyond its solver's limit


def arguments():
    parser = argparse.ArgumentParser(prog="./dev prove", description="Proves the hardware with Yosys and Bitwuzla.")
    which = parser.add_mutually_exclusive_group()
    which.add_argument("--quick", action="store_true", help="only the proofs that take seconds, as the tests run them")
    which.add_argument("--only", metavar="NAME", action="append", default=[], help="only this proof; may be repeated")
    which.add_argument("--lowered", metavar="FOLDER", help="only that the pipeline of a lowered function, in its folder, is its graph")
    parser.add_argument("--list", action="store_true", help="list the proofs and stop")
    parser.add_argument("--fault", action="store_true", help="only the faults, with their counterexamples")
    parser.add_argument("--jobs", metavar="N", type=int, default=os.cpu_count(), help="number of proofs at a time")
    parser.add_argument("--lower", metavar="PROGRAM", help="path of emax_lower, where it is not that of build/kernel")
    parser.add_argument("--plan", action="store_true", help=argparse.SUPPRESS)
    parser.add_argument("--worker", metavar="NAME", help=argparse.SUPPRESS)
    chosen = parser.parse_args()
    if chosen.jobs < 1:
        parser.error("--jobs: at least 1")
    return chosen


def proofs(chosen):
    from table import PROOFS
    known = {proof.name: proof for proof in PROOFS}
    for name in chosen.only:
        if name not in known:
            raise Failure(f"no proof '{name}'; there are: {', '.join(known)}")
    return [proof for proof in PROOFS if (proof.name in chosen.only or not chosen.only) and (proof.quick or not chosen.quick)]


def worker(name, faults_alone):
    """Runs one proof and prints its result as JSON, for judge()."""
    from proving import prover
    from table import PROOFS
    (proof,) = [proof for proof in PROOFS if proof.name == name]
    print(json.dumps(prover.run(proof, FOLDER / name, faults_alone)))
    return 0


def prove_lowered(folder):
    """Proves a lowered function; its counterexamples come into build/proofs/lowered_NAME."""
    from proving import lowered, prover
    from table import FIXED_OPERATORS, OPERATORS
    pipeline = lowered.proof_of(folder, (*OPERATORS, *FIXED_OPERATORS))
    for proof in (pipeline, lowered.unit_proof_of(folder, pipeline)):
        if proof is None:
            continue
        print(lowered.plan(proof), flush=True)
        holds, line = lowered.sentence(proof, prover.run(proof, FOLDER / f"lowered_{proof.name}"))
        print(line, flush=True)
        if not holds:
            return 1
    return 0


class Work:
    """Runs workers, at most `jobs` at a time, and ends them all when it ends."""

    def __init__(self, chosen, start):
        self.chosen, self.start, self.running = chosen, start, {}

    def say(self, text):
        print(f"prove {minutes(time.monotonic() - self.start):>5}  {text}", flush=True)

    def launch(self, proof):
        folder = FOLDER / proof.name
        folder.mkdir(parents=True, exist_ok=True)
        command = [sys.executable, "-B", __file__, "--worker", proof.name]
        command += ["--fault"] if self.chosen.fault else []
        command += ["--lower", self.chosen.lower] if self.chosen.lower else []
        with open(folder / "result.json", "wb") as out, open(folder / "errors.log", "wb") as errors:
            process = subprocess.Popen(command, stdin=subprocess.DEVNULL, stdout=out, stderr=errors)
        self.running[process] = (proof, time.monotonic())

    def finished(self):
        """Waits for a worker to end; its (proof, result)."""
        last = time.monotonic()
        while True:
            for process, (proof, began) in list(self.running.items()):
                if process.poll() is not None:
                    del self.running[process]
                    return proof, judge(process.returncode, FOLDER / proof.name)
                if time.monotonic() - began > (1 + len(proof.faults)) * proof.limit + SPARE:
                    process.kill()
            time.sleep(0.05)
            if time.monotonic() - last > 20:
                last = time.monotonic()
                for proof, began in self.running.values():
                    self.say(f"{proof.name}: under way for {minutes(last - began)}")

    def stop(self):
        for process in self.running:
            process.kill()
            process.wait()


def judge(status, folder):
    """The result of a worker. A worker without a result is a failed proof."""
    try:
        result = json.loads((folder / "result.json").read_text())
    except ValueError:
        result = None
    if status != 0 or not isinstance(result, dict):
        errors = (folder / "errors.log").read_text(errors="replace").strip().splitlines()
        return {"failure": f"its process ended with status {status}{': ' + errors[-1] if errors else ''}", "faults": []}
    return result


def verdict(proof, result, faults_alone=False):
    """The faults of a result, as a list of sentences; empty for a proof that counts."""
    if result.get("failure"):
        return [result["failure"]]
    wrong = []
    if not faults_alone:
        if result.get("holds") is not True:
            wrong.append(f"refuted: {result.get('how', 'no reason given')}")
        elif not result.get("covered") or not result.get("properties"):
            wrong.append("nothing shows that it could fail")
    told = {fault["name"]: fault for fault in result.get("faults", [])}
    for fault in proof.faults:
        one = told.get(fault.name, {})
        if one.get("refuted") is not True:
            wrong.append(f"the fault {fault.name} does not refute it" + (f": {one['failure']}" if one.get("failure") else ""))
    if not proof.faults:
        wrong.append("it has no fault that refutes it")
    return wrong


def main():
    chosen = arguments()
    if chosen.worker:
        if chosen.lower:
            from proving import graph
            graph.lower_program = Path(chosen.lower)
        return worker(chosen.worker, chosen.fault)
    if chosen.lowered:
        return prove_lowered(chosen.lowered)
    todo = proofs(chosen)
    if chosen.list:
        for proof in todo:
            print(f"{proof.name:24} {'' if proof.quick else '(not in --quick) '}{proof.what}")
        return 0
    if chosen.plan:
        slow = [proof.name for proof in todo if not proof.quick]
        print(f"prove: {len(todo)} proofs and {sum(len(p.faults) for p in todo)} faults that must refute them, {chosen.jobs} at a time; "
              + ("a quarter of an hour on two cores, of which most is " + ", ".join(slow) if slow else "a minute or two"))
        return 0
    return run(chosen, todo)


def run(chosen, todo):
    start = time.monotonic()
    work, results, failed = Work(chosen, start), {}, []
    waiting = sorted(todo, key=lambda proof: proof.quick)  # the long ones first
    try:
        while waiting or work.running:
            while waiting and len(work.running) < chosen.jobs:
                work.launch(waiting.pop(0))
            proof, result = work.finished()
            results[proof.name] = result
            wrong = verdict(proof, result, chosen.fault)
            failed += [proof.name] if wrong else []
            refuted = sum(fault.get("refuted") is True for fault in result["faults"])
            work.say(f"{proof.name}: " + ("; ".join(wrong) if wrong else
                     ("" if chosen.fault else f"proven by {result['method']}, {result['depth']}, in {result['seconds']:.1f} s; ")
                     + f"{refuted} of {len(proof.faults)} faults refute it"))
            if chosen.fault:
                for fault in result["faults"]:
                    print(f"\n{proof.name}, {fault['name']}: {fault.get('waveform', 'no waveform')}\n{fault.get('text', '')}")
    finally:
        work.stop()
    faults = sum(len(proof.faults) for proof in todo)
    if failed:
        work.say(f"{len(failed)} of {len(todo)} failed: {', '.join(failed)}; their files are in {FOLDER}")
        return 1
    work.say(f"{len(todo)} proofs hold" * (not chosen.fault) + ", " * (not chosen.fault) + f"{faults} faults refute them")
    if not (chosen.quick or chosen.only or chosen.fault):
        from proving import document
        document.write(DOCUMENT, todo, results)
        work.say(f"wrote {DOCUMENT}")
    return 0


if __name__ == "__main__":
    signal.signal(signal.SIGTERM, lambda *_: signal.raise_signal(signal.SIGINT))
    try:
        sys.exit(main())
    except Failure as failure:
        sys.exit(f"prove: {failure}")
    except KeyboardInterrupt:
        sys.exit("prove: stopped")
