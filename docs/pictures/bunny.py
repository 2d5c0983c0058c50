#!/usr/bin/env python3
"""Draws a scanned cloud beside the mesh made from it: bunny.py CLOUD.off MESH.ply OUT.png

Needs `pip install pyvista` (written with pyvista 0.49, VTK 9.7, Pillow 13) and no display. The
bound in the caption is read from MESH.ply.certificate.json, and every distance is checked by it.
"""
import argparse
import json

import numpy as np
import pyvista as pv
from PIL import Image, ImageDraw, ImageFont

WIDTH, HEIGHT, CAPTION = 640, 544, 56  # of one panel and the strip below it, in pixels
SAMPLES = 4  # rendered this much larger, then averaged: fine points and edges without moiré
EYE = np.array([-0.30, 0.22, 1.0]) / np.linalg.norm([-0.30, 0.22, 1.0])  # y is up
RIGHT = np.cross((0, 1, 0), EYE) / np.linalg.norm(np.cross((0, 1, 0), EYE))
UP = np.cross(EYE, RIGHT)


def read_off_points(path):
    with open(path, encoding="ascii") as file:
        words = file.read().split()
    if not words or words[0] != "OFF":
        raise SystemExit(f"{path}: not an OFF file")
    return np.array(words[4 : 4 + 3 * int(words[1])], dtype=float).reshape(-1, 3)


def panel(points, layers):
    """Renders the layers through the parallel camera that just holds all points."""
    size = (SAMPLES * WIDTH, SAMPLES * HEIGHT)
    plotter = pv.Plotter(off_screen=True, lighting="none", window_size=size)
    plotter.set_background("white")
    for position, intensity in ((-0.6, 0.7, 1.0), 0.68), ((0.9, -0.5, 0.8), 0.36):
        light = pv.Light(position=position, light_type="camera light", intensity=intensity)
        plotter.add_light(light)
    for data, style in layers:
        plotter.add_mesh(data, **style)
    axes = np.stack([RIGHT, UP, EYE])
    low, high = (points @ axes.T).min(axis=0), (points @ axes.T).max(axis=0)
    centre = (low + high) / 2 @ axes
    plotter.camera_position = [centre + 2 * np.linalg.norm(high - low) * EYE, centre, UP]
    plotter.enable_parallel_projection()
    half_width, half_height = (high - low)[:2] / 2
    plotter.camera.parallel_scale = 1.04 * max(half_height, half_width * HEIGHT / WIDTH)
    plotter.reset_camera_clipping_range()
    image = Image.fromarray(plotter.screenshot(return_img=True)).reduce(SAMPLES)
    plotter.close()
    return image


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    for name in "CLOUD", "MESH", "OUT":
        parser.add_argument(name)
    paths = parser.parse_args()
    points, mesh = read_off_points(paths.CLOUD), pv.read(paths.MESH)
    with open(paths.MESH + ".certificate.json", encoding="utf-8") as file:
        epsilon = json.load(file)["epsilon"]
    nearest = mesh.find_closest_cell(points, return_closest_point=True)[1]
    if np.linalg.norm(nearest - points, axis=1).max() > epsilon:
        raise SystemExit(f"{paths.MESH}: a point lies farther away than the certified {epsilon}")

    # A white mesh just behind the points hides those of the far side.
    hider = mesh.translate(-4 * epsilon * EYE)
    cloud_layers = [
        (hider, dict(color="white", lighting=False)),
        (points, dict(color="#1f5f96", lighting=False, point_size=1.6 * SAMPLES)),
    ]
    mesh_style = dict(color="#f7dcb4", ambient=0.3, smooth_shading=False, show_edges=True)
    mesh_style |= dict(edge_color="#6b4a2e", edge_opacity=0.55, line_width=0.5 * SAMPLES)
    bound = 100 * epsilon / np.ptp(points[:, 0])
    panels = {
        f"{len(points):,} scanned points": cloud_layers,
        f"{mesh.n_cells:,} triangles, every point within {bound:.3f} % of the width": [
            (mesh, mesh_style)
        ],
    }
    picture = Image.new("RGB", (WIDTH * len(panels), HEIGHT + CAPTION), "white")
    draw, font = ImageDraw.Draw(picture), ImageFont.load_default(size=21)
    for column, (caption, layers) in enumerate(panels.items()):
        picture.paste(panel(points, layers), (column * WIDTH, 0))
        place = ((column + 0.5) * WIDTH, HEIGHT + CAPTION / 2)
        draw.text(place, caption, fill="#222222", font=font, anchor="mm")
    picture.quantize(256, dither=Image.Dither.NONE).save(paths.OUT, optimize=True)


main()
