"""Imports the installed package, decimates and optimizes with it."""

import emax
import numpy as np

x, y = np.meshgrid(np.linspace(0, 1, 21), np.linspace(0, 1, 21))
corner = np.arange(20)[:, None] * 21 + np.arange(20)
faces = np.stack([corner, corner + 1, corner + 22, corner, corner + 22, corner + 21], axis=-1).reshape(-1, 3)
flat = emax.decimate((np.column_stack([x.ravel(), y.ravel(), 0 * x.ravel()]), faces), 0.01)
assert len(flat.faces) == 2, flat
turns = np.arange(900) * 2.399963
z = 1 - (2 * np.arange(900) + 1) / 900
ball = np.column_stack([np.cos(turns) * np.sqrt(1 - z * z), np.sin(turns) * np.sqrt(1 - z * z), z])
made = emax.optimize(ball, "2%", effort="quick", jobs=1)
assert made.e_max <= 0.04 and made.certificate["valid"], made
print(f"emax {emax.__version__} of {emax.__file__}: {len(flat.faces)} and {len(made.faces)} triangles")
