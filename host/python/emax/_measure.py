from __future__ import annotations

import json
import os
from typing import Any, Sequence

from . import _core
from ._inputs import (CloudLike, Length, MeshLike, Path, given_cloud, given_mesh, is_mesh_like, is_path,
                      length_text, share_text)
from ._results import CertifiedMesh, ErrorReport, Verification, outcome


def error(
    cloud: CloudLike,
    mesh: MeshLike,
    max_error: Length | None = None,
    *,
    two_sided: bool = False,
    reference: Any = None,
    quantiles: Sequence[float] = (),
    worst: int = 5,
    exclude_outliers: float | str = 0,
    skip_invalid: bool = False,
) -> ErrorReport:
    """Measures and certifies the greatest distance of a cloud's points from a mesh.

    The numbers are those of ``emax error``. With ``two_sided`` the distance of the whole mesh from
    ``reference`` (a mesh or a cloud; by default the cloud itself) is certified too. Ctrl-C raises
    :class:`Interrupted`.

    >>> import emax
    >>> square = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], [[0, 1, 2], [0, 2, 3]]
    >>> cloud = [[0, 0, 0.25], [1, 0, 0], [1, 1, 0], [0, 1, 0.5]]
    >>> found = emax.error(cloud, square, max_error=0.3)
    >>> round(found.e_max, 9), found.worst_point, found.kept
    (0.5, 3, False)
    >>> found.distances
    array([0.25, 0.  , 0.  , 0.5 ])
    """
    surface = points = None
    if reference is not None:
        if not two_sided:
            raise ValueError("reference: it needs two_sided")
        if is_mesh_like(reference):
            surface = given_mesh(reference, "reference")
        else:
            points = given_cloud(reference, "reference", skip_invalid)
    found, stopped_by = _core.error(
        given_cloud(cloud, skip_invalid=skip_invalid), given_mesh(mesh), length_text(max_error, "max_error"),
        two_sided, surface, points, [float(q) for q in quantiles], worst, share_text(exclude_outliers))
    errors = outcome(found, stopped_by)
    report = json.loads(errors.json)
    back = report["errors"]["mesh_to_reference"]
    return ErrorReport(
        e_max=report["e_max"], back=back and back["upper"], worst_point=report["worst_point"],
        distances=errors.distances, kept=report["feasible"], exceeding=errors.exceeding, report=report)


def verify(
    certificate: Path | dict[str, Any] | CertifiedMesh,
    mesh: MeshLike | None = None,
    cloud: CloudLike | None = None,
    reference: MeshLike | None = None,
) -> Verification:
    """Recomputes the claims of a certificate, as ``emax verify`` does.

    ``certificate`` is the path of one, with files beside it or named here, whose checksums are
    compared. Or it is a certificate in memory or a result, with arrays; then every claim but the
    checksums is checked. Where a certificate speaks of a mesh's own vertices, ``cloud`` is that mesh.

    >>> import emax
    >>> tetrahedron = ([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]],
    ...                [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])
    >>> made = emax.decimate(tetrahedron, max_error=0.01)
    >>> bool(emax.verify(made, cloud=tetrahedron))
    True
    >>> moved = made.vertices + [0, 0, 0.1]
    >>> emax.verify(made, mesh=(moved, made.faces), cloud=tetrahedron).holds
    False
    """
    if isinstance(certificate, (str, os.PathLike)):
        named = [mesh, cloud, reference]
        if not all(name is None or is_path(name) for name in named):
            raise ValueError("certificate: the checksums of files need files; give json.load(...) of it "
                             "to check arrays")
        reasons, e_max = _core.verify_files(os.fspath(certificate),
                                            *("" if name is None else os.fspath(name) for name in named))
        return Verification(not reasons, tuple(reasons), e_max)
    if isinstance(certificate, CertifiedMesh):
        mesh = certificate if mesh is None else mesh
        reference = certificate.reference if reference is None else reference
        certificate = certificate.certificate
    if mesh is None:
        raise ValueError("mesh: the mesh that was certified is needed")
    of_vertices = certificate.get("cloud", {}).get("vertices_of_mesh", False)
    vertices = points = None
    if cloud is not None:
        vertices = given_mesh(cloud, "cloud") if of_vertices else None
        points = None if of_vertices else given_cloud(cloud)
    if certificate.get("reference") is not None and reference is None:
        reference = cloud if of_vertices else None
    reasons, e_max = _core.verify_arrays(
        json.dumps(certificate), given_mesh(mesh), points, vertices,
        None if reference is None else given_mesh(reference, "reference"))
    return Verification(not reasons, tuple(reasons), e_max)
