"""The parts of docs/benchmarks.md and its details that are measured on their own; each stands between two marks."""

import os
from pathlib import Path

DOCUMENT = Path("docs/benchmarks.md")
NAMES = ["error", "search", "scans", "decimation", "corpus", "surfaces", "features", "scale", "filter"]


def marks(name):
    return f"<!-- {name}: begin -->\n", f"<!-- {name}: end -->\n"


def marked(name, body):
    begin, end = marks(name)
    return begin + body + end


def text(file=DOCUMENT):
    return file.read_text() if file.exists() else ""


def existing(name, file=DOCUMENT):
    """The section with its marks, or nothing."""
    document, (begin, end) = text(file), marks(name)
    start, stop = document.find(begin), document.find(end)
    return document[start:stop + len(end)] if 0 <= start < stop else ""


def write(file, body):
    partial = file.with_suffix(".part")
    partial.write_text(body)
    os.replace(partial, file)


def put(name, body, file=None):
    """In place of the section that is there, else at the end."""
    file = file or DOCUMENT
    document, old, new = text(file), existing(name, file), marked(name, body)
    document = document.replace(old, new) if old else document.rstrip("\n") + "\n\n" + new
    write(file, document)


def kept():
    """What is to be put back when the rest of the document is written anew."""
    return {name: section for name in NAMES if (section := existing(name))}


def put_back(sections):
    for name, section in sections.items():
        begin, end = marks(name)
        put(name, section[len(begin):-len(end)])
