"""Draws the curves that the benchmark program wrote as JSON, one SVG for each."""

import json
import sys
from pathlib import Path

import matplotlib
from cycler import cycler

matplotlib.use("svg")
# The same file for the same figures.
matplotlib.rcParams.update({"svg.hashsalt": "emax", "svg.fonttype": "none", "font.size": 9})

from matplotlib import pyplot, ticker


def draw(curve, file):
    many = len(curve["lines"]) > 5
    figure, axes = pyplot.subplots(figsize=(7.5, 4.2) if many else (6, 3.6), layout="constrained")
    # More lines than there are colours: the rest are dashed.
    axes.set_prop_cycle(cycler(linestyle=["-", "--"]) * cycler(color=pyplot.get_cmap("tab10").colors))
    for line in curve["lines"]:
        colour = axes.plot(line["at"], line["median"], marker="o", markersize=3, label=line["title"])[0].get_color()
        axes.fill_between(line["at"], line["least"], line["greatest"], color=colour, alpha=0.2, linewidth=0)
    axes.set(xscale="log", yscale="log", xlabel=curve["axis"], ylabel=curve["unit"])
    small = max(max(line["at"]) for line in curve["lines"]) < 1000
    for axis in (axes.xaxis, axes.yaxis) if small else (axes.yaxis,):
        axis.set_minor_locator(ticker.LogLocator(subs=(2, 5)))
        for tell in (axis.set_major_formatter, axis.set_minor_formatter):
            tell("{x:g}")
    axes.grid(which="major", alpha=0.4)
    if many:
        figure.legend(loc="outside right center", fontsize=8)
    else:
        axes.legend()
    figure.savefig(file, metadata={"Date": None, "Creator": None})


def main():
    curves, folder = Path(sys.argv[1]), Path(sys.argv[2])
    for curve in json.loads(curves.read_text()):
        if curve["lines"]:
            draw(curve, folder / f"{curve['name']}.svg")


if __name__ == "__main__":
    main()
