"""Drives netlists beside the model, so that nothing is written of a netlist that was not driven.

A program of testbench/netlists drives the netlist that hls/boards/netlists.py writes for it. This module
builds and runs the program, and compares the netlist that it drove with the one that is placed or
counted.
"""

import re
import subprocess
from pathlib import Path

from .tools import Failure

BUILD = Path("build/kernel")
VERDICT = re.compile(r"^netlist: .*[1-9][0-9]* .* 0 mismatches$|^fuzz: .* [1-9][0-9]* answers right, 0 wrong$", re.MULTILINE)


def drive(name, arguments=(), build=BUILD):
    """Builds and runs netlist_<name> and returns its verdict. Raises Failure where an answer was wrong."""
    log = build / f"netlist_{name}.log"
    with open(log, "w") as out:
        for command in (["cmake", "--build", build, "--target", f"netlist_{name}"],
                        [build / f"bin/netlist_{name}", *map(str, arguments)]):
            status = subprocess.run(command, stdout=out, stderr=subprocess.STDOUT, check=False).returncode
            out.flush()
            text = log.read_text(errors="replace")
            if status != 0:
                raise Failure("\n".join([*text.splitlines()[-12:], f"{name}: its netlist is not what its source is, or"
                                         f" could not be driven; the log is {log}"]))
    verdict = VERDICT.search(text)
    if verdict is None:
        raise Failure(f"{name}: no verdict in {log}")
    return verdict.group()


def holds(name, netlists, build=BUILD):
    """Raises Failure unless the driven file contains these netlists, renamed. It may contain sources too."""
    driven = build / f"netlists/{name}.v"
    text = driven.read_text()
    if not netlists or any(netlist not in text for netlist in netlists):
        raise Failure(f"{driven} is not the netlist that was placed; ./dev synth --fresh makes both anew")
