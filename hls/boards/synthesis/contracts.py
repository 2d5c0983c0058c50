"""The assertions of hls/rtl, read by Yosys as properties (hls/rtl/asserted.svh)."""

import json
import re

from . import designs
from .tools import Failure


def all_designs():
    """Designs that together contain every module with an assertion."""
    folders = [*(designs.RTL / name for name in ("core", "link", "board")), *designs.FILTER]
    more = [path for folder in folders for path in sorted(folder.glob("*.sv"))]
    return [designs.Design("board", "emax_board", 0, more=more), designs.filter_core(1, 0)]


def script(design):
    files = " ".join(map(str, design.sources("behavioural")))
    return (f"read_verilog -sv -formal -I{designs.RTL} -I{designs.GENERATED} {files}; "
            f"hierarchy -check -top {design.top}; proc; write_json {{folder}}/assertions.json")


def written(sources):
    """{path: number of assertions in its text}."""
    counts = {str(path): len(re.findall(r"^[^/\n]*`ASSERT\(", path.read_text(), re.MULTILINE)) for path in sources}
    return {path: count for path, count in counts.items() if count}


def read(*netlists):
    """{path: number of its places that have an assertion in one of Yosys's netlists}."""
    places = set()
    modules = [module for netlist in netlists for module in json.loads(netlist.read_text())["modules"].values()]
    for module in modules:
        for cell in module["cells"].values():
            if cell["type"] == "$assert" or cell["parameters"].get("FLAVOR", "").strip() == "assert":
                places.add(cell["attributes"]["src"])
    paths = [place.partition(":")[0] for place in places]
    return {path: paths.count(path) for path in paths}


def check(runner):
    """Raises Failure where Yosys does not see each assertion."""
    netlists, sources = [], set()
    for design in all_designs():
        netlists += runner.step("yosys", f"the assertions of the {design.top}, read as properties",
                                f"assertions/{design.top}", ["-q", "-p", script(design)],
                                design.inputs("behavioural"), ["assertions.json"])
        sources.update(design.sources("behavioural"))
    compare(written(sources), read(*netlists))


def compare(texts, properties):
    if not texts:
        raise Failure("hls/rtl has no assertion")
    for path in {**texts, **properties}:
        if texts.get(path, 0) != properties.get(path, 0):
            raise Failure(f"{path} has {texts.get(path, 0)} assertions, of which Yosys reads {properties.get(path, 0)};"
                          " `ASSERT of hls/rtl/asserted.svh is what it can read")
