"""./dev coverage: how much of each room the tests run, as Clang counts it. Without arguments every test runs and
docs/coverage.md is written; with names of test programs only these run, and the table is only printed."""

import argparse
import json
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
BUILD = ROOT / "build/coverage"
DOCUMENT = ROOT / "docs/coverage.md"
FIGURES = ("lines", "branches")
INTRODUCTION = (
    "# Coverage\n\n"
    "`./dev coverage` wrote this page: how much of the C++ of each room (`docs/architecture.md`) the tests run. Every "
    "test ran in a build by Clang that counts the lines and branches of the source; a branch is one of the two ways of "
    "a condition. A template counts with those of its arguments for which the tests run most of it. A process that a "
    "test kills leaves no counts. The Verilated hardware has a coverage of its own (`./dev cosim`).\n\n")
HEAD = "| room | lines | run | branches | run |\n|---|---:|---:|---:|---:|\n"


class Failure(Exception):
    pass


def run(*command):
    process = subprocess.run(command, capture_output=True, text=True)
    if process.returncode != 0:
        raise Failure(f"{' '.join(map(str, command[:3]))} ... failed:\n{process.stderr[-2000:]}")
    return process.stdout


def summary(profiles, programs):
    """llvm-cov's figures by file."""
    if not profiles or not programs:
        raise Failure("no program left counts: were the tests run in build/coverage?")
    merged = BUILD / "all.profdata"
    run("llvm-profdata", "merge", "-sparse", "-o", merged, *profiles)
    objects = [word for program in programs for word in ("-object", program)]
    return json.loads(run("llvm-cov", "export", "-summary-only", f"-instr-profile={merged}", *objects))


def all_programs():
    """The programs of the build. Those with deliberate faults are of other sources."""
    return [p for p in sorted((BUILD / "bin").iterdir()) if not p.name.endswith("_faults")]


def listed_rooms():
    """The rooms of the build in its order, but for those of the tests."""
    lines = [line.split() for line in (BUILD / "rooms.txt").read_text().splitlines()]
    return list(dict.fromkeys(words[0] for words in lines if len(words) == 2 and not words[0].startswith("tests/")))


def rooms_of(export, listed, root):
    """The figures of each room: name -> figure -> [count, covered]. A file belongs to the nearest room above it."""
    # A header is reached through links in the build's folder; of one that is reached by two, the greater figures count.
    files = {}
    for file in export["data"][0]["files"]:
        own = files.setdefault(Path(file["filename"]).resolve(), {figure: [0, 0] for figure in FIGURES})
        for figure in FIGURES:
            found = file["summary"][figure]
            own[figure] = [max(own[figure][0], found["count"]), max(own[figure][1], found["covered"])]
    rooms = {room: {figure: [0, 0] for figure in FIGURES} for room in listed}
    for path, own in files.items():
        parents = [str(p) for p in path.relative_to(root).parents] if path.is_relative_to(root) else []
        room = next((parent for parent in parents if parent in rooms), None)
        for figure in FIGURES if room else ():
            for k in (0, 1):
                rooms[room][figure][k] += own[figure][k]
    if not any(room["lines"][1] for room in rooms.values()):
        raise Failure("no line of any room was run")
    return rooms


def share(count, covered):
    return f"{100 * covered / count:.1f} %" if count else "-"


def table(rooms):
    total = {figure: [sum(room[figure][k] for room in rooms.values()) for k in (0, 1)] for figure in FIGURES}
    rows = [*((f"`{name}/`", room) for name, room in rooms.items()), ("all", total)]
    return HEAD + "".join(
        f"| {name} | " + " | ".join(f"{room[figure][0]:,} | {share(*room[figure])}" for figure in FIGURES) + " |\n"
        for name, room in rows)


def main(arguments):
    parser = argparse.ArgumentParser(prog="./dev coverage", description=__doc__)
    parser.add_argument("programs", nargs="*", metavar="PROGRAM", help="a test program, such as files_test")
    options = parser.parse_args(arguments)
    programs = [BUILD / "bin" / name for name in options.programs]
    try:
        export = summary(sorted((BUILD / "profiles").glob("*.profraw")), programs or all_programs())
        rooms = rooms_of(export, listed_rooms(), ROOT)
    except Failure as failure:
        print(f"coverage: {failure}", file=sys.stderr)
        return 1
    if programs:
        print(table({name: room for name, room in rooms.items() if room["lines"][0]}), end="")
        return 0
    DOCUMENT.write_text(INTRODUCTION + table(rooms))
    print(table(rooms), end="")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
