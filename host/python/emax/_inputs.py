"""What the functions take: arrays, files and the objects of other packages, by what they have."""

from __future__ import annotations

import os
from typing import Any, TypeGuard, Union

import numpy as np

from . import _core

Path = Union[str, "os.PathLike[str]"]
MeshLike = Any
"""A path, a pair (vertices, faces), a result of emax, or a mesh of trimesh, Open3D or PyVista."""
CloudLike = Any
"""A path, an array of n rows x y z, or a cloud of trimesh, Open3D or PyVista."""
Length = Union[float, str]
"""A number in the unit of the coordinates, or text as the command takes it: ``"0.2%"``, ``"0.5mm"``."""


def points_of(value: Any, name: str) -> np.ndarray:
    """The rows as float64 in C order; the array itself where it is that already."""
    array = np.asarray(value)
    if array.dtype.kind not in "fiu":
        raise ValueError(f"{name}: numbers are needed, not {array.dtype}")
    if array.ndim != 2 or array.shape[1] != 3:
        raise ValueError(f"{name}: an array of shape (n, 3) is needed, not {array.shape}")
    if len(array) == 0:
        raise ValueError(f"{name}: no points")
    points = np.ascontiguousarray(array, dtype=np.float64)
    finite = np.isfinite(points).all(axis=1)
    if not finite.all():
        raise ValueError(f"{name}: point {int(np.argmin(finite))} is not finite; leave it out")
    return points


def faces_of(value: Any, name: str) -> np.ndarray:
    """The rows as uint32 in C order; the array itself where it is that already."""
    array = np.asarray(value)
    if array.dtype.kind not in "iu":
        raise ValueError(f"{name}: whole numbers are needed as indices, not {array.dtype}")
    if array.ndim != 2 or array.shape[1] != 3:
        raise ValueError(f"{name}: an array of shape (m, 3) is needed, not {array.shape}; "
                         "cut polygons into triangles first")
    if len(array) == 0:
        raise ValueError(f"{name}: no triangles")
    if array.min() < 0 or array.max() > np.iinfo(np.uint32).max:
        raise ValueError(f"{name}: an index is below 0 or above 4294967295")
    return np.ascontiguousarray(array, dtype=np.uint32)


def is_path(value: Any) -> TypeGuard[Path]:
    return isinstance(value, (str, os.PathLike))


def _pyvista_faces(mesh: Any) -> Any:
    """PyVista gives the faces in one row, each with the number of its corners in front."""
    padded = np.asarray(mesh.faces)
    if padded.ndim != 1:
        return padded
    if len(padded) % 4 != 0 or not (padded[::4] == 3).all():
        raise ValueError("mesh: faces that are not triangles; call triangulate() first")
    return padded.reshape(-1, 4)[:, 1:]


def _parts_of(mesh: Any, name: str) -> tuple[Any, Any]:
    if isinstance(mesh, (tuple, list)) and len(mesh) == 2:
        return mesh[0], mesh[1]
    if hasattr(mesh, "points") and hasattr(mesh, "faces"):
        return mesh.points, _pyvista_faces(mesh)
    if hasattr(mesh, "vertices"):
        for faces in ("faces", "triangles"):
            if hasattr(mesh, faces):
                return mesh.vertices, getattr(mesh, faces)
    raise ValueError(f"{name}: a path, a pair (vertices, faces) or a mesh of trimesh, Open3D or "
                     f"PyVista is needed, not {type(mesh).__name__}")


def given_mesh(mesh: MeshLike, name: str = "mesh") -> _core.GivenMesh:
    if isinstance(mesh, _core.GivenMesh):
        return mesh
    if is_path(mesh):
        return _core.mesh_of_file(os.fspath(mesh))
    vertices, faces = _parts_of(mesh, name)
    return _core.mesh_of_arrays(points_of(vertices, f"{name}: vertices"),
                                faces_of(faces, f"{name}: faces"))


def given_cloud(cloud: CloudLike, name: str = "cloud", skip_invalid: bool = False) -> _core.GivenCloud:
    if isinstance(cloud, _core.GivenCloud):
        return cloud
    if is_path(cloud):
        return _core.cloud_of_file(os.fspath(cloud), skip_invalid)
    for rows in ("points", "vertices"):
        if hasattr(cloud, rows):
            cloud = getattr(cloud, rows)
            break
    points = np.asarray(cloud)
    if skip_invalid and points.ndim == 2 and points.dtype.kind == "f":
        points = points[np.isfinite(points).all(axis=1)]
    return _core.cloud_of_array(points_of(points, name))


def is_mesh_like(value: Any) -> bool:
    """Whether a reference is a surface, and not a cloud."""
    if is_path(value):
        return _core.is_surface(os.fspath(value))
    return (isinstance(value, (tuple, list)) and len(value) == 2) or any(
        hasattr(value, name) and np.size(getattr(value, name)) > 0 for name in ("faces", "triangles"))


def length_text(length: Length | None, name: str) -> str:
    """The text that the command takes for a length; every bit of a float is in it."""
    if length is None:
        return ""
    if isinstance(length, str):
        return length
    number = float(length)
    if not (number > 0 and np.isfinite(number)):
        raise ValueError(f"{name}: a positive number is needed, not {length}")
    return repr(number)


def share_text(share: float | str) -> str:
    return share if isinstance(share, str) else repr(float(share))


def one_of(value: str, choices: tuple[str, ...], name: str) -> str:
    if value not in choices:
        raise ValueError(f"{name}: one of {', '.join(choices)} is needed, not {value!r}")
    return value
