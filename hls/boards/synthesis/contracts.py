"""The assertions of hls/rtl, read by Yosys as properties (hls/rtl/asserted.svh)."""

import json
import re

from . import designs
from .tools import Failure


def board():
    """A design that contains every module with an assertion."""
    more = [path for folder in ("core", "link") for path in sorted((designs.RTL / folder).glob("*.sv"))]
    return designs.Design("assertions", "emax_board", 0, more=more)


def script(design):
    files = " ".join(map(str, design.sources("behavioural")))
    return (f"read_verilog -sv -formal -I{designs.RTL} -I{designs.GENERATED} {files}; "
            f"hierarchy -check -top {design.top}; proc; write_json {{folder}}/assertions.json")


def written(sources):
    """{path: number of assertions in its text}."""
    counts = {str(path): len(re.findall(r"^[^/\n]*`ASSERT\(", path.read_text(), re.MULTILINE)) for path in sources}
    return {path: count for path, count in counts.items() if count}


def read(netlist):
    """{path: number of its places that have an assertion in Yosys's netlist}."""
    places = set()
    for module in json.loads(netlist.read_text())["modules"].values():
        for cell in module["cells"].values():
            if cell["type"] == "$assert" or cell["parameters"].get("FLAVOR", "").strip() == "assert":
                places.add(cell["attributes"]["src"])
    paths = [place.partition(":")[0] for place in places]
    return {path: paths.count(path) for path in paths}


def check(runner):
    """Raises Failure where Yosys does not see each assertion."""
    design = board()
    (netlist,) = runner.step("yosys", "the assertions of hls/rtl, read as properties", "assertions",
                             ["-q", "-p", script(design)], design.inputs("behavioural"), ["assertions.json"])
    compare(written(design.sources("behavioural")), read(netlist))


def compare(texts, properties):
    if not texts:
        raise Failure("hls/rtl has no assertion")
    for path in {**texts, **properties}:
        if texts.get(path, 0) != properties.get(path, 0):
            raise Failure(f"{path} has {texts.get(path, 0)} assertions, of which Yosys reads {properties.get(path, 0)};"
                          " `ASSERT of hls/rtl/asserted.svh is what it can read")
