"""Draws the timing diagrams: each docs/pictures/timing_*.json of WaveDrom as an SVG beside it.

usage: pictures.py [--check]; with --check nothing is written, and a picture that is not of its source is a fault.
"""

import json
import sys
from pathlib import Path

import yowasp_wavedrom

PICTURES = Path(__file__).resolve().parents[1] / "pictures"
# WaveDrom's pictures follow the reader's system into the dark, which need not be what the page does.
DARK, WHITE = "@media(prefers-color-scheme:dark){:root{filter:invert(1)}}", ":root{background:white}"


def drawn(source):
    picture = yowasp_wavedrom.render(json.loads(source.read_text()))
    if DARK not in picture:
        sys.exit("WaveDrom has another style than the one that is replaced here")
    return picture.replace(DARK, WHITE) + "\n"


sources = sorted(PICTURES.glob("timing_*.json"))
if not sources:
    sys.exit(f"no timing diagrams in {PICTURES}")
for source in sources:
    picture = source.with_suffix(".svg")
    if "--check" not in sys.argv:
        picture.write_text(drawn(source))
    elif not picture.exists() or picture.read_text() != drawn(source):
        sys.exit(f"{picture} is not of {source.name}: draw it with ./dev docs --pictures")
