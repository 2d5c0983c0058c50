"""Forms of the distance lowered into the build folder, and designs made of them."""

import json
import os
import subprocess
from pathlib import Path

from . import designs
from .tools import FOLDER, Failure

LOWER = Path(os.environ.get("EMAX_LOWER", "build/kernel/bin/emax_lower"))
FORMS = ["visible_edge", "three_edge", "barycentric"]


def lowered(form, family):
    """Lowers a form's unit for a family into the build folder; its sources and emax_lower's report."""
    folder = FOLDER / "lowered" / family
    folder.mkdir(parents=True, exist_ok=True)

    def lower(*options):
        run = subprocess.run([LOWER, form, "--family", family, *options], capture_output=True, text=True)
        if run.returncode != 0:
            raise Failure(f"{LOWER} {form} {' '.join(map(str, options))}: {run.stderr.strip()}")
        return run.stdout

    files = [folder / f"{form}.sv", folder / f"{form}_unit.sv"]
    lower("-o", files[0])
    lower("--unit", "-o", files[1])
    return files, json.loads(lower("--report"))


def form(name, target):
    """A form's unit for ECP5, and emax_lower's report on it."""
    files, report = lowered(name, "ecp5")
    return designs.Design(name, f"{report['module']}_unit", target, {"SLOT_BITS": 4}, files), report


def xilinx_element(target):
    """The element with the datapath lowered for AMD's families."""
    datapath, _ = lowered("visible_edge", "xilinx")
    reductions = [designs.GENERATED / f"emax_{name}.sv" for name in ("minimum", "maximum")]
    return designs.element(target, [*datapath, *reductions])
