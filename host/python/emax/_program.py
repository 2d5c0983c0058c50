"""The programs of the package: `emax`, and `emax_worker` beside it."""

from __future__ import annotations

import os
import sys
from pathlib import Path

from . import _core


def program(name: str = "emax") -> str:
    """The path of the program; :class:`emax.Error` where the package lacks it."""
    path = Path(__file__).parent / "bin" / name
    if not path.exists():  # a build tree links the sources
        path = Path(_core.__file__).parent / "bin" / name
    if not path.exists():
        raise _core.Error(f"{path}: missing; install the package again")
    return str(path)


def main() -> None:
    """The command `emax` of the environment that the package is installed in."""
    path = program()
    os.execv(path, [path, *sys.argv[1:]])
