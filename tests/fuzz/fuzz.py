"""./dev fuzz: gives inputs of libFuzzer to every reader. The folder of a target in build/fuzz/ keeps
its corpus from run to run, and what was found."""

import argparse
import os
import re
import shutil
import subprocess
import sys
import tempfile
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

BUILD = Path("build/fuzz")
TARGETS = sorted(source.stem for source in (Path(__file__).parent / "targets").glob("*.cpp"))
FAULT = re.compile(r"^emax_fuzz\((\w+) .*\bFAULT\b", re.MULTILINE)
FAULT_SECONDS = 60  # a deliberate fault is found long before, on any machine
# The greatest input, and limits on what a reader may take for it: MB at once and in all, seconds.
LIMITS = ["-max_len=4096", "-malloc_limit_mb=64", "-rss_limit_mb=1024", "-timeout=20", "-report_slow_units=60"]
# A frame of Zstandard may ask for a window of 128 MiB.
LIMITS_OF = {"fuzz_compressed": ["-malloc_limit_mb=160"]}


class Failure(Exception):
    pass


def faulty_targets():
    return FAULT.findall((Path(__file__).parent / "CMakeLists.txt").read_text())


def duration(seconds):
    return f"{seconds / 60:.1f} min" if seconds >= 100 else f"{seconds:.0f} s"


class Session:
    """One run of a target's program. A fresh one knows nothing of earlier runs."""

    def __init__(self, program, seconds, options, scratch, fresh=False):
        self.program, self.folder = BUILD / "bin" / program, BUILD / program
        self.arguments = [f"-max_total_time={seconds}", f"-seed={options.seed}", *LIMITS,
                          *LIMITS_OF.get(program, [])]
        self.environment = {**os.environ, "TMPDIR": str(Path(scratch, program))}
        self.log = self.folder / "log"
        shutil.rmtree(self.folder if fresh else self.folder / "seeds", ignore_errors=True)

    def run(self):
        seeds, corpus, finds = (self.folder / name for name in ("seeds", "corpus", "finds"))
        for folder in (seeds, corpus, finds, Path(self.environment["TMPDIR"])):
            folder.mkdir(parents=True, exist_ok=True)
        with self.log.open("w") as log:
            self.call(log, f"--write-seeds={seeds}")
        if not any(seeds.iterdir()) or self.status != 0:
            raise Failure(f"{self.program} refuses one of its seeds; its output is in {self.log}")
        started = time.monotonic()
        with self.log.open("w") as log:
            self.call(log, corpus, seeds, f"-artifact_prefix={finds}/", "-print_final_stats=1", *self.arguments)
        self.took = time.monotonic() - started
        self.text = self.log.read_text(errors="replace")
        self.finds = sorted(set(re.findall(r"Test unit written to (\S+)", self.text)))
        self.inputs = self.last(r"stat::number_of_executed_units:\s+(\d+)")
        if (self.status == 0) == bool(self.finds) or not (self.inputs or self.finds):
            raise Failure(f"{self.program} ended with {self.status} after {self.inputs} inputs; "
                          f"its output is in {self.log}")
        self.edges, self.corpus = self.last(r"cov: (\d+)"), len(list(corpus.iterdir()))
        return self

    def call(self, log, *arguments):
        self.status = subprocess.run([self.program, *arguments], env=self.environment, stdout=log,
                                     stderr=subprocess.STDOUT).returncode

    def last(self, pattern):
        found = re.findall(pattern, self.text)
        return int(found[-1]) if found else 0

    def what(self):
        """The first line that tells what was found."""
        for pattern in (r"fuzz: this does not hold: .*", r"ERROR: \w+: .*", r".*runtime error: .*", r"terminate called.*"):
            if found := re.search(pattern, self.text):
                return found.group()
        return "no report"


def sessions(programs, seconds, options, scratch, fresh=False):
    """Runs the programs, so many at once, and gives each session when it and those before it ended."""
    with ThreadPoolExecutor(options.jobs) as pool:
        yield from pool.map(Session.run, [Session(p, seconds, options, scratch, fresh) for p in programs])


def plan(options):
    unknown = set(options.targets) - set(TARGETS)
    if unknown:
        raise Failure(f"no target {', '.join(sorted(unknown))}; there are: {', '.join(TARGETS)}")
    targets = options.targets or TARGETS
    seconds = int(options.minutes * 60 * options.jobs / len(targets))
    if seconds < 1:
        raise Failure(f"{options.minutes:g} minutes are too few for {len(targets)} targets; give a second to each")
    print(f"fuzz: {len(targets)} targets, {duration(seconds)} each, {options.jobs} at once, seed {options.seed}", flush=True)
    return targets, seconds


def check_faults(targets, options, scratch):
    """A harness that does not find the deliberate fault of a reader is broken."""
    faulty = [target for target in faulty_targets() if target in targets]
    programs = [f"fuzz_{target}_fault" for target in faulty]
    for target, session in zip(faulty, sessions(programs, FAULT_SECONDS, options, scratch, fresh=True)):
        if not session.finds:
            raise Failure(f"{target}: the deliberate fault was not found in {FAULT_SECONDS} s")
        print(f"fuzz: {target:<12} {duration(session.took):>8} to the deliberate fault: {session.what()}", flush=True)


def fuzz(targets, seconds, options, scratch):
    found = 0
    programs = [f"fuzz_{target}" for target in targets]
    for target, session in zip(targets, sessions(programs, seconds, options, scratch)):
        print(f"fuzz: {target:<12} seed {options.seed} {duration(session.took):>8} {session.inputs:>12,} inputs "
              f"{session.edges:>7,} edges {session.corpus:>6,} in the corpus {len(session.finds)} found", flush=True)
        for find in session.finds:
            found += 1
            print(f"fuzz: {target}: FOUND {session.what()}\n        input   {find}\n        report  {session.log}\n"
                  f"        replay  {session.program} {find}", flush=True)
    return found


def main(arguments):
    parser = argparse.ArgumentParser(prog="./dev fuzz", description=__doc__)
    parser.add_argument("--minutes", type=float, default=1, help="for all targets together (1)")
    parser.add_argument("--seed", type=int, default=1, help="of libFuzzer; another seed makes other inputs (1)")
    parser.add_argument("--jobs", type=int, default=os.cpu_count(), help="targets at once (the processors)")
    parser.add_argument("--plan", action="store_true", help="only tell what would be run")
    parser.add_argument("targets", nargs="*", metavar="TARGET", help=f"of {', '.join(TARGETS)} (all)")
    options = parser.parse_args(arguments)
    try:
        targets, seconds = plan(options)
        if options.plan:
            return 0
        # In memory where there is such a folder: a log is flushed to the disk again and again.
        memory = "/dev/shm" if os.access("/dev/shm", os.W_OK) else None
        with tempfile.TemporaryDirectory(prefix="emax_fuzz_", dir=memory) as scratch:
            check_faults(targets, options, scratch)
            found = fuzz(targets, seconds, options, scratch)
    except Failure as failure:
        print(f"fuzz: {failure}", file=sys.stderr)
        return 2
    print(f"fuzz: {found or 'nothing'} found")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
