from __future__ import annotations

from typing import Callable

import numpy as np

from . import _core
from ._inputs import CloudLike, Length, MeshLike, given_cloud, given_mesh, length_text, one_of, share_text
from ._results import CertifiedMesh, Progress, outcome


def decimate(
    mesh: MeshLike,
    max_error: Length,
    *,
    cloud: CloudLike | None = None,
    two_sided: bool = True,
    back_error: Length | None = None,
    effort: str = "normal",
    objective: str = "triangles",
    feature_angle: float = 0,
    repair: bool = False,
    closed: bool = False,
    exclude_outliers: float | str = 0,
    time: float | None = None,
    threads: int = 0,
    progress: Callable[[Progress], object] | None = None,
) -> CertifiedMesh:
    """Reduces a mesh to as few triangles as a certified bound allows, as ``emax decimate`` does.

    ``mesh`` is a path, a pair ``(vertices, faces)``, or a mesh of trimesh, Open3D or PyVista.
    Every point of ``cloud`` (by default, every vertex of the mesh) lies within ``max_error`` of the
    result. With ``two_sided``, the whole result lies within ``back_error`` (by default ``max_error``)
    of the mesh too, and the whole mesh within ``max_error`` of the result. The options have the
    meanings of the command's; ``time`` is in seconds, and 0 ``threads`` are one a processor. The
    same arguments give the same bytes, for any number of threads.

    ``progress`` is called with a :class:`Progress` in the thread that called; StopIteration from it
    ends the work with the mesh so far. Ctrl-C raises :class:`Interrupted` with that mesh.

    >>> import numpy as np, emax
    >>> x, y = np.meshgrid(np.linspace(0, 1, 21), np.linspace(0, 1, 21))
    >>> vertices = np.column_stack([x.ravel(), y.ravel(), np.zeros(x.size)])
    >>> corner = np.arange(20)[:, None] * 21 + np.arange(20)
    >>> square = np.stack([corner, corner + 1, corner + 22, corner, corner + 22, corner + 21], axis=-1)
    >>> flat = emax.decimate((vertices, square.reshape(-1, 3)), max_error=0.01)
    >>> len(flat.faces), flat.e_max <= 0.01, flat.certificate["bound"]
    (2, True, 'two-sided')
    """
    if back_error is not None and not two_sided:
        raise ValueError("back_error: it bounds the other direction, so it needs two_sided")
    question = _core.DecimateQuestion()
    question.max_error = length_text(max_error, "max_error")
    question.back_error = length_text(back_error, "back_error")
    question.effort = one_of(effort, ("quick", "normal", "deep"), "effort")
    question.objective = one_of(objective, ("triangles", "hoppe"), "objective")
    question.exclude_outliers = share_text(exclude_outliers)
    if feature_angle and not 1 <= feature_angle <= 180:
        raise ValueError("feature_angle: 0 or 1 to 180 degrees")
    question.feature_angle = feature_angle
    question.seconds = time
    if threads < 0:
        raise ValueError("threads: a number of at least 0")
    question.threads = threads
    question.two_sided, question.repair, question.closed = two_sided, repair, closed
    given = given_mesh(mesh)
    points = None if cloud is None else given_cloud(cloud)
    report = None
    if progress is not None:
        def report(share: float, triangles: int) -> None:
            progress(Progress("decimation", share=share, triangles=triangles))

    made, stopped_by = _core.decimate(given, points, question, report)
    result = None
    if made is not None:
        rows = points.points if points is not None else given.vertices[np.unique(given.faces)]
        result = CertifiedMesh(made, rows, made.interrupted)
    return outcome(result, stopped_by)
