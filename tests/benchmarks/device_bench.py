"""`./dev bench --devices`: pairs of a point and a triangle a second, for every device that this
machine has and for boards by the model's prediction, in two minutes; writes the section "Pairs a
second" of docs/datasheet.md.
"""

import json
import subprocess
import sys
from pathlib import Path

import sections

PROGRAM = Path("build/bench/bin/emax_device_benchmark")
DATASHEET = Path("docs/datasheet.md")
CPU_INFO = Path("/proc/cpuinfo")


def processor(text):
    """The model's name as Linux gives it."""
    names = [line.split(":", 1)[1].strip() for line in text.splitlines() if line.startswith("model name")]
    return f"{names[0]}, {len(names)} threads" if names else "a processor without a name"


def rate(pairs_per_second):
    return f"{pairs_per_second / 1e9:.3g}"


def line(row):
    link = row.get("pairs_per_second_with_link", row["pairs_per_second"])
    return f"| `{row['device']}` | {row['hardware']} | {rate(row['pairs_per_second'])} | {rate(link)} | {row['kind']} |\n"


def body(result, machine):
    return ("## Pairs a second\n\n"
            f"Every pair of {result['points']} points and {result['triangles']} triangles in blocks of 1,024 points; all devices gave the same bits. "
            f"Measured on {machine}: the fastest of nine rounds. Estimated: the cycles of the model at the board's assumed clock and number of elements "
            "([boards](boards.md)), alone and with the link where that takes longer. `./dev bench --devices` writes this section.\n\n"
            "| device | hardware | computing, 10⁹ pairs/s | with the link | |\n|---|---|---|---|---|\n"
            + "".join(line(row) for row in result["rows"]))


def main():
    done = subprocess.run([PROGRAM], stdout=subprocess.PIPE, text=True)
    if done.returncode != 0:
        sys.exit("bench: the devices could not be measured")
    sections.put("devices", body(json.loads(done.stdout), processor(CPU_INFO.read_text())), DATASHEET)
