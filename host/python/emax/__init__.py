"""Meshes of laser scans with as few triangles as possible, under a certified maximum error.

``decimate`` reduces a mesh, ``optimize`` makes one of a scan, ``reconstruct`` gives the surface that
fits a scan, ``error`` measures, ``verify`` checks a certificate, and ``minimize`` is the optimizer,
Genocop III, for functions of one's own. Arrays go in and come out; files and the objects of trimesh,
Open3D and PyVista do too.
"""

from ._core import Error
from ._core import version as __version__
from ._decimate import decimate
from ._files import read_cloud, read_mesh
from ._measure import error, verify
from ._minimize import OptimizeResult, minimize
from ._optimize import optimize, reconstruct
from ._results import (CertifiedMesh, ErrorReport, Interrupted, MeasuredSurface, Progress, Reconstruction,
                       Surface, Verification)

__all__ = [
    "CertifiedMesh", "Error", "ErrorReport", "Interrupted", "MeasuredSurface", "OptimizeResult", "Progress",
    "Reconstruction", "Surface", "Verification", "__version__", "decimate", "error", "minimize", "optimize",
    "read_cloud", "read_mesh", "reconstruct", "verify",
]
