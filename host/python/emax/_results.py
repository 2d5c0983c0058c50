"""What the functions give back."""

from __future__ import annotations

import json
import os
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any, TypeVar

import numpy as np

from . import _core
from ._inputs import Path


class Interrupted(KeyboardInterrupt):
    """Ctrl-C. ``result`` is the best so far, or None where there is nothing yet."""

    def __init__(self, result: Any = None) -> None:
        super().__init__("interrupted; the best so far is in .result" if result is not None
                         else "interrupted; there is no result yet")
        self.result = result


@dataclass(frozen=True)
class Progress:
    """What a ``progress`` callback is given. What is not known yet is None."""

    phase: str
    share: float | None = None
    """Of the work of this phase."""
    triangles: int | None = None
    """Of the best mesh so far."""
    evaluations: int | None = None
    budget: int | None = None
    e_max: float | None = None
    seconds: float | None = None
    seconds_left: float | None = None


class Surface:
    """A triangle mesh: ``vertices`` are float64 rows x y z, ``faces`` uint32 rows of indices.

    The arrays share the memory of the result and cannot be written to; copy them to change them.
    """

    def __init__(self, vertices: np.ndarray, faces: np.ndarray) -> None:
        self.vertices = vertices
        self.faces = faces

    def __repr__(self) -> str:
        return f"<{type(self).__name__}: {len(self.vertices)} vertices, {len(self.faces)} faces>"

    def to_trimesh(self) -> Any:
        """The mesh as a ``trimesh.Trimesh``, with the vertices in this order."""
        import trimesh

        return trimesh.Trimesh(np.array(self.vertices), np.array(self.faces, dtype=np.int64), process=False)

    def to_open3d(self) -> Any:
        """The mesh as an ``open3d.geometry.TriangleMesh``."""
        import open3d  # type: ignore[import-not-found]

        return open3d.geometry.TriangleMesh(open3d.utility.Vector3dVector(self.vertices),
                                            open3d.utility.Vector3iVector(self.faces.astype(np.int32)))

    def to_pyvista(self) -> Any:
        """The mesh as a ``pyvista.PolyData``."""
        import pyvista  # type: ignore[import-not-found]

        corners = np.full((len(self.faces), 1), 3, dtype=np.int64)
        return pyvista.PolyData(np.array(self.vertices),
                                np.hstack([corners, self.faces.astype(np.int64)]).ravel())


class MeasuredSurface(Surface):
    """A mesh with its certified error from a cloud."""

    def __init__(self, made: Any, points: np.ndarray) -> None:
        super().__init__(made.vertices, made.faces)
        self._made = made
        self._points = points
        self.e_max: float = made.e_max
        """No point is farther than this from the mesh, proven."""

    @cached_property
    def distances(self) -> np.ndarray:
        """The distance of every point from the mesh, as ``emax.error`` gives it."""
        from ._measure import error

        return error(self._points, self).distances


class CertifiedMesh(MeasuredSurface):
    """The result of ``decimate`` and ``optimize``: a mesh and the proof of its error."""

    def __init__(self, made: Any, points: np.ndarray, interrupted: bool, report: dict[str, Any] | None = None) -> None:
        super().__init__(made, points)
        self.back: float | None = made.back
        """Under a two-sided bound: no part of the mesh is farther than this from the reference."""
        self.certificate: dict[str, Any] = json.loads(made.certificate)
        """What is certified. Names of files are those of ``save("mesh.ply")``."""
        self.interrupted = interrupted
        """Whether time or a callback ended the work early. The mesh keeps its bounds then too."""
        self.report = report
        """Of ``optimize``: what ``emax optimize --json`` writes."""

    @cached_property
    def reference(self) -> Surface | None:
        """The surface of a two-sided bound, unless it is the mesh that was given."""
        if not self._made.has_reference:
            return None
        return Surface(self._made.reference_vertices, self._made.reference_faces)

    def save(self, path: Path) -> None:
        """Writes the mesh, its certificate beside it, and what the certificate names.

        ``part.ply`` comes with ``part.ply.certificate.json``, ``part.ply.reference.ply`` where a
        two-sided bound has a reference of its own, and ``part.ply.cloud.ply`` where the points came
        as an array. All are written or none. ``emax verify`` checks them.
        """
        self._made.save(os.fspath(path))


class Reconstruction(MeasuredSurface):
    """The result of ``reconstruct``: the surface that fits a scan, before it is decimated."""

    def __init__(self, made: Any, points: np.ndarray) -> None:
        super().__init__(made, points)
        self.outliers = np.array(made.outliers, dtype=np.int64)
        """Indices of the points that were left out."""
        self.method: str = made.method
        """The method of reconstruction that was taken."""


@dataclass(frozen=True)
class ErrorReport:
    """The result of ``error``. Lengths are in the unit of the coordinates."""

    e_max: float
    """The greatest distance of a point that is not excluded, certified."""
    back: float | None
    """With ``two_sided``: the greatest distance of the mesh from the reference, certified."""
    worst_point: int
    distances: np.ndarray = field(repr=False)
    """Of every point, in the order of the cloud."""
    kept: bool | None
    """Whether the tolerance is kept; None where none was given."""
    exceeding: str
    """What is farther than the tolerance, in words; empty where nothing is."""
    report: dict[str, Any] = field(repr=False)
    """What ``emax error --json`` writes: mean, quantiles, histogram, worst points, validity, topology."""


@dataclass(frozen=True)
class Verification:
    """The result of ``verify``. It is true where the certificate holds."""

    holds: bool
    reasons: tuple[str, ...]
    """Why it does not hold."""
    e_max: float | None
    """As recomputed, where the check reached it."""

    def __bool__(self) -> bool:
        return self.holds


Made = TypeVar("Made")


def outcome(made: Made | None, stopped_by: BaseException | None) -> Made:
    """The result, or the exception that ended the work. A callback's StopIteration only ends it."""
    if isinstance(stopped_by, KeyboardInterrupt):
        raise Interrupted(made) from stopped_by
    if stopped_by is not None and not (isinstance(stopped_by, StopIteration) and made is not None):
        raise stopped_by
    assert made is not None
    return made
