#!/usr/bin/env python3
"""Puts the pages of two reports side by side: reports.py LEFT.html RIGHT.html OUT.png

Needs Debian's chromium and `pip install pillow` (written with Pillow 13), and no display.
"""
import subprocess
import sys
import tempfile
from pathlib import Path

from PIL import Image

WIDTH, HEIGHT = 1280, 1250  # of the window; the picture shows half of its pixels
COLOURS = 256


def page(report, folder):
    shot = Path(folder) / "page.png"
    subprocess.run(["chromium", "--headless", "--no-sandbox", "--use-gl=angle", "--use-angle=swiftshader",
                    "--enable-unsafe-swiftshader", "--hide-scrollbars", f"--window-size={WIDTH},{HEIGHT}",
                    "--virtual-time-budget=30000", f"--screenshot={shot}", Path(report).resolve().as_uri()],
                   check=True, stderr=subprocess.DEVNULL)
    return Image.open(shot).convert("RGB").resize((WIDTH // 2, HEIGHT // 2), Image.Resampling.LANCZOS)


def main():
    left, right, out = sys.argv[1:]
    both = Image.new("RGB", (WIDTH, HEIGHT // 2))
    with tempfile.TemporaryDirectory() as folder:
        both.paste(page(left, folder), (0, 0))
        both.paste(page(right, folder), (WIDTH // 2, 0))
    both.quantize(COLOURS, method=Image.Quantize.FASTOCTREE, kmeans=4, dither=Image.Dither.NONE).save(out, optimize=True)


main()
