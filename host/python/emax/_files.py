from __future__ import annotations

import os

import numpy as np

from . import _core
from ._inputs import Path
from ._results import Surface


def read_mesh(path: Path) -> Surface:
    """Reads a mesh in any format of emax, with every bit of its coordinates."""
    given = _core.mesh_of_file(os.fspath(path))
    return Surface(given.vertices, given.faces)


def read_cloud(path: Path, *, skip_invalid: bool = False) -> np.ndarray:
    """Reads a cloud in any format of emax, as float64 rows x y z that cannot be written to."""
    return _core.cloud_of_file(os.fspath(path), skip_invalid).points
