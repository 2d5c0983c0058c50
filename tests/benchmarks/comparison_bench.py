"""`./dev bench --comparison`: which files emax, CloudCompare, MeshLab, Open3D and gltfpack read and write, and what they do
with damaged ones. Runs each tool on each file and writes docs/comparison.md: two minutes.
"""

import json
import math
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import sections

HERE = Path("tests/benchmarks")
EMAX = Path("build/bench/bin/emax").absolute()
FOLDER = Path("build/bench/comparison").absolute()
DOCUMENT = Path("docs/comparison.md")
SECONDS = 60  # for one file
SAME = 1e-9  # of the coordinates
WRITTEN = [".ply", ".obj", ".stl", ".off", ".glb", ".3mf", ".dxf"]


class Refused(Exception):
    """The tool said that it cannot take the file."""


class Broken(Exception):
    """The tool was ended by a signal, or by the time limit."""


def call(*command):
    try:
        done = subprocess.run(list(map(str, command)), cwd=FOLDER, capture_output=True, text=True, errors="replace",
                              stdin=subprocess.DEVNULL, timeout=SECONDS, env={**os.environ, "QT_QPA_PLATFORM": "offscreen"})
    except subprocess.TimeoutExpired as late:
        raise Broken(f"hangs: not done after {SECONDS} s") from late
    if done.returncode < 0:
        raise Broken(f"crashes: signal {-done.returncode}")
    if done.returncode > 0:
        raise Refused((done.stderr.strip() or done.stdout.strip()).splitlines()[-1:] or ["no word"])
    return done.stdout


class Emax:
    name = "emax"

    def read(self, path, kind):
        answer = FOLDER / "answer.json"
        call(EMAX, "info", path, "--json", answer)
        told = json.loads(answer.read_text())
        return {"points": told["points"], "triangles": told["triangles"] or 0, "low": told["lower"], "high": told["upper"],
                "unit": told["unit"]}

    def write(self, mesh, output):
        call(EMAX, "decimate", mesh, "--max-error", "0.0001%", "-o", output)

    def version(self):
        return call(EMAX, "--version").strip()


class CloudCompare:
    name = "CloudCompare"

    def run(self, *options):
        said = call("CloudCompare", "-SILENT", "-AUTO_SAVE", "OFF", *options)
        if re.search(r"ERROR|[Ff]ailed", said):  # it ends with 0 all the same
            raise Refused([next(line for line in said.splitlines() if re.search(r"ERROR|[Ff]ailed", line))])
        return said

    def read(self, path, kind):
        for old in FOLDER.glob("cc_read*"):
            old.unlink()
        if kind == "cloud":
            self.run("-O", "-GLOBAL_SHIFT", "AUTO", path, "-C_EXPORT_FMT", "ASC", "-PREC", "12", "-SEP", "SPACE",
                     "-SAVE_CLOUDS", "FILE", FOLDER / "cc_read.asc")
            rows = [list(map(float, line.split()[:3])) for line in (FOLDER / "cc_read.asc").read_text().splitlines()]
            columns = list(zip(*rows))
            return {"points": len(rows), "triangles": 0, "low": list(map(min, columns)), "high": list(map(max, columns))}
        self.run("-O", path, "-M_EXPORT_FMT", "OFF", "-SAVE_MESHES", "FILE", FOLDER / "cc_read.off")
        words = (FOLDER / "cc_read.off").read_text().split()
        count, triangles = int(words[1]), int(words[2])
        columns = [list(map(float, words[4 + axis:4 + 3 * count:3])) for axis in range(3)]
        return {"points": count, "triangles": triangles, "low": list(map(min, columns)), "high": list(map(max, columns))}

    def write(self, mesh, output):
        self.run("-O", mesh, "-M_EXPORT_FMT", output.suffix[1:].upper(), "-SAVE_MESHES", "FILE", output)

    def version(self):
        return "CloudCompare " + subprocess.run(["dpkg-query", "-W", "-f", "${Version}", "cloudcompare"], check=True,
                                                capture_output=True, text=True).stdout + " of Debian"


class Library:
    def __init__(self, name, package, python):
        self.name, self.package, self.python = name, package, python.absolute()
        self.script = (HERE / "comparison/tools.py").absolute()

    def read(self, path, kind):
        said = call(self.python, "-B", self.script, self.name.lower(), "read", path, kind)
        return json.loads(said.strip().splitlines()[-1])

    def write(self, mesh, output):
        call(self.python, "-B", self.script, self.name.lower(), "write", mesh, output)

    def version(self):
        said = call(self.python, "-m", "pip", "show", self.package)
        return f"{self.package} {re.search(r'Version: (.*)', said)[1]}"


class Gltfpack:
    name = "gltfpack"

    def __init__(self, script, version):
        self.script, self.told = script.absolute(), version

    def read(self, path, kind):
        output, report = FOLDER / "gltfpack_read.glb", FOLDER / "gltfpack_read.json"
        for old in (output, report):
            old.unlink(missing_ok=True)
        # Without quantization, nodes merged, nothing removed.
        call("node", self.script, "-i", path, "-o", output, "-r", report, "-noq")
        return extent_of_glb(output)

    def write(self, mesh, output):
        call("node", self.script, "-i", mesh.with_suffix(".obj"), "-o", output, "-noq")

    def version(self):
        return f"gltfpack {self.told} of npm"


def extent_of_glb(path):
    data = path.read_bytes()
    length = int.from_bytes(data[12:16], "little")
    document = json.loads(data[20:20 + length])
    accessors = document.get("accessors", [])
    told = {"points": 0, "triangles": 0}
    for mesh in document.get("meshes", []):
        for primitive in mesh["primitives"]:
            position = accessors[primitive["attributes"]["POSITION"]]
            indices = primitive.get("indices")
            told["points"] += position["count"]
            told["triangles"] += (accessors[indices]["count"] if indices is not None else position["count"]) // 3
            told["low"], told["high"] = position["min"], position["max"]
    return told


def attempt(tool, path, kind):
    """What the tool has read, or None: it refused, or nothing was read that could be written. Raises Broken."""
    try:
        got = tool.read(path, kind)
    except (Refused, OSError, ValueError, KeyError, IndexError):
        return None
    return got if got["points"] > 0 else None


def reading(tool, path, expected):
    """A word for the table: what became of a sound file."""
    try:
        got = attempt(tool, path, expected["kind"])
    except Broken as why:
        return f"**{why}**"
    if got is None:
        return "–"
    if expected["triangles"] != got["triangles"] or (expected["kind"] == "cloud" and got["points"] != expected["points"]):
        return f"other: {got['points']} points, {got['triangles']} triangles"
    off = max(abs(a - b) for name in ("low", "high") for a, b in zip(expected[name], got[name]))
    scale = max(abs(value) for name in ("low", "high") for value in expected[name])
    word = "yes" if off <= SAME * scale else f"moved by {off:.2g}"
    if expected.get("unit") and tool.name == "emax":
        word += f", unit {got['unit']}" if got["unit"] == expected["unit"] else ", without its unit"
    return word


def refusal(tool, path, expected, readable):
    if not readable.get((tool.name, path.suffix)):
        return "does not read it"
    try:
        got = attempt(tool, path, expected["kind"])
    except Broken as why:
        return f"**{why}**"
    if got is None:
        return "refuses"
    return f"takes {got['points']} points" + (f", {got['triangles']} triangles" if got["triangles"] else "")


def writing(tool, ending, judges):
    mesh, output = FOLDER / "mesh.ply", FOLDER / f"written_{tool.name.lower()}{ending}"
    output.unlink(missing_ok=True)
    try:
        tool.write(mesh, output)
    except (Refused, Broken, StopIteration):
        return "–"
    if not output.exists():
        return "–"
    for judge in judges:
        if judge is not tool:
            try:
                if judge.read(output, "mesh")["triangles"] == 8:
                    return "yes"
            except (Refused, Broken, OSError, ValueError, KeyError, IndexError):
                continue
    return "a file that no other tool here reads"


def table(head, rows):
    return "\n".join(["| " + " | ".join(head) + " |", "|" + "---|" * len(head), *("| " + " | ".join(row) + " |" for row in rows), ""])


def has_report(tool):
    """The line on reports: what a run wrote, or what the tool's documents say."""
    if tool.name == "emax":
        page = FOLDER / "report.html"
        page.unlink(missing_ok=True)
        call(EMAX, "error", FOLDER / "cloud.xyz", FOLDER / "mesh.ply", "--report", page)
        return f"`--report`: an HTML page ({page.stat().st_size // 1000} kB here)"
    if tool.name == "gltfpack":
        return "`-r`: sizes and counts as JSON" if (FOLDER / "gltfpack_read.json").exists() else "–"
    return "none ¹"


SCRIPTS = {"emax": "command, C++ library, Python", "CloudCompare": "command; Python by other projects ¹",
           "MeshLab": "Python", "Open3D": "Python, C++ library ¹", "gltfpack": "command, JavaScript"}
UNITS = {"emax": "read, written, `--unit`, `--max-error 0.5mm`", "CloudCompare": "none ¹", "MeshLab": "none ¹",
         "Open3D": "none ¹", "gltfpack": "metres, as glTF defines ¹"}


def main(python, gltfpack, files_python):
    if python is None or gltfpack is None or not shutil.which("CloudCompare"):
        sys.exit("bench: CloudCompare, the tools from PyPI or gltfpack could not be installed; nothing is written")
    shutil.rmtree(FOLDER, ignore_errors=True)
    FOLDER.mkdir(parents=True)
    subprocess.run([files_python.absolute(), "-B", HERE / "comparison/inputs.py", FOLDER], check=True)
    inputs = json.loads((FOLDER / "inputs.json").read_text())
    tools = [Emax(), CloudCompare(), Library("MeshLab", "pymeshlab", python), Library("Open3D", "open3d-cpu", python), Gltfpack(*gltfpack)]
    head = ["", *(tool.name for tool in tools)]
    readable, parts = {}, {"clouds": [], "meshes": [], "bad": []}
    for name, expected in inputs.items():
        if expected["group"] == "bad":
            continue
        words = [reading(tool, FOLDER / name, expected) for tool in tools]
        for tool, word in zip(tools, words):
            readable[tool.name, Path(name).suffix] = word != "–"
        parts[expected["group"]].append([f"`{name}`", *words])
    for name, expected in inputs.items():
        if expected["group"] == "bad":
            parts["bad"].append([expected["what"], *(refusal(tool, FOLDER / name, expected, readable) for tool in tools)])
    judges = [tools[i] for i in (2, 3, 0, 1, 4)]
    written = [[f"`{ending}`", *(writing(tool, ending, judges) for tool in tools)] for ending in WRITTEN]
    counted = [sum(row[1 + i].startswith("takes") or row[1 + i].startswith("**") for row in parts["bad"]) for i in range(len(tools))]
    body = f"""# emax beside other tools

Written by `./dev bench --comparison`, which gives each file to each tool and compares what the tool has read with what the
file holds: {"; ".join(tool.version() for tool in tools)}. "–" means that the tool does not read or write the format. A
tool's other builds may have more plug-ins: CloudCompare's own builds read LAS, LAZ and E57 ¹, Debian's does not.

## Clouds read

1,000 points in metres of a national grid, told to the millimetre. "moved" is how far the cloud's extent is off.

{table(head, parts["clouds"])}
## Meshes read

{table(head, parts["meshes"])}
## Meshes written

"yes" means that another of these tools reads the same triangles from the file.

{table(head, written)}
## Damaged files

Each file is damaged in one way. "takes" means that the tool ends without an error and holds that much
of the file. Where a tool asks a person what to do, it hangs here.

{table(head, parts["bad"])}
Damaged files taken without an error, or that ended the tool: {", ".join(f"{tool.name} {n}" for tool, n in zip(tools, counted))}.

## What comes along

{table(head, [["report", *map(has_report, tools)], ["units", *(UNITS[tool.name] for tool in tools)], ["scripts", *(SCRIPTS[tool.name] for tool in tools)]])}
¹ Not run: from the tool's own documents.
"""
    sections.write(DOCUMENT, body)
    print(f"bench: {DOCUMENT} is written")
