"""The sources of a proof, with a fault where one is asked for, and the netlist that Yosys makes of them."""

import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

from synthesis.tools import CACHE, TOOLS, Failure

from .btor import System

RTL = Path("hls/rtl")
HARNESS = Path("hls/proofs/harness")
CELLS = Path("testbench/netlists/ecp5_blocks.sv")
ACTIVE = re.compile(r"^  int active .*= 0;$", re.MULTILINE)


def sources(family, replaced):
    """{file of a module: text}. A family's file replaces the behavioural file of the same name. A file of `replaced`,
    paths in the harness, replaces every file of the same name."""
    folders = [RTL / "behavioural", RTL, RTL / "core", RTL / "link", RTL / "sdram", RTL / "generated", RTL / "fixed", RTL / "filter/generated"]
    if family != "behavioural":
        folders.append(RTL / family)
    paths = {path.name: path for folder in folders for path in sorted(folder.glob("*.sv"))}
    paths |= {path.name: path for path in (HARNESS / name for name in replaced)}
    if family == "ecp5":
        paths[CELLS.name] = CELLS
    headers = {path.name: path for folder in (RTL, RTL / "generated") for path in folder.glob("*.svh")}
    return {name: path.read_text() for name, path in {**headers, **paths}.items()}


def with_fault(texts, fault):
    """The texts with a fault: a mutant of mutation.sv, or words of a file put in the place of others."""
    if fault is None:
        return texts
    if fault.mutant:
        chosen = re.search(rf"localparam int {fault.mutant} = (\d+);", texts["mutation.sv"])
        if chosen is None:
            raise Failure(f"hls/rtl/mutation.sv has no mutant {fault.mutant}")
        text, count = ACTIVE.subn(f"  localparam int active = {chosen[1]};", texts["mutation.sv"])
        if count != 1:
            raise Failure("hls/rtl/mutation.sv does not declare `active` as this reader knows it")
        return {**texts, "mutation.sv": text}
    file, old, new = fault.patch
    if file not in texts or texts[file].count(old) != 1:
        raise Failure(f"the fault '{fault.name}' wants to replace '{old}' in {file}, which does not stand there once")
    return {**texts, file: texts[file].replace(old, new)}


def script(proof, folder, names, mutated):
    parameters = " ".join(f"-chparam {name} {value}" for name, value in proof.parameters.items())
    defines = " -D EMAX_MUTATION" if mutated else ""
    files = " ".join(f"{folder}/{name}" for name in sorted(names, key=lambda name: (name != "mutation.sv", name))
                     if name.endswith(".sv"))
    return (f"read_verilog -formal -sv -defer{defines} -I {folder} {files}; "
            f"hierarchy -check -top {proof.top} {parameters}; proc; flatten; opt_expr -keepdc; opt_clean; "
            f"memory_collect; check -assert;{' memory_map;' * proof.spread} async2sync; dffunmap; opt_clean; "
            f"write_btor {folder}/netlist.btor")


def netlist(proof, folder, fault=None):
    """The System of a proof. All intermediate files are kept in the folder."""
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    texts = with_fault(sources(proof.family, proof.files), fault)
    for name, more in proof.watch:
        start, end, _ = texts[name].rpartition("endmodule")
        texts = {**texts, name: f"{start}{more}\n{end}\n"}
    for name, text in texts.items():
        (folder / name).write_text(text)
    run_yosys(script(proof, folder, texts, fault is not None and fault.mutant), folder / "yosys.log")
    return System((folder / "netlist.btor").read_text())


def run_yosys(commands, log):
    Path("build/proofs/tmp").mkdir(parents=True, exist_ok=True)
    environment = {**os.environ, "YOWASP_CACHE_DIR": str(CACHE.resolve()), "TMPDIR": str(Path("build/proofs/tmp").resolve())}
    with open(log, "wb") as out:
        status = subprocess.call([sys.executable, "-c", TOOLS["yosys"][1], "-q", "-p", commands],
                                 stdin=subprocess.DEVNULL, stdout=out, stderr=subprocess.STDOUT, env=environment)
    if status != 0:
        end = log.read_text(errors="replace").splitlines()[-8:]
        raise Failure("\n".join([*end, f"Yosys failed with status {status}; its log is {log}"]))
