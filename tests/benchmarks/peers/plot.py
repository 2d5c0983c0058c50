"""Draws the curves that the benchmark program wrote as JSON, one SVG for each."""

import json
import sys
from pathlib import Path

import matplotlib

matplotlib.use("svg")
# The same file for the same figures.
matplotlib.rcParams.update({"svg.hashsalt": "emax", "svg.fonttype": "none", "font.size": 9})

from matplotlib import pyplot, ticker


def draw(curve, file):
    figure, axes = pyplot.subplots(figsize=(6, 3.6), layout="constrained")
    for line in curve["lines"]:
        colour = axes.plot(line["at"], line["median"], marker="o", markersize=3, label=line["title"])[0].get_color()
        axes.fill_between(line["at"], line["least"], line["greatest"], color=colour, alpha=0.2, linewidth=0)
    axes.set(xscale="log", yscale="log", xlabel=curve["axis"], ylabel=curve["unit"])
    axes.yaxis.set_minor_locator(ticker.LogLocator(subs=(2, 5)))
    for tell in (axes.yaxis.set_major_formatter, axes.yaxis.set_minor_formatter):
        tell("{x:g}")
    axes.grid(which="major", alpha=0.4)
    axes.legend()
    figure.savefig(file, metadata={"Date": None, "Creator": None})


def main():
    curves, folder = Path(sys.argv[1]), Path(sys.argv[2])
    for curve in json.loads(curves.read_text()):
        if curve["lines"]:
            draw(curve, folder / f"{curve['name']}.svg")


if __name__ == "__main__":
    main()
