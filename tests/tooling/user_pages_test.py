"""The examples of docs/user/ print what the pages show.

usage: user_pages_test.py EMAX [--fault]. A line `    emax ...` and the fenced block behind it are a command and what
it prints; `...` stands for any lines. With --fault a figure of a page is changed, which has to be noticed.

The example of optimize.md takes minutes, and its result depends on the C library's functions for this processor; it is
not run here.
"""

import os
import re
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
PAGES = ["decimate", "error", "verify", "report", "features", "info", "config"]  # in this order: each reads what those before it wrote
VARYING = r"\d+(\.\d+)? s$|\w+ instructions in .*"  # times, and what this processor has


def examples(text):
    """[(command, lines)]"""
    found = re.findall(r"^    emax (.*)\n\n```\n(.*?)^```$", text, re.MULTILINE | re.DOTALL)
    return [(command, [re.sub(VARYING, "", line) for line in block.splitlines()]) for command, block in found]


def first_difference(shown, printed):
    """The first line that is shown and not printed, if any."""
    gap = False
    for line in shown:
        if line == "...":
            gap = True
            continue
        while gap and printed and printed[0] != line:
            printed = printed[1:]
        if not printed or printed[0] != line:
            return line
        printed, gap = printed[1:], False
    return None if gap or not printed else printed[0]


def main():
    emax, fault = str(Path(sys.argv[1]).resolve()), "--fault" in sys.argv
    checked = 0
    with tempfile.TemporaryDirectory() as folder:
        os.symlink(ROOT / "data", Path(folder) / "data")
        for page in PAGES:
            text = (ROOT / f"docs/user/{page}.md").read_text()
            for command, shown in examples(text.replace("928", "929") if fault else text):
                printed = subprocess.run([emax, *command.split()], cwd=folder, stdout=subprocess.PIPE, text=True).stdout
                different = first_difference(shown, [re.sub(VARYING, "", line) for line in printed.splitlines()])
                if different is not None:
                    sys.exit(f"docs/user/{page}.md: emax {command}: page and program differ at: {different}\n{printed}")
                checked += 1
    print(f"user pages: {checked} examples are what the program prints")


main()
