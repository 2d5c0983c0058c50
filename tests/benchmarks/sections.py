"""The parts of docs/benchmarks.md that are measured on their own; each stands between two marks."""

import os
from pathlib import Path

DOCUMENT = Path("docs/benchmarks.md")
NAMES = ["error", "search", "scans", "decimation"]


def marks(name):
    return f"<!-- {name}: begin -->\n", f"<!-- {name}: end -->\n"


def text():
    return DOCUMENT.read_text() if DOCUMENT.exists() else ""


def existing(name):
    """The section with its marks, or nothing."""
    document, (begin, end) = text(), marks(name)
    start, stop = document.find(begin), document.find(end)
    return document[start:stop + len(end)] if 0 <= start < stop else ""


def write(file, body):
    partial = file.with_suffix(".part")
    partial.write_text(body)
    os.replace(partial, file)


def put(name, body):
    """In place of the section that is there, else at the end."""
    begin, end = marks(name)
    document, old, new = text(), existing(name), begin + body + end
    document = document.replace(old, new) if old else document.rstrip("\n") + "\n\n" + new
    write(DOCUMENT, document)


def kept():
    """What is to be put back when the rest of the document is written anew."""
    return {name: section for name in NAMES if (section := existing(name))}


def put_back(sections):
    for name, section in sections.items():
        begin, end = marks(name)
        put(name, section[len(begin):-len(end)])
