"""What the tests of the Python package share.

EMAX_PROGRAM and EMAX_PEER name the programs to compare with, EMAX_DATA the folder of the scans.
EMAX_FAULT=bytes makes the comparison of files see one changed byte, which a test has to notice.
"""

import os
import pathlib
import subprocess

import numpy as np
import pytest

PROGRAM = os.environ["EMAX_PROGRAM"]
PEER = os.environ["EMAX_PEER"]
DATA = pathlib.Path(os.environ["EMAX_DATA"])


def command(*words, folder):
    """Runs `emax`; its exit code has to be 0 or 2."""
    done = subprocess.run([PROGRAM, *map(str, words)], cwd=folder, capture_output=True, text=True)
    assert done.returncode in (0, 2), done.stderr
    return done


def file_bytes(path):
    found = pathlib.Path(path).read_bytes()
    if os.environ.get("EMAX_FAULT") == "bytes" and "command" in str(path):
        found = found[:-1] + bytes([found[-1] ^ 1])
    return found


def wave(size=40):
    """A wavy square: vertices and faces."""
    x, y = np.meshgrid(np.linspace(0, 1, size), np.linspace(0, 1, size))
    z = 0.05 * np.sin(6 * x) * np.cos(5 * y)
    corner = (np.arange(size - 1)[:, None] * size + np.arange(size - 1)).ravel()
    faces = np.stack([corner, corner + 1, corner + size + 1, corner, corner + size + 1, corner + size], axis=-1)
    return np.column_stack([x.ravel(), y.ravel(), z.ravel()]), faces.reshape(-1, 3).astype(np.uint32)


@pytest.fixture
def mesh():
    return wave()


@pytest.fixture
def mesh_file(tmp_path, mesh):
    path = tmp_path / "wave.off"
    vertices, faces = mesh
    lines = ["OFF", f"{len(vertices)} {len(faces)} 0"]
    lines += [" ".join(repr(float(c)) for c in row) for row in vertices]
    lines += ["3 " + " ".join(map(str, row)) for row in faces]
    path.write_text("\n".join(lines) + "\n")
    return path
